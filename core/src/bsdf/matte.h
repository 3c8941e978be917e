// Lambert, and the other smooth, wide lobes, distinguished by Lobe::variant: Oren-Nayar, Burley's diffuse, velvet, the dust
// sheen of 3.x, translucency, Minnaert. Local frame, wo.z > 0. Values are f |cos(wi)| without the lobe's colour.
#pragma once

#include "bsdf/beckmann.h"
#include "bsdf/classic_lobes.h"
#include "bsdf/lobe.h"
#include "sampling/warp.h"

namespace lancer {

// Minnaert: f = (k + 1) / (2 pi) (cos_i cos_o)^(k - 1), the reciprocal law of limb darkening (Minnaert 1941; scaled as the
// diffuse lobe of Lafortune et al. 1997), k = Lobe::shininess. k = 1 is Lambert; larger k darkens the rim; smaller k brightens
// it.
//
// Energy: the albedo of colour rho is rho cos_o^(k - 1): rho at normal incidence, and for k < 1 more than 1 towards the
// horizon. Cosines are therefore clamped to at least m = rho^(1 / (1 - k)), at which the albedo is 1; rho is the colour's
// largest channel. With
//   c = max(cos, m) in both powers, and A = integral of c_i^(k - 1) cos_i = 2 pi ((1 - m^(k+1)) / (k + 1) + m^(k+1) / 2),
//   f = (c_i c_o)^(k - 1) / A, albedo rho c_o^(k - 1) <= 1, equal to rho at c_o = 1.
// f remains reciprocal. It is the law above if m is 0 (k >= 1, or a dark colour), and Lambert if k < 1 and the colour is white.

// Lower bound on logarithms of cosines, so that their powers of two stay in the range of float.
inline constexpr float kLowestLogCosine = -40.0f;

// Returns log max(cos, m), from the tangent, which keeps its digits near the normal; behind the surface log m.
template <class F> LANCER_LANE F minnaert_log_cosine(const Lobe<F> &lobe, const Vec3<F> &w) {
  return select(w.z > 0.0f, max(-0.5f * log1p(tan2_theta(w)), lobe.alpha_x), lobe.alpha_x);
}

// Returns max(cos of w, m)^(k - 1).
template <class F> LANCER_LANE F minnaert_power(const Lobe<F> &lobe, const Vec3<F> &w) {
  return exp((lobe.shininess - 1.0f) * minnaert_log_cosine(lobe, w));
}

// The parts of A / (2 pi) above and below m.
template <class F> struct MinnaertParts { F above, below; };
template <class F> LANCER_LANE MinnaertParts<F> minnaert_parts(const Lobe<F> &lobe) {
  const F exponent = (lobe.shininess + 1.0f) * lobe.alpha_x; // of m^(k + 1)
  return {-expm1(exponent) / (lobe.shininess + 1.0f), 0.5f * exp(exponent)};
}

// Requires the lobe's colour and k; sets alpha_x to log m, alpha_y to 1 / A, energy to the factor of f that depends on wo. rho:
// the largest channel of the surface's own colour, without weights of mixtures.
template <class F> LANCER_LANE void complete_minnaert(Lobe<F> &lobe, F rho, const Vec3<F> &wo) {
  const F k = lobe.shininess, lowest(kLowestLogCosine);
  lobe.alpha_x = select(k < 1.0f, max(log(min(rho, F(1.0f))) / (1.0f - k), lowest), lowest);
  const MinnaertParts<F> parts = minnaert_parts(lobe);
  lobe.alpha_y = 1.0f / (2.0f * kPi * (parts.above + parts.below));
  lobe.energy = minnaert_power(lobe, wo);
  lobe.albedo = lobe.color * lobe.energy;
}

// Returns f cos, and the density of minnaert_sample.
template <class F> LANCER_LANE LobeValue<F> minnaert_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wi) {
  const F pdf = lobe.alpha_y * minnaert_power(lobe, wi) * wi.z;
  return {lobe.energy * pdf, pdf};
}

