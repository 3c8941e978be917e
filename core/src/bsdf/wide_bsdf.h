// Bsdf for many lanes at once: Lambert and GGX about the shading normal, reflecting or glass, rough or smooth, in layers or
// side by side. The same operations in the same order as bsdf_terms.h, microfacet.cpp and principled.cpp, so that each lane has
// their bits. For kernels only, like sampling/lanes.h.
#pragma once

#include "bsdf/wide_lobe.h"
#include "sampling/lanes.h"
#include "sampling/octant.h"

namespace lancer {
namespace {

constexpr float kWideInvPi = 0.318309886183790671537767526745028724f;
constexpr float kWideQuarterPi = 0.25f * 3.14159265358979323846f;

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

LANCER_LANE F clamp01(F x) { return min(max(x, F(0.0f)), F(1.0f)); }
LANCER_LANE V3 clamp01(const V3 &x) { return {clamp01(x.x), clamp01(x.y), clamp01(x.z)}; }

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

// A lobe as wo sees it.
struct WideTerm {
  M lambert, facets; // what it is
  M f82, schlick, dielectric;
  M glass; // lets light through, too
  M delta, delta_through;
  V3 color, albedo;
  F probability;
  F alpha_x, alpha_y, energy;
  V3 f0, f90, b, reflection, transmission;
  F ior, lowest, per_range;
  F g1; // of wo: 1 / (wo.z + hidden), and what is hidden
  F hidden;
};

struct WideBsdf {
  WideFrame frame;
  V3 wo; // local
  V3 ng;
  M flat;
  int count;
  WideTerm terms[kWideLobes];
};

LANCER_LANE F ggx_hidden(const V3 &w, F alpha_x, F alpha_y) {
  const F x = alpha_x * w.x, y = alpha_y * w.y;
  const F along = sqrt(x * x + y * y), z = abs(w.z);
  const F all = z + sqrt(z * z + along * along);
  return select(all > F(0.0f), F(0.5f) * along * (along / all), F(0.0f));
}

// As fresnel() of fresnel.h.
struct WideFresnel {
  F reflectance, cos_t, transmittance;
};
LANCER_LANE WideFresnel fresnel_dielectric(F cos_i, F eta) {
  const F zero(0.0f), one(1.0f);
  const D c = min(max(widen(cos_i), D(0.0)), D(1.0));
  const D n = widen(eta), e = D(1.0) / n;
  const D cos2_t = (n - D(1.0)) * e * ((n + D(1.0)) * e) + (e * c) * (e * c);
  const D g = sqrt(cos2_t);
  const D rs = (e * c - g) / (e * c + g);
  const D rp = (c - e * g) / (c + e * g);
  const D f = D(0.5) * (rs * rs + rp * rp);
  WideFresnel r{narrow(f), narrow(g), narrow(D(1.0) - f)};
  // Grazing, totally reflecting, and what bends nothing at all or everything.
  const M total = !(cos2_t > D(0.0)), mirror = eta == F(__builtin_inff()), all = (c == D(0.0)) | total | mirror;
  const M straight = eta == one;
  r.reflectance = select(straight, zero, select(all, one, r.reflectance));
  r.cos_t = select(straight, narrow(c), select(mirror, one, select(total, zero, r.cos_t)));
  r.transmittance = select(straight, one, select(all, zero, r.transmittance));
  return r;
}

LANCER_LANE V3 fresnel_f82(F cos_i, const V3 &f0, const V3 &b) {
  const F s = clamp01(F(1.0f) - cos_i), s2 = s * s, s5 = s2 * s2 * s;
  const F edge = cos_i * s5 * s;
  const V3 one{F(1.0f), F(1.0f), F(1.0f)};
  return clamp01(f0 + (one - f0) * s5 - b * edge);
}

struct WideResponse {
  V3 reflected, through;
  F cos_t; // of the refracted direction, against the facet
};

// What facets reflect and let through, by the cosine of wo against them.
LANCER_LANE WideResponse facet_response(const WideTerm &term, F cos_i) {
  const F zero(0.0f), one(1.0f);
  WideResponse r{{one, one, one}, {zero, zero, zero}, zero};
  if (any(term.schlick | term.dielectric)) {
    const WideFresnel boundary = fresnel_dielectric(cos_i, term.ior);
    const F along = clamp01((boundary.reflectance - term.lowest) * term.per_range);
    const V3 curve = (term.f0 + (term.f90 - term.f0) * along) * term.reflection;
    r.reflected = select(term.schlick, curve, select(term.dielectric, boundary.reflectance * term.reflection, r.reflected));
    // Nothing goes through where the boundary reflects totally.
    r.cos_t = boundary.cos_t;
    if (any(term.glass)) {
      const F left = min(boundary.transmittance * term.per_range, one);
      const V3 through = ((V3{one, one, one} - term.f90) + (term.f90 - term.f0) * left) * term.transmission;
      r.through = select(term.glass & (boundary.cos_t > zero), through, r.through);
    }
  }
  if (any(term.f82))
    r.reflected = select(term.f82, fresnel_f82(cos_i, term.f0, term.b), r.reflected);
  return r;
}

// The probability of choosing reflection.
LANCER_LANE F reflected_share(const WideResponse &response) {
  const F zero(0.0f), one(1.0f);
  const V3 &r = response.reflected, &t = response.through;
  const M opaque = black(t);
  const F whole = select(black(r), zero, one);
  if (!any(!opaque))
    return whole;
  const F reflected = r.x + r.y + r.z, through = t.x + t.y + t.z;
  return select(opaque, whole, select(reflected > zero, reflected / (reflected + through), zero));
}

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

// The terms of one lobe number, and what is left for the next.
LANCER_LANE void add_term(const Records &records, int k, const V3 &base_color, WideBsdf &bsdf, V3 &left) {
  WideTerm &term = bsdf.terms[k];
  const U shape = LANCER_WORD(shape), mode = LANCER_WORD(mode), fresnel = LANCER_WORD(fresnel);
  term.lambert = equal(shape, U(1u));
  term.facets = equal(shape, U(2u));
  term.dielectric = term.facets & equal(fresnel, U(1u));
  term.f82 = term.facets & equal(fresnel, U(3u));
  term.schlick = term.facets & equal(fresnel, U(4u));
  const F share = LANCER_FIELD(share);
  const M shares = equal(mode, U(1u)), layers = equal(mode, U(2u)), base = equal(mode, U(3u));
  term.color = select(shares | layers, share * left, select(base, base_color * left, base_color));
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

LANCER_LANE F facet_d(const WideTerm &term, const V3 &h) {
  const F x = h.x / term.alpha_x, y = h.y / term.alpha_y, length2 = x * x + y * y + h.z * h.z;
  return F(kWideInvPi) / (term.alpha_x * term.alpha_y * length2 * length2);
}

// facet_g2() of microfacet_terms.h.
LANCER_LANE F facet_g2(const WideTerm &term, const V3 &wo, const V3 &wi) {
  const F zero(0.0f), z = abs(wi.z), i = ggx_hidden(wi, term.alpha_x, term.alpha_y);
  const F seen = (wo.z + term.hidden) * z + wo.z * i;
  return select(seen > zero, z / seen, zero);
}

LANCER_LANE V3 refraction_half_vector(const V3 &wo, const V3 &wi, F eta) {
  const V3 sum = wo + eta * wi;
  const F length2 = dot(sum, sum), zero(0.0f);
  const V3 h = copysign(F(1.0f) / sqrt(length2), sum.z) * sum;
  return select((length2 > zero) & (length2 < F(__builtin_inff())), h, V3{zero, zero, zero});
}

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
      const F cosine = max(zero, wi.z) * F(kWideInvPi);
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

LANCER_LANE V3 sample_cosine(F u, F v) {
  // warp_disk() and the height above it.
  const F a = F(2.0f) * u - F(1.0f), b = F(2.0f) * v - F(1.0f);
  const M wide = abs(a) > abs(b), middle = (a == F(0.0f)) & (b == F(0.0f));
  const F phi = F(kWideQuarterPi) * select(wide, b / a, a / b);
  const F s = sin_octant(phi), c = cos_octant(phi);
  const F zero(0.0f), x = select(wide, a * c, b * s), y = select(wide, a * s, b * c);
  const F r = max(abs(a), abs(b));
  return {select(middle, zero, x), select(middle, zero, y), sqrt((F(1.0f) - r) * (F(1.0f) + r))};
}

LANCER_LANE V3 sample_visible(const V3 &wo, F alpha_x, F alpha_y, F u, F v) {
  const V3 w = normalize(V3{alpha_x * wo.x, alpha_y * wo.y, wo.z});
  const F s = u * (F(1.0f) + w.z), sin_theta = sqrt(max(F(0.0f), s * (F(2.0f) - s)));
  // sin_cos_turn()
  const U quarter = truncate(F(4.0f) * v + F(0.5f));
  const F x = F(6.28318531f) * (v - F(0.25f) * to_float(quarter));
  const F so = sin_octant(x), co = cos_octant(x);
  const M odd = equal(quarter & U(1u), U(1u));
  const F sine = as_float(as_word(select(odd, co, so)) ^ ((quarter & U(2u)) << 30));
  const F cosine = as_float(as_word(select(odd, so, co)) ^ (((quarter + U(1u)) & U(2u)) << 30));
  const V3 h{sin_theta * cosine + w.x, sin_theta * sine + w.y, (F(1.0f) - u) * (F(1.0f) + w.z)};
  return normalize(V3{alpha_x * h.x, alpha_y * h.y, h.z});
}

struct WideSample {
  V3 wi, weight; // world
  F pdf;         // 0 of a single direction
  M valid, glossy, transmitted;
};

// The lobe that each lane's direction is drawn from, with what is left of its number.
struct WidePick {
  U lobe;
  M facets, matte;
  F alpha_x, alpha_y;
  F u;
};
LANCER_LANE WidePick pick(const WideBsdf &bsdf, F u) {
  const F zero(0.0f), one(1.0f);
  M open = zero == zero;
  WidePick picked{U(~0u), !open, !open, one, one, u};
  for (int k = 0; k < bsdf.count; ++k) {
    const WideTerm &term = bsdf.terms[k];
    const M there = open & (term.probability > zero);
    const M chosen = there & (picked.u < term.probability);
    const M facets = term.facets;
    // Rounding may leave u beyond the last sum: then the last one is meant.
    picked.lobe = select(there, U(static_cast<uint32_t>(k)), picked.lobe);
    picked.facets = (picked.facets & !there) | (there & facets);
    picked.matte = (picked.matte & !there) | (there & !facets);
    if (any(facets)) {
      picked.alpha_x = select(there & facets, term.alpha_x, picked.alpha_x);
      picked.alpha_y = select(there & facets, term.alpha_y, picked.alpha_y);
    }
    picked.u = select(chosen, picked.u / term.probability, select(there, picked.u - term.probability, picked.u));
    open = open & !chosen;
  }
  picked.u = min(picked.u, F(1.0f - 0x1p-24f));
  return picked;
}

// A direction from lobes that may send light two ways or in a single direction.
struct WideDirection {
  V3 wi, weight; // local; the weight of a single direction over all probabilities
  M valid, single;
};
// mine: lanes of this lobe with wo above it; h: the facet that was drawn, mirrored: wo at that facet.
LANCER_LANE void draw_side(const WideBsdf &bsdf, const WideTerm &term, M mine, F u_side, const V3 &h, const V3 &mirrored,
                           WideDirection &direction) {
  const F zero(0.0f), one(1.0f), &eta = term.ior;
  const V3 &wo = bsdf.wo;
  // Choose the side by what the facet sends there.
  const F cos_oh = select(term.delta, wo.z, dot(wo, h));
  const WideResponse response = facet_response(term, cos_oh);
  const F share = reflected_share(response), rest = one - share;
  const M reflects = u_side < share;
  const V3 back = select(term.delta, V3{-wo.x, -wo.y, wo.z}, mirrored);
  V3 wi = back, weight = response.reflected * (term.energy / share);
  if (any(mine & !reflects)) {
    // Bend wo at the facet; where nothing is bent nothing is shadowed either.
    const V3 at_facet = (cos_oh / eta - response.cos_t) * h - wo / eta;
    const V3 bent = normalize(select(term.delta, V3{-wo.x / eta, -wo.y / eta, -response.cos_t}, at_facet));
    const V3 through = select(eta == one, -wo, bent);
    const M straight = term.delta | (abs(eta - one) < F(1e-4f));
    const F shadowing = select(straight, one, facet_g2(term, wo, through) / term.g1);
    wi = select(reflects, back, through);
    weight = select(reflects, weight, response.through * (term.energy * shadowing / rest));
  }
  const F probability = select(reflects, share, rest);
  const M single = mine & (term.delta | (term.delta_through & !reflects));
  const M right = (wi.z > zero) & reflects, left = (wi.z < zero) & !reflects;
  const M dark = black(response.reflected) & black(response.through);
  direction.wi = select(mine, wi, direction.wi);
  direction.weight = select(single, term.color * weight / term.probability, direction.weight);
  direction.single = direction.single | single;
  const M likely = term.probability * probability > zero;
  const M valid = (!dark) & (right | left) & ((!single) | likely);
  direction.valid = (direction.valid & !mine) | (mine & valid);
}

// Bsdf::sample().
LANCER_LANE WideSample sample_bsdf(const WideBsdf &bsdf, F u_lobe, F u, F v) {
  const F zero(0.0f);
  // Pick a lobe by its probability.
  const WidePick picked = pick(bsdf, u_lobe);
  const M glossy = picked.facets;

  // Draw a direction from it.
  V3 h{zero, zero, zero};
  WideDirection direction{h, h, picked.matte, zero != zero};
  if (any(picked.matte))
    direction.wi = sample_cosine(u, v);
  if (any(glossy)) {
    const V3 facet = sample_visible(bsdf.wo, picked.alpha_x, picked.alpha_y, u, v);
    const V3 mirrored = F(2.0f) * dot(bsdf.wo, facet) * facet - bsdf.wo;
    direction.wi = select(glossy, mirrored, direction.wi);
    h = facet;
    const M above = glossy & (bsdf.wo.z > zero);
    direction.valid = direction.valid | (above & (mirrored.z > zero));
    for (int k = 0; k < bsdf.count; ++k) {
      const WideTerm &term = bsdf.terms[k];
      if (!any(term.facets))
        continue;
      const M mine = above & equal(picked.lobe, U(static_cast<uint32_t>(k))) & (term.glass | term.delta);
      if (any(mine))
        draw_side(bsdf, term, mine, picked.u, facet, mirrored, direction);
    }
  }
  const V3 wi = direction.wi;
  const M through = wi.z < zero;
  h = select(glossy, h, half_vector(bsdf.wo, wi));
  WideSample sample;
  sample.wi = to_world(bsdf.frame, wi);
  const F cos_ng = select(bsdf.flat & !direction.single, wi.z, dot(bsdf.ng, sample.wi));
  const M valid = direction.valid & (wi.z != zero) & !((cos_ng < zero) != through);
  sample.weight = direction.weight;
  sample.pdf = zero;
  sample.valid = valid;
  // Weigh with the sum over all lobes.
  if (any(valid & !direction.single)) {
    const WideValue value = sum_terms(bsdf, wi, h, picked.lobe);
    const V3 f = value.diffuse + value.glossy + value.transmission;
    sample.weight = select(direction.single, sample.weight, f / value.pdf);
    sample.pdf = select(direction.single, zero, value.pdf);
    sample.valid = valid & (direction.single | (value.pdf > zero));
  }
  sample.valid = sample.valid & !black(sample.weight);
  sample.glossy = glossy;
  sample.transmitted = through;
  return sample;
}

#undef LANCER_FIELD
#undef LANCER_FIELD3
#undef LANCER_WORD

} // namespace
} // namespace lancer
