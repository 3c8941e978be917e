// Compiled once per instruction set, with LANCER_ISA naming it.
#include "widths/bsdf_kernel.h"

#include "integrator/stages/lobe_means.h"
#include "simd/kernel_lanes.h"

#include <type_traits>

namespace lancer {
namespace {

using testing::Described;
using testing::Place;

// Lanes of a number, a vector or a condition from those of each lane: get(lane).
template <class T, class Get> void put_lanes(T &to, const Get &get) {
  if constexpr (std::is_same_v<T, F>)
    to = from_lanes<F>(get);
  else if constexpr (std::is_same_v<T, Vec3<F>>)
    to = {from_lanes<F>([&](int i) { return get(i).x; }), from_lanes<F>([&](int i) { return get(i).y; }),
          from_lanes<F>([&](int i) { return get(i).z; })};
  else
    to = from_lanes<F>([&](int i) { return get(i) ? 1.0f : 0.0f; }) != F(0.0f);
}

// Adds the values of the lanes from first on to their rows.
class Report {
public:
  Report(BsdfRows &rows, int first) : rows_(rows), first_(first) { rows_.count = 0; }

  void operator()(const char *name, const F &x) {
    add(name, [&](int i) { return lane(x, i) == lane(x, i) ? as_word(lane(x, i)) : 0x7fc00000u; });
  }
  void operator()(const char *name, const Vec3<F> &v) {
    (*this)(name, v.x);
    (*this)(name, v.y);
    (*this)(name, v.z);
  }
  void operator()(const char *name, const U &x) {
    add(name, [&](int i) { return lane(x, i); });
  }
  void operator()(const char *name, const M &m) {
    add(name, [&](int i) { return bits(m) >> i & 1u; });
  }

private:
  template <class Get> void add(const char *name, const Get &get) {
    BsdfRows::Row &row = rows_.rows[rows_.count++];
    row.name = name;
    for (int i = 0; i < kLanes; ++i)
      row.words[first_ + i] = get(i);
  }

