// Plans of facets that are the same at every hit of their material. They are made once, with their tables sampled along the
// cosine.
#pragma once

#include "bsdf/principled.h"
#include "simd/vectors.h"

#include <memory>

namespace lancer {

// One record per lane: its members side by side, read once if all lanes have the same record.
template <class F, class Record> struct LaneRecords {
  static constexpr int kWidth = LanesOf<F>::kWidth;
  const Record *of[kWidth] = {}; // if all are the same, only the first is read
  bool same = true;

  // get: returns the number, vector or condition of one record.
  template <class Get> LANCER_LANE F number(const Get &get) const {
    if (same)
      return F(get(*of[0]));
    return from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]); });
  }
  template <class Get> LANCER_LANE Vec3<F> vector(const Get &get) const {
    if (same)
      return Vec3<F>(get(*of[0]));
    return {from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]).x; }),
            from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]).y; }),
            from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]).z; })};
  }
  template <class Get> LANCER_LANE MaskOf<F> condition(const Get &get) const {
    return number([&](const Record &r) __attribute__((always_inline)) { return get(r) ? 1.0f : 0.0f; }) != F(0.0f);
  }
};

struct CachedPlan {
  MicrofacetPlan<float> plan;
  // Rows: the albedo of single scattering, kFine values, or kCoarse for a refracting lobe; and the position between the ends of
  // the Fresnel curve.
  float single[tables::kFine] = {}, mix[tables::kCoarse] = {};
};
inline std::unique_ptr<const CachedPlan> cached(const MicrofacetPlan<float> &plan) {
  const AlbedoLookup<float> tables;
  auto kept = std::make_unique<CachedPlan>();
  kept->plan = plan;
  const int singles = refracts(plan.lobe) ? tables::kCoarse : tables::kFine;
  for (int i = 0; i < singles; ++i)
    kept->single[i] = tables.single(plan, float(i) / float(singles - 1));
  for (int i = 0; i < tables::kCoarse; ++i)
    kept->mix[i] = tables.mix(plan, float(i) / float(tables::kCoarse - 1));
  return kept;
}

// The plan of each lane. All plans have the same kind of lobe.
template <class F> struct LanePlans : LaneRecords<F, CachedPlan> {
  using LaneRecords<F, CachedPlan>::of, LaneRecords<F, CachedPlan>::same;
  using LaneRecords<F, CachedPlan>::number, LaneRecords<F, CachedPlan>::vector, LaneRecords<F, CachedPlan>::condition;

  // Interpolates a row in each lane, as read_row() does.
  template <class Row> LANCER_LANE F read(const Row &row, int n, F x) const {
    const tables::AxisPlace<F> at = tables::place_on_axis(x, n);
    const WordOf<F> first = truncate(at.node);
    if (same)
      return tables::between(at, gather(row(*of[0]), first), gather(row(*of[0]) + 1, first));
    return tables::between(
        at, from_lanes<F>([&](int i) __attribute__((always_inline)) { return row(*of[i])[lane(first, i)]; }),
        from_lanes<F>([&](int i) __attribute__((always_inline)) { return row(*of[i])[lane(first, i) + 1]; }));
  }
  LANCER_LANE F single(const MicrofacetPlan<F> &plan, F cos_o) const {
    return read(
        [](const CachedPlan &k) __attribute__((always_inline)) { return k.single; },
        refracts(plan.lobe) ? tables::kCoarse : tables::kFine, cos_o);
  }
  LANCER_LANE F mix(const MicrofacetPlan<F> &, F cos_o) const {
    return read(
        [](const CachedPlan &k) __attribute__((always_inline)) { return k.mix; }, tables::kCoarse, cos_o);
  }

  // Returns the plans as one, with the members that their kind of lobe reads.
  LANCER_LANE MicrofacetPlan<F> plan() const {
#define LANCER_OF(member)                                                                                                      \
  [](const CachedPlan &k) __attribute__((always_inline)) { return k.plan.member; }
    const Lobe<float> &first = of[0]->plan.lobe;
    MicrofacetPlan<F> plan;
    Lobe<F> &lobe = plan.lobe;
    lobe.shape = first.shape;
    lobe.variant = first.variant;
    lobe.component = first.component;
    lobe.beckmann = first.beckmann;
    lobe.fresnel = first.fresnel;
    lobe.film = first.film;
    lobe.rules = first.rules;
    lobe.shown = F(first.shown);
    lobe.alpha_x = number(LANCER_OF(lobe.alpha_x));
    lobe.alpha_y = number(LANCER_OF(lobe.alpha_y));
    lobe.delta = condition(LANCER_OF(lobe.delta));
    lobe.ior = number(LANCER_OF(lobe.ior));
    if (first.fresnel != FresnelKind::Dielectric)
      lobe.f0 = vector(LANCER_OF(lobe.f0));
    if (first.fresnel == FresnelKind::F82 || first.film)
      lobe.b = vector(LANCER_OF(lobe.b));
    if (first.fresnel == FresnelKind::Conductor || first.fresnel == FresnelKind::StrongConductor || first.film)
      lobe.f90 = vector(LANCER_OF(lobe.f90));
    if (first.fresnel == FresnelKind::Schlick) {
      lobe.lowest = number(LANCER_OF(lobe.lowest));
      lobe.per_range = number(LANCER_OF(lobe.per_range));
      lobe.reflection = vector(LANCER_OF(lobe.reflection));
    }
    if (refracts(lobe)) {
      lobe.transmission = vector(LANCER_OF(lobe.transmission));
      lobe.delta_through = condition(LANCER_OF(lobe.delta_through));
    }
    plan.preserving = condition(LANCER_OF(preserving));
    if (any(plan.preserving))
      plan.further = vector(LANCER_OF(further));
#undef LANCER_OF
    return plan;
  }
  LANCER_LANE Lobe<F> seen(F cos_o, const Vec3<F> &color) const { return seen_from(plan(), cos_o, color, *this); }
};

} // namespace lancer