template <class F> LANCER_LANE Vec3<F> minnaert_sample(const Lobe<F> &lobe, F u, F v) {
  // Above m the share of directions within an angle is 1 - cos^(k + 1); below m the remaining share falls with cos^2.
  const MinnaertParts<F> parts = minnaert_parts(lobe);
  const F inside = u * (parts.above + parts.below);
  const auto high = (inside < parts.above) | (parts.below == F(0.0f));
  const Vec3<F> above = sample_cosine_power(lobe.shininess, min(inside * (lobe.shininess + 1.0f), F(1.0f)), v);
  const F rest = (1.0f - u) * (parts.above + parts.below) / parts.below;
  const F cosine = exp(lobe.alpha_x) * sqrt(min(rest, F(1.0f)));
  const F sine = sqrt((1.0f - cosine) * (1.0f + cosine));
  const SinCos<F> phi = sin_cos_turn(v);
  return select(high, above, Vec3<F>(sine * phi.cos, sine * phi.sin, cosine));
}

enum class Matte : uint8_t {
  OrenNayar = 0,
  Burley = 1,
  Velvet = 2,
  DustSheen = 3,
  Translucent = 4,
  Minnaert = 5,
  RoughTranslucent = 6, // OrenNayar on the other side
  BurleyExit = 7        // of light that leaves the surface after a walk below it
};
template <class F> bool is_matte(const Lobe<F> &lobe, Matte variant) {
  return lobe.shape == LobeShape::Matte && lobe.variant == static_cast<uint8_t>(variant);
}

// Below this roughness Cycles replaces Oren-Nayar by Lambert.
inline constexpr float kLambertRoughness = 1e-5f;

template <class F> LANCER_LANE F fifth_power(F x) { return x * x * (x * x) * x; }

// (1 - cos)^5, Schlick's weight.
template <class F> LANCER_LANE F schlick_weight(F cos_theta) { return fifth_power(clamp01(1.0f - cos_theta)); }

// The part of Fujii's directional albedo that the roughness scales. (1 - s^3) tan is factored so that the horizon needs no
// special case.
template <class F> LANCER_LANE F oren_nayar_g(F cos_theta) {
  const F c = clamp01(cos_theta);
  const F s = sqrt((1.0f - c) * (1.0f + c));
  return s * (atan2(s, c) - 2.0f / 3.0f - s * c) + 2.0f / 3.0f * s * c * (1.0f + s + s * s) / (1.0f + s);
}

// Blender's Diffuse BSDF. weight includes the colour; preserving: the form of 4.3 and newer, which returns lost light with the
// colour of each further bounce. A smooth one is Lambert: alpha_x is 0.
template <class F>
LANCER_LANE Lobe<F> make_diffuse(const Vec3<F> &weight, const Vec3<F> &color, F roughness, bool preserving, F cos_o) {
  Lobe<F> lobe;
  lobe.component = Component::Diffuse;
  lobe.color = lobe.albedo = weight;
  lobe.shape = LobeShape::Lambert;
  const auto rough = roughness >= kLambertRoughness;
  if (!any(rough))
    return lobe;
  lobe.shape = LobeShape::Matte;
  lobe.variant = static_cast<uint8_t>(Matte::OrenNayar);
  const F sigma = min(roughness, F(1.0f));
  const F a = 1.0f / (kPi + sigma * (0.5f * kPi - 2.0f / 3.0f)), b = sigma * a;
  lobe.alpha_x = select(rough, a, F(0.0f));
  lobe.alpha_y = b;
  lobe.f0 = Vec3<F>(F(0.0f));
  if (preserving) {
    // The loss of single scattering, distributed by the reciprocal product of the loss in both directions.
    const Vec3<F> rho = clamp01(color), one(F(1.0f));
    const F mean = a * kPi + (2.0f * kPi - 5.6f) / 3.0f * b;
    const Vec3<F> bounces = rho * rho * (mean / (1.0f - mean)) / (one - rho * (1.0f - mean));
    lobe.f0 = kInvPi * bounces * (1.0f - (a * kPi + b * oren_nayar_g(cos_o)));
  }
  return lobe;
}