  BsdfRows &rows_;
  int first_;
};

LobeInputs<F> lobe_of(const Described *of) {
  LobeInputs<F> in;
  in.kind = of->lobe.kind;
  in.rules = of->lobe.rules;
  in.distribution = of->lobe.distribution;
  in.option = of->lobe.option;
#define LANCER_PUT(member) put_lanes(in.member, [&](int i) { return of[i].lobe.member; })
  LANCER_PUT(weight);
  LANCER_PUT(color);
  LANCER_PUT(roughness);
  LANCER_PUT(ior);
  LANCER_PUT(shininess);
  LANCER_PUT(edge);
  LANCER_PUT(anisotropy);
  LANCER_PUT(rotation);
  LANCER_PUT(roughness_across);
  LANCER_PUT(offset);
  LANCER_PUT(film_thickness);
  LANCER_PUT(film_ior);
  LANCER_PUT(normal);
  LANCER_PUT(tangent);
#undef LANCER_PUT
  return in;
}

PrincipledInputs<F> layers_of(const Described *of) {
  PrincipledInputs<F> in;
  in.rules = of->layers.rules;
  in.distribution = of->layers.distribution;
  in.option = of->layers.option;
  in.subsurface_option = of->layers.subsurface_option;
#define LANCER_PUT(kind, name, spoken, given) put_lanes(in.name, [&](int i) { return of[i].layers.name; });
  LANCER_PRINCIPLED_PARAMETERS(LANCER_PUT)
#undef LANCER_PUT
  return in;
}

Vec3<F> vector_of(const Place *of, const glm::vec3 Place::*member) {
  Vec3<F> v;
  put_lanes(v, [&](int i) { return of[i].*member; });
  return v;
}

void begin(Bsdf<F> &bsdf, const Place *of, bool bump_correction) {
  M inside;
  put_lanes(inside, [&](int i) { return of[i].inside; });
  bsdf.begin(vector_of(of, &Place::wo), vector_of(of, &Place::ns), vector_of(of, &Place::ng), inside, bump_correction);
  bsdf.walks = true;
  bsdf.after_diffuse = inside;
  bsdf.pixel = abs(bsdf.ns.x);
  bsdf.key = as_word(bsdf.ns.y);
}

void report_value(const char *name, const BsdfValue<F> &value, Report &add) {
  for (const Vec3<F> &part : value.part)
    add(name, part);
  add(name, value.pdf);
}

// Adds every value that a surface answers.
void report_all(Bsdf<F> &bsdf, const Place *of, Report &add) {
  bsdf.complete();
  add("smooth", bsdf.smooth);
  add("transmits", bsdf.transmits);
  add("emission", bsdf.emission);
  add("albedo", bsdf.albedo());
  for (const Component component : {Component::Diffuse, Component::Glossy, Component::Transmission})
    add("shown", bsdf.shown(component));
  add("mean_normal", mean_normal(bsdf));
  const Mixture<F> mixture = mix(bsdf, Vec3<F>(F(0.0f)), uniform<F>(false), true, false);
  add("mix: normal", mixture.normal);
  add("mix: diffuse", mixture.diffuse);
  add("mix: specular", mixture.specular);
  add("mix: baked", Vec3<F>(mix(bsdf, Vec3<F>(F(0.0f)), uniform<F>(false), true, true).roughness));
  add("mix: matt", mixture.matt);
  add("mix: roughness", mixture.roughness);
  for (int k = 0; k < Place::kDirections; ++k) {
    Vec3<F> wi;
    put_lanes(wi, [&](int i) { return of[i].wi[k]; });
    report_value("eval", bsdf.eval(wi), add);
    report_value("eval_lit", bsdf.eval_lit(wi), add);
  }
  for (int k = 0; k < Place::kDraws; ++k) {
    Vec3<F> u;
    put_lanes(u, [&](int i) { return of[i].u[k]; });
    const BsdfSample<F> sample = bsdf.sample(u.x, u.y, u.z);
    add("sample: pdf", sample.pdf);
    add("sample: wi", sample.wi);
    add("sample: weight", sample.weight);
    add("sample: share", sample.share[0]);
    add("sample: share", sample.share[1]);
    add("sample: delta", sample.delta);
    add("sample: transmitted", sample.transmitted);
    add("sample: component", sample.component);
    add("sample: alpha2", sample.alpha2);
    add("sample: entered", sample.entered);
    add("sample: below", sample.below_color);
    add("sample: below", sample.below_radius);
    add("sample: below", sample.below_g);
    add("sample: below", sample.below_ior);
    add("sample: below", sample.below_variant);
    report_value("eval of what was drawn", bsdf.eval(sample.wi), add);
    report_value("eval_lit of what was drawn", bsdf.eval_lit(sample.wi), add);
  }
  // Let light leave from below.
  leave_below(bsdf, Rules::Blender45, bsdf.inside);
  bsdf.complete();
  report_value("eval of an exit", bsdf.eval(bsdf.wo), add);
}

void report_described(const Place *places, const Described *const *lobes, int count, bool bump_correction, BsdfRows &rows) {
  for (int first = 0; first < BsdfRows::kLanes; first += kLanes) {
    Report report(rows, first);
    Bsdf<F> bsdf;
    begin(bsdf, places + first, bump_correction);
    for (int k = 0; k < count; ++k)
      if (lobes[k][0].lobe.kind == LobeKind::Principled)
        add_principled(bsdf, lobe_of(lobes[k] + first), layers_of(lobes[k] + first));
      else
        add_lobe(bsdf, lobe_of(lobes[k] + first));
    report_all(bsdf, places + first, report);
  }
}

void report_planned(const Place *places, const ReadyLobe *const *ready, bool layered, BsdfRows &rows) {
  for (int first = 0; first < BsdfRows::kLanes; first += kLanes) {
    Report report(rows, first);
    LaneLobes<F> lanes;
    for (int i = 0; i < kLanes; ++i) {
      lanes.of[i] = ready[first + i];
      lanes.inside |= uint32_t(places[first + i].inside) << i;
      lanes.same = lanes.same && lanes.of[i] == lanes.of[0];
    }
    Bsdf<F> bsdf;
    begin(bsdf, places + first, true);
    if (layered)
      add_principled(bsdf, lanes.principled_carrier(), lanes.principled(), lanes);
    else
      add_cached(bsdf, lanes.inputs(), lanes);
    report_all(bsdf, places + first, report);
  }
}

} // namespace

namespace LANCER_ISA {
const BsdfKernel bsdf_kernel = {LANCER_ISA_NAME, report_described, report_planned};
}

} // namespace lancer
