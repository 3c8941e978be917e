// Bsdf for many lanes at once: Lambert and reflecting GGX about the shading normal, in layers or side by side. The same
// operations in the same order as bsdf_terms.h, microfacet.cpp and principled.cpp, so that each lane has their bits.
// For kernels only, like sampling/lanes.h.
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
  V3 color, albedo;
  F probability;
  F alpha_x, alpha_y, energy;
  V3 f0, f90, b, reflection;
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

// Reflectance of a dielectric, as fresnel() of fresnel.h.
LANCER_LANE F fresnel_dielectric(F cos_i, F eta) {
  const D c = min(max(widen(cos_i), D(0.0)), D(1.0));
  const D n = widen(eta), e = D(1.0) / n;
  const D cos2_t = (n - D(1.0)) * e * ((n + D(1.0)) * e) + (e * c) * (e * c);
  const D g = sqrt(cos2_t);
  const D rs = (e * c - g) / (e * c + g);
  const D rp = (c - e * g) / (c + e * g);
  F f = narrow(D(0.5) * (rs * rs + rp * rp));
  // Grazing, totally reflecting, and what bends nothing at all or everything.
  f = select((c == D(0.0)) | !(cos2_t > D(0.0)) | (eta == F(__builtin_inff())), F(1.0f), f);
  return select(eta == F(1.0f), F(0.0f), f);
}

LANCER_LANE V3 fresnel_f82(F cos_i, const V3 &f0, const V3 &b) {
  const F s = clamp01(F(1.0f) - cos_i), s2 = s * s, s5 = s2 * s2 * s;
  const F edge = cos_i * s5 * s;
  const V3 one{F(1.0f), F(1.0f), F(1.0f)};
  return clamp01(f0 + (one - f0) * s5 - b * edge);
}

// What facets reflect, by the cosine of wo against them.
LANCER_LANE V3 facet_reflected(const WideTerm &term, F cos_i) {
  V3 r{F(1.0f), F(1.0f), F(1.0f)};
  if (any(term.schlick | term.dielectric)) {
    const F f = fresnel_dielectric(cos_i, term.ior);
    const F along = clamp01((f - term.lowest) * term.per_range);
    const V3 curve = (term.f0 + (term.f90 - term.f0) * along) * term.reflection;
    r = select(term.schlick, curve, select(term.dielectric, f * term.reflection, r));
  }
  if (any(term.f82))
    r = select(term.f82, fresnel_f82(cos_i, term.f0, term.b), r);
  return r;
}