template <class F> LANCER_LANE Lobe<F> make_matte(Matte variant, const Vec3<F> &weight) {
  Lobe<F> lobe;
  lobe.shape = LobeShape::Matte;
  lobe.variant = static_cast<uint8_t>(variant);
  lobe.component = Component::Diffuse;
  lobe.color = lobe.albedo = weight;
  return lobe;
}

template <class F> LANCER_LANE Lobe<F> make_lambert(const Vec3<F> &weight, uint8_t frame, Rules rules) {
  Lobe<F> lobe;
  lobe.shape = LobeShape::Lambert;
  lobe.component = Component::Diffuse;
  lobe.color = lobe.albedo = weight;
  lobe.frame = frame;
  lobe.rules = rules;
  return lobe;
}

// The diffuse lobe of Principled in 3.x.
template <class F> LANCER_LANE Lobe<F> make_burley(const Vec3<F> &weight, F roughness) {
  Lobe<F> lobe = make_matte<F>(Matte::Burley, weight);
  lobe.alpha_x = roughness;
  return lobe;
}
// The part of it that returns light towards its source. The expected light is small, so that samples are left to the walk below
// the surface.
template <class F> LANCER_LANE Lobe<F> make_retroreflection(const Vec3<F> &weight, F roughness, F cos_o) {
  Lobe<F> lobe = make_burley(weight, roughness);
  lobe.energy = F(0.0f);
  lobe.albedo = weight * (roughness * schlick_weight(cos_o));
  return lobe;
}

// Ashikhmin's velvet; Cycles clamps sigma to at least 0.01, and shows the light in the glossy passes.
template <class F> LANCER_LANE Lobe<F> make_velvet(const Vec3<F> &weight, F sigma) {
  Lobe<F> lobe = make_matte<F>(Matte::Velvet, weight);
  lobe.component = Component::Glossy;
  const F s = min(max(sigma, F(0.01f)), F(1.0f));
  lobe.alpha_x = 1.0f / (s * s);
  return lobe;
}

// Minnaert of CLASSIC; rho: see complete_minnaert.
template <class F> LANCER_LANE Lobe<F> make_minnaert(const Vec3<F> &weight, F k, F rho, const Vec3<F> &wo) {
  Lobe<F> lobe = make_matte<F>(Matte::Minnaert, weight);
  lobe.shininess = k;
  complete_minnaert(lobe, rho, wo);
  return lobe;
}

// Translucent light counts as diffuse, as in Cycles: in passes, and for lights hidden from such rays.
template <class F> bool matte_transmits(const Lobe<F> &lobe) {
  return is_matte(lobe, Matte::Translucent) || is_matte(lobe, Matte::RoughTranslucent);
}

// Returns f cos, which is also the density of its sampler.
template <class V> LANCER_LANE ColorValue<NumberOf<V>> lambert_eval(const V &wi) {
  const NumberOf<V> value = warp_cosine_hemisphere_pdf(wi.z);
  return {V(value), value};
}

template <class F> LANCER_LANE ColorValue<F> oren_nayar_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F a = lobe.alpha_x, b = lobe.alpha_y, cos_o = max(wo.z, F(0.0f));
  F t = dot(wi, wo) - wi.z * cos_o;
  t = select(t > 0.0f, t / max(wi.z, cos_o), t);
  Vec3<F> f(a + b * t);
  const auto returned = !black(lobe.f0);
  if (any(returned))
    f = select(returned, f + lobe.f0 * (1.0f - (a * kPi + b * oren_nayar_g(wi.z))), f);
  const F pdf = warp_cosine_hemisphere_pdf(wi.z);
  const auto rough = a > 0.0f;
  return {select(rough, f * wi.z, Vec3<F>(pdf)), pdf};
}

template <class F> LANCER_LANE ColorValue<F> burley_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F view = schlick_weight(wo.z), light = schlick_weight(wi.z);
  // 2 cos^2 of the difference angle is 1 + wi.wo; it scales retroreflection.
  const F back = lobe.alpha_x * (dot(wi, wo) + 1.0f);
  const F f =
      lobe.energy * ((1.0f - 0.5f * view) * (1.0f - 0.5f * light)) + back * (light + view + light * view * (back - 1.0f));
  return {Vec3<F>(f * wi.z * kInvPi), warp_cosine_hemisphere_pdf(wi.z)};
}

