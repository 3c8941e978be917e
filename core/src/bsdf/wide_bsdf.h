// Bsdf for many lanes at once: Lambert and GGX about the shading normal, reflecting or glass, rough or smooth, in layers or
// side by side. The same operations in the same order as bsdf_terms.h, microfacet.cpp and principled.cpp, so that each lane has
// their bits. For kernels only, like simd/lanes.h.
#pragma once

#include "bsdf/lobe.h"
#include "bsdf/wide_facets.h"
#include "bsdf/wide_lobe.h"

namespace lancer {
namespace {

struct WideFrame {
  V3 t, b, n;
};

LANCER_LANE WideFrame make_frame(const V3 &n) {
  const F sign = copysign(F(1.0f), n.z);
  const F a = F(-1.0f) / (sign + n.z);
  const F c = n.x * n.y * a;
  return {{F(1.0f) + sign * n.x * n.x * a, sign * c, -sign * n.x}, {c, sign + n.y * n.y * a, -n.y}, n};
}
LANCER_LANE V3 to_local(const WideFrame &f, const V3 &w) { return {dot(w, f.t), dot(w, f.b), dot(w, f.n)}; }
LANCER_LANE V3 to_world(const WideFrame &f, const V3 &w) { return w.x * f.t + w.y * f.b + w.z * f.n; }

// A field of the records of all lanes.
struct Records {
  const WideMaterial *const *of;
  bool same; // all lanes have one
};
template <class Get> LANCER_LANE F field(const Records &records, Get get) {
  if (records.same)
    return F(get(*records.of[0]));
  alignas(64) float values[kLanes];
  for (int i = 0; i < kLanes; ++i)
    values[i] = get(*records.of[i]);
  return load(values);
}
template <class Get> LANCER_LANE U word(const Records &records, Get get) {
  if (records.same)
    return U(get(*records.of[0]));
  alignas(64) uint32_t values[kLanes];
  for (int i = 0; i < kLanes; ++i)
    values[i] = get(*records.of[i]);
  return load(values);
}
#define LANCER_FIELD(name)                                                                                                     \
  field(                                                                                                                       \
      records, [=](const WideMaterial &m) __attribute__((always_inline)) { return m.lobes[k].name; })
#define LANCER_FIELD3(name)                                                                                                    \
  V3 { LANCER_FIELD(name[0]), LANCER_FIELD(name[1]), LANCER_FIELD(name[2]) }
#define LANCER_WORD(name)                                                                                                      \
  word(                                                                                                                        \
      records, [=](const WideMaterial &m) __attribute__((always_inline)) { return static_cast<uint32_t>(m.lobes[k].name); })

struct WideBsdf {
  WideFrame frame;
  V3 wo; // local
  V3 ng;
  M flat;
  int count;
  WideTerm terms[kWideLobes];
};

// steps: entries of the row less one.
LANCER_LANE F read_row(const Records &records, int k, bool mixes, F steps, F x) {
  x = clamp01(x) * steps;
  const U last = truncate(steps - F(1.0f));
  U i = truncate(x);
  i = select(to_float(i) > to_float(last), last, i);
  alignas(64) uint32_t index[kLanes];
  alignas(64) float a[kLanes], b[kLanes];
  store(index, i);
  for (int lane = 0; lane < kLanes; ++lane) {
    const WideLobe &lobe = records.of[lane]->lobes[k];
    const float *row = mixes ? lobe.mix : lobe.single;
    a[lane] = row ? row[index[lane]] : 0.0f;
    b[lane] = row ? row[index[lane] + 1] : 0.0f;
  }
  const F low = load(a), high = load(b);
  return low + (high - low) * (x - to_float(i));
}

// The lobe's energy, colour and albedo from wo: finish() of microfacet.cpp.
LANCER_LANE void finish(const Records &records, int k, F cos_o, WideTerm &term) {
  const V3 one{F(1.0f), F(1.0f), F(1.0f)};
  constexpr float fine = 31.0f, coarse = 15.0f;
  term.energy = F(1.0f);
  const M preserving = equal(LANCER_WORD(preserving), U(1u)) & term.facets;
  if (any(preserving)) {
    const F single = read_row(records, k, false, select(term.glass, F(coarse), F(fine)), cos_o);
    const V3 further = LANCER_FIELD3(further);
    term.energy = select(preserving, F(1.0f) / single, term.energy);
    const M colored = preserving & !((further.x == F(1.0f)) & (further.y == F(1.0f)) & (further.z == F(1.0f)));
    const V3 kept = further * (F(1.0f) - single);
    term.color = select(colored, term.color * V3{single + kept.x, single + kept.y, single + kept.z}, term.color);
  }
  const M averaged = equal(LANCER_WORD(averaged), U(1u)) & term.facets;
  // Where nothing but the mean over the facets is asked for, and a smooth surface would not be black either, it is not asked.
  const M smooth = term.facets & (term.glass | !(term.schlick & !black(term.f0)));
  V3 reflected = one, through = one - one;
  if (any(smooth)) {
    const WideResponse response = facet_response(term, cos_o);
    reflected = select(smooth, response.reflected, one);
    through = response.through;
  }
  if (any(averaged)) {
    const F mix = read_row(records, k, true, F(coarse), cos_o);
    const V3 schlick = (term.f0 + (term.f90 - term.f0) * mix) * term.reflection;
    const V3 f82 = term.f0 + (one - term.f0) * mix;
    const F dielectric = term.lowest + (F(1.0f) - term.lowest) * mix;
    const V3 mean = select(term.f82, f82, select(term.dielectric, dielectric * term.reflection, schlick));
    reflected = select(averaged & !black(reflected), mean, reflected);
  }
  term.albedo = select(term.facets, term.color * reflected, term.color);
  term.albedo = select(term.glass, term.albedo + term.color * through, term.albedo);
}

// What a layer leaves for those below it.
LANCER_LANE V3 below(const V3 &weight, const V3 &albedo) {
  const F zero(0.0f);
  F taken = zero;
  taken = select(weight.x != zero, max(taken, albedo.x / weight.x), taken);
  taken = select(weight.y != zero, max(taken, albedo.y / weight.y), taken);
  taken = select(weight.z != zero, max(taken, albedo.z / weight.z), taken);
  const F left = F(1.0f) - taken;
  // std::clamp
  return weight * select(left < zero, zero, select(F(1.0f) < left, F(1.0f), left));
}

template <class Enum> LANCER_LANE M is(U value, Enum which) { return equal(value, U(static_cast<uint32_t>(which))); }

// The terms of one lobe number, and what is left for the next.
LANCER_LANE void add_term(const Records &records, int k, const V3 &base_color, WideBsdf &bsdf, V3 &left) {
  WideTerm &term = bsdf.terms[k];
  const U shape = LANCER_WORD(shape), mode = LANCER_WORD(mode), fresnel = LANCER_WORD(fresnel);
  term.lambert = is(shape, WideShape::Lambert);
  term.facets = is(shape, WideShape::Microfacet);
  term.dielectric = term.facets & is(fresnel, FresnelKind::Dielectric);
  term.f82 = term.facets & is(fresnel, FresnelKind::F82);
  term.schlick = term.facets & is(fresnel, FresnelKind::Schlick);
  const F share = LANCER_FIELD(share);
  const M shares = is(mode, WideMode::Share), layers = is(mode, WideMode::Layer), base = is(mode, WideMode::Base);
  term.color = select(shares | layers, share * left, select(base, base_color * left, base_color));
  const M given = is(mode, WideMode::Given);
  if (any(given))
    term.color = select(given, LANCER_FIELD3(color), term.color);
  term.color = select(term.lambert | term.facets, term.color, V3{F(0.0f), F(0.0f), F(0.0f)});
  if (any(term.facets)) {
    term.alpha_x = LANCER_FIELD(alpha_x);
    term.alpha_y = LANCER_FIELD(alpha_y);
    term.f0 = LANCER_FIELD3(f0);
    term.f90 = LANCER_FIELD3(f90);
    term.b = LANCER_FIELD3(b);
    term.reflection = LANCER_FIELD3(reflection);
    term.glass = term.facets & equal(LANCER_WORD(through), U(1u));
    term.delta = term.facets & equal(LANCER_WORD(delta), U(1u));
    term.delta_through = term.facets & equal(LANCER_WORD(delta_through), U(1u));
    if (any(term.glass))
      term.transmission = LANCER_FIELD3(transmission);
    term.ior = LANCER_FIELD(ior);
    term.lowest = LANCER_FIELD(lowest);
    term.per_range = LANCER_FIELD(per_range);
    finish(records, k, max(F(0.0f), bsdf.wo.z), term);
    term.hidden = ggx_hidden(bsdf.wo, term.alpha_x, term.alpha_y);
    term.g1 = F(1.0f) / (bsdf.wo.z + term.hidden);
  } else {
    term.albedo = term.color;
  }
  left = select(shares, left * (F(1.0f) - share), select(layers, below(left, term.albedo), left));
}

// The lobes of all lanes: add_layers() and Bsdf::complete().
// left: the weight of all lobes together; base: of WideMaterial.
LANCER_LANE void make_bsdf(const Records &records, int count, const V3 &wo, const V3 &ns, const V3 &ng, V3 left, const V3 &base,
                           WideBsdf &bsdf) {
  bsdf.frame = make_frame(ns);
  bsdf.wo = to_local(bsdf.frame, wo);
  bsdf.ng = ng;
  bsdf.flat = (ns.x == ng.x) & (ns.y == ng.y) & (ns.z == ng.z);
  bsdf.count = count;
  F sum(0.0f);
  for (int k = 0; k < count; ++k) {
    add_term(records, k, base, bsdf, left);
    WideTerm &term = bsdf.terms[k];
    term.probability = max(max(max(term.albedo.x, term.albedo.y), term.albedo.z), F(0.0f));
    // What has no colour is not there.
    term.probability = select(black(term.color), F(0.0f), term.probability);
    sum = sum + term.probability;
  }
  for (int k = 0; k < count; ++k)
    bsdf.terms[k].probability = select(sum > F(0.0f), bsdf.terms[k].probability / sum, F(0.0f));
}

// Lanes in which some lobe lets light through.
LANCER_LANE M transmits(const WideBsdf &bsdf) {
  M found = bsdf.wo.x != bsdf.wo.x;
  for (int k = 0; k < bsdf.count; ++k)
    if (any(bsdf.terms[k].facets))
      found = found | (bsdf.terms[k].glass & !black(bsdf.terms[k].color));
  return found;
}

// Sum of the lobes' albedos.
LANCER_LANE V3 albedo(const WideBsdf &bsdf) {
  const F zero(0.0f);
  V3 sum{zero, zero, zero};
  for (int k = 0; k < bsdf.count; ++k) {
    const WideTerm &term = bsdf.terms[k];
    sum = select(black(term.color), sum, sum + term.albedo);
  }
  return sum;
}

// BsdfValue for light samples, by Component.
struct WideValue {
  V3 diffuse, glossy, transmission;
  F pdf;
};

// microfacet_eval_through(), also where both directions lie on one side of h.
LANCER_LANE void add_through(const WideBsdf &bsdf, const WideTerm &term, M crossing, const V3 &wi, const V3 &h,
                             WideValue &value) {
  const F zero(0.0f), one(1.0f), cos_oh = dot(bsdf.wo, h), cos_ih = dot(wi, h);
  const F d = facet_d(term, h);
  const WideResponse response = facet_response(term, abs(cos_oh));
  const F stretch = cos_oh / term.ior + cos_ih;
  const F common = d * abs(cos_oh * cos_ih) / (stretch * stretch);
  const M counts = crossing & (h.z > zero) & (d != zero) & (abs(common) < F(__builtin_inff()));
  const V3 f = response.through * (term.energy * common * facet_g2(term, bsdf.wo, wi));
  value.transmission = select(counts, value.transmission + term.color * f, value.transmission);
  const F pdf = (one - reflected_share(response)) * common * term.g1;
  value.pdf = select(counts, value.pdf + term.probability * pdf, value.pdf);
}

// h: the half vector of lanes that have one; wi local. drawn: the lobe that drew h, where light goes through.
LANCER_LANE WideValue sum_terms(const WideBsdf &bsdf, const V3 &wi, const V3 &h, U drawn) {
  const F zero(0.0f);
  WideValue value{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}, zero};
  const F cos_oh = dot(bsdf.wo, h);
  const M beyond = (bsdf.wo.z > zero) & (wi.z < zero);
  const M above = (bsdf.wo.z > zero) & (wi.z > zero) & (h.z > zero) & (cos_oh > zero);
  for (int k = 0; k < bsdf.count; ++k) {
    const WideTerm &term = bsdf.terms[k];
    const M there = term.probability != zero;
    const M lambert = term.lambert & there;
    if (any(lambert)) {
      const F cosine = max(zero, wi.z) * F(kInvPi);
      value.diffuse = select(lambert, value.diffuse + term.color * cosine, value.diffuse);
      value.pdf = select(lambert, value.pdf + term.probability * cosine, value.pdf);
    }
    if (!any(term.facets))
      continue;
    const M rough = term.facets & there & !term.delta;
    const M facets = rough & above;
    if (any(facets)) {
      const F d = facet_d(term, h);
      const WideResponse response = facet_response(term, cos_oh);
      const F common = F(0.25f) * d;
      const M counts = facets & (d != zero);
      const V3 f = response.reflected * (term.energy * common * facet_g2(term, bsdf.wo, wi));
      // Facets that reflect nothing are never chosen.
      const F share = reflected_share(response);
      value.glossy = select(counts, value.glossy + term.color * f, value.glossy);
      value.pdf = select(counts, value.pdf + term.probability * (share * common * term.g1), value.pdf);
    }
    const M crossing = rough & beyond & term.glass & !term.delta_through;
    if (any(crossing)) {
      const M known = equal(drawn, U(static_cast<uint32_t>(k)));
      add_through(bsdf, term, crossing, wi, select(known, h, refraction_half_vector(bsdf.wo, wi, term.ior)), value);
    }
  }
  return value;
}

LANCER_LANE V3 half_vector(const V3 &wo, const V3 &wi) {
  const V3 sum = wo + wi;
  const F length2 = dot(sum, sum);
  const V3 h = sum / sqrt(length2);
  const F zero(0.0f);
  return select(length2 > zero, h, V3{zero, zero, zero});
}

// wi: world.
LANCER_LANE WideValue eval_lit(const WideBsdf &bsdf, const V3 &wi) {
  const V3 local = to_local(bsdf.frame, wi);
  return sum_terms(bsdf, local, half_vector(bsdf.wo, local), U(~0u));
}

#undef LANCER_FIELD
#undef LANCER_FIELD3
#undef LANCER_WORD

} // namespace
} // namespace lancer