LANCER_LANE F read_row(const Records &records, int k, bool mixes, int n, F x) {
  x = clamp01(x) * F(static_cast<float>(n - 1));
  const U last(static_cast<uint32_t>(n - 2));
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
  term.energy = F(1.0f);
  const M preserving = equal(LANCER_WORD(preserving), U(1u)) & term.facets;
  if (any(preserving)) {
    const F single = read_row(records, k, false, 32, cos_o);
    const V3 further = LANCER_FIELD3(further);
    term.energy = select(preserving, F(1.0f) / single, term.energy);
    const M colored = preserving & !((further.x == F(1.0f)) & (further.y == F(1.0f)) & (further.z == F(1.0f)));
    const V3 kept = further * (F(1.0f) - single);
    term.color = select(colored, term.color * V3{single + kept.x, single + kept.y, single + kept.z}, term.color);
  }
  const M averaged = equal(LANCER_WORD(averaged), U(1u)) & term.facets;
  const M smooth = term.facets & !(term.schlick & !black(term.f0));
  V3 reflected = one;
  if (any(smooth))
    reflected = select(smooth, facet_reflected(term, cos_o), one);
  if (any(averaged)) {
    const F mix = read_row(records, k, true, 16, cos_o);
    const V3 schlick = (term.f0 + (term.f90 - term.f0) * mix) * term.reflection;
    const V3 f82 = term.f0 + (one - term.f0) * mix;
    const F dielectric = term.lowest + (F(1.0f) - term.lowest) * mix;
    const V3 mean = select(term.f82, f82, select(term.dielectric, dielectric * term.reflection, schlick));
    reflected = select(averaged & !black(reflected), mean, reflected);
  }
  term.albedo = select(term.facets, term.color * reflected, term.color);
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

// BsdfValue for light samples: parts that are diffuse and glossy.
struct WideValue {
  V3 diffuse, glossy;
  F pdf;
};

// h: the half vector of lanes that have one; wi local.
LANCER_LANE WideValue sum_terms(const WideBsdf &bsdf, const V3 &wi, const V3 &h) {
  const F zero(0.0f);
  WideValue value{{zero, zero, zero}, {zero, zero, zero}, zero};
  const F cos_oh = dot(bsdf.wo, h);
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
    const M facets = term.facets & there & above;
    if (any(facets)) {
      const F x = h.x / term.alpha_x, y = h.y / term.alpha_y, length2 = x * x + y * y + h.z * h.z;
      const F d = F(kWideInvPi) / (term.alpha_x * term.alpha_y * length2 * length2);
      const V3 reflected = facet_reflected(term, cos_oh);
      const F common = F(0.25f) * d;
      const F z = abs(wi.z), i = ggx_hidden(wi, term.alpha_x, term.alpha_y);
      const F seen = (bsdf.wo.z + term.hidden) * z + bsdf.wo.z * i;
      const F g2 = select(seen > zero, z / seen, zero);
      const M counts = facets & (d != zero);
      const V3 f = reflected * (term.energy * common * g2);
      // Facets that reflect nothing are never chosen.
      const F share = select(black(reflected), zero, F(1.0f));
      value.glossy = select(counts, value.glossy + term.color * f, value.glossy);
      value.pdf = select(counts, value.pdf + term.probability * (share * common * term.g1), value.pdf);
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
  return sum_terms(bsdf, local, half_vector(bsdf.wo, local));
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
  F pdf;
  M valid, glossy;
};

// Bsdf::sample().
LANCER_LANE WideSample sample_bsdf(const WideBsdf &bsdf, F u_lobe, F u, F v) {
  const F zero(0.0f);
  // Pick a lobe by its probability.
  M open = zero == zero, glossy = zero != zero, matte = glossy;
  F alpha_x(1.0f), alpha_y(1.0f);
  M last_facets = glossy, last_matte = glossy;
  F last_x(1.0f), last_y(1.0f);
  for (int k = 0; k < bsdf.count; ++k) {
    const WideTerm &term = bsdf.terms[k];
    const M there = open & (term.probability > zero);
    const M chosen = there & (u_lobe < term.probability);
    const M facets = term.facets;
    // Rounding may leave u beyond the last sum: then the last one is meant.
    last_facets = (last_facets & !there) | (there & facets);
    last_matte = (last_matte & !there) | (there & !facets);
    if (any(facets)) {
      last_x = select(there & facets, term.alpha_x, last_x);
      last_y = select(there & facets, term.alpha_y, last_y);
    }
    u_lobe = select(there & !chosen, u_lobe - term.probability, u_lobe);
    open = open & !chosen;
  }
  glossy = last_facets;
  matte = last_matte;
  alpha_x = last_x;
  alpha_y = last_y;

  // Draw a direction from it.
  V3 wi{zero, zero, zero}, h{zero, zero, zero};
  M valid = matte;
  if (any(matte))
    wi = sample_cosine(u, v);
  if (any(glossy)) {
    const V3 facet = sample_visible(bsdf.wo, alpha_x, alpha_y, u, v);
    const V3 mirrored = F(2.0f) * dot(bsdf.wo, facet) * facet - bsdf.wo;
    wi = select(glossy, mirrored, wi);
    h = facet;
    valid = valid | (glossy & (bsdf.wo.z > zero) & (mirrored.z > zero));
  }
  h = select(glossy, h, half_vector(bsdf.wo, wi));
  WideSample sample;
  sample.wi = to_world(bsdf.frame, wi);
  const F cos_ng = select(bsdf.flat, wi.z, dot(bsdf.ng, sample.wi));
  const M through = wi.z < zero;
  valid = valid & (wi.z != zero) & !((cos_ng < zero) != through);
  // Weigh with the sum over all lobes.
  const WideValue value = sum_terms(bsdf, wi, h);
  const V3 f = value.diffuse + value.glossy;
  sample.valid = valid & (value.pdf > zero) & !black(f);
  sample.weight = f / value.pdf;
  sample.pdf = value.pdf;
  sample.glossy = glossy;
  return sample;
}

#undef LANCER_FIELD
#undef LANCER_FIELD3
#undef LANCER_WORD

} // namespace
} // namespace lancer