// alpha_x: the share that Fresnel's weight may take, 1/2 or, for plain diffuse light, 0.
template <class F> LANCER_LANE ColorValue<F> burley_exit_eval(const Lobe<F> &lobe, const Vec3<F> &wi) {
  const F pdf = warp_cosine_hemisphere_pdf(wi.z);
  return {Vec3<F>((1.0f - lobe.alpha_x * schlick_weight(wi.z)) * pdf), pdf};
}

template <class F> LANCER_LANE ColorValue<F> velvet_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F zero(0.0f), pdf(0.5f * kInvPi);
  const Vec3<F> h = half_vector(wo, wi);
  const F sin2 = h.x * h.x + h.y * h.y, cos_ho = dot(h, wo);
  const F inv_sigma2 = lobe.alpha_x;
  // Fibres perpendicular to the normal: an inverted Gaussian, which vanishes faster than any power of the sine.
  const F exponent = h.z * h.z / sin2 * inv_sigma2;
  const auto there = (sin2 > zero) & (cos_ho > zero) & (abs(exponent) < __builtin_inff());
  const F d = exp(-exponent) * inv_sigma2 * kInvPi / (sin2 * sin2);
  const F ratio = 2.0f * h.z / cos_ho;
  const F g = min(min(F(1.0f), ratio * wo.z), ratio * wi.z);
  return {select(there, Vec3<F>(0.25f * d * g / wo.z), Vec3<F>(zero)), pdf};
}

template <class V> LANCER_LANE ColorValue<NumberOf<V>> dust_sheen_eval(const V &wo, const V &wi) {
  const NumberOf<V> cos_h = dot(wi, half_vector(wo, wi));
  return {V(schlick_weight(cos_h) * wi.z), warp_cosine_hemisphere_pdf(wi.z)};
}

// 0 if wi is on the wrong side: above for translucency, below for all others. Velvet and dust are also 0 if wo is behind the
// normal. The other lobes use their values at the horizon there, for coarse meshes whose interpolated normals face away from
// the viewer.
template <class F> LANCER_LANE ColorValue<F> matte_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F zero(0.0f);
  const MaskOf<F> above = wi.z > zero, seen = above & (wo.z > zero);
  switch (static_cast<Matte>(lobe.variant)) {
  case Matte::OrenNayar:
    return where<F>(above, oren_nayar_eval(lobe, wo, wi));
  case Matte::Burley:
    return where<F>(above, burley_eval(lobe, wo, wi));
  case Matte::BurleyExit:
    return where<F>(above, burley_exit_eval(lobe, wi));
  case Matte::Velvet:
    return where<F>(seen, velvet_eval(lobe, wo, wi));
  case Matte::DustSheen:
    return where<F>(seen, dust_sheen_eval(wo, wi));
  case Matte::Minnaert: {
    const LobeValue<F> value = minnaert_eval_pdf(lobe, wi);
    return where<F>(above, {Vec3<F>(value.f), value.pdf});
  }
  case Matte::RoughTranslucent: {
    const Vec3<F> mirrored = mirrored_beyond(wi);
    return where<F>(mirrored.z > zero, oren_nayar_eval(lobe, wo, mirrored));
  }
  case Matte::Translucent:
    break;
  }
  const F value = max(-wi.z, zero) * kInvPi;
  return {Vec3<F>(value), value};
}

// Samples the hemisphere uniformly: velvet is brightest along the horizon.
template <class F> LANCER_LANE Vec3<F> velvet_sample(F u, F v) {
  const F sin_theta = sqrt((1.0f - u) * (1.0f + u));
  const SinCos<F> phi = sin_cos_turn(v);
  return {sin_theta * phi.cos, sin_theta * phi.sin, u};
}

// Returns whether a lobe samples by the cosine, so that lanes may share the warp.
template <class F> bool draws_cosines(const Lobe<F> &lobe) {
  return lobe.shape == LobeShape::Lambert ||
         (lobe.shape == LobeShape::Matte && !is_matte(lobe, Matte::Velvet) && !is_matte(lobe, Matte::Minnaert));
}

} // namespace lancer
