// Lobes of CLASSIC: mirrors and smooth glass, the rough coating, Phong and Blinn-Phong.
#pragma once

#include "bsdf/beckmann.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

#include <numbers>

namespace lancer {

// A direction of a delta lobe: weight without the lobe's colour, and the probability of having selected it.
template <class F> struct DeltaDirection {
  Vec3<F> wi{F(0.0f)};
  F weight{0.0f};
  F probability{0.0f};
};

template <class V> LANCER_LANE DeltaDirection<NumberOf<V>> mirror_sample(const V &wo) {
  using F = NumberOf<V>;
  return {reflect_local(wo), F(1.0f), F(1.0f)};
}

// A mirror weighted with Fresnel.
template <class F> LANCER_LANE DeltaDirection<F> smooth_coating_sample(const Lobe<F> &lobe, const Vec3<F> &wo) {
  return {reflect_local(wo), fresnel_dielectric(wo.z, lobe.ior), F(1.0f)};
}

// Smooth glass: reflects with probability F, else refracts. wo.z > 0; the lobe's index is that of the far side over that of the
// near side. u in [0, 1). Transmission does not scale the radiance by 1/eta^2: a path that leaves the glass again would undo
// the factor. Cycles omits the factor for lights and cameras inside glass, too.
template <class F> LANCER_LANE DeltaDirection<F> dielectric_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u) {
  const F eta = lobe.ior;
  const auto straight = eta == F(1.0f);
  const Fresnel<F> boundary = fresnel(wo.z, eta);
  // The probability of either choice equals its share, so that the weight is 1.
  const auto reflects = (u < boundary.reflectance) & !straight;
  const Vec3<F> through = select(straight, -wo, refract_local(wo, eta, boundary.cos_t));
  return {select(reflects, reflect_local(wo), through), F(1.0f),
          select(reflects, boundary.reflectance, select(straight, F(1.0f), 1.0f - boundary.reflectance))};
}

// Below this roughness a float half vector cannot distinguish directions of the lobe: it becomes a mirror weighted with F.
inline constexpr float kMirrorAlpha = 2e-5f;

// Beckmann's D in the form of the course's texts, for one roughness. It rounds otherwise than facet_d(), in the last bits.
template <class F> LANCER_LANE F coating_d(F tan2, F alpha) {
  const F alpha2 = alpha * alpha, sec2 = 1.0f + tan2;
  const auto near = tan2 <= 87.0f * alpha2;
  if (!any(near))
    return F(0.0f);
  return select(near, exp(-tan2 / alpha2) * sec2 * sec2 * kInvPi / alpha2, F(0.0f));
}

// Returns D if h is the half vector of a reflection, else 0.
template <class F> LANCER_LANE F coating_d(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &h) {
  return select((h.z > 0.0f) & (dot(wo, h) > 0.0f), coating_d(tan2_theta(h), lobe.alpha_x), F(0.0f));
}

// f; d: coating_d().
template <class F>
LANCER_LANE F coating_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, const Vec3<F> &h, F d) {
  // Compute each quotient of G1 and cosine as a whole, because both vanish at the horizon.
  const F a_o = beckmann_a(wo, lobe.alpha_x), a_i = beckmann_a(wi, lobe.alpha_x);
  const F reflectance = fresnel_dielectric(dot(wo, h), lobe.ior);
  return select(d != F(0.0f), 0.25f * d * reflectance * (beckmann_g1(a_o) / wo.z) * (beckmann_g1(a_i) / wi.z), F(0.0f));
}

template <class F>
LANCER_LANE LobeValue<F> coating_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, const Vec3<F> &h) {
  const F d = coating_d(lobe, wo, h);
  const auto there = d != F(0.0f);
  if (!any(there))
    return {};
  // Visible normals of density G1 (wo.h) D / wo.z become directions of density / (4 wo.h), so that wo.h cancels.
  const F seen = beckmann_g1_exact(beckmann_a(wo, lobe.alpha_x)) / wo.z;
  return where<F>(there, LobeValue<F>{coating_eval(lobe, wo, wi, h, d), 0.25f * d * seen});
}

// Estimates the reflected share of light from wo: Fresnel at n, and at a facet tilted away by the roughness. It is 0 only if F
// is 0 for every direction (ior = 1).
template <class F> LANCER_LANE F coating_albedo_estimate(const Lobe<F> &lobe, const Vec3<F> &wo) {
  const F leaning = wo.z / sqrt(1.0f + lobe.alpha_x * lobe.alpha_x);
  return 0.75f * fresnel_dielectric(wo.z, lobe.ior) + 0.25f * fresnel_dielectric(leaning, lobe.ior);
}

// Two lobes of a power of a cosine, n the shininess. Modified Phong: f = (n + 2) / (2 pi) max(0, R.V)^n around the mirrored
// direction R. Blinn-Phong: f = (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)) (N.H)^n, which reflects all light at normal incidence.

// Samples a direction around +z with density (n + 1) / (2 pi) cos^n: 1 - cos comes from expm1, which keeps the digits of narrow
// lobes.
template <class F> LANCER_LANE Vec3<F> sample_cosine_power(F n, F u, F v) {
  const F x = -expm1(log1p(-u) / (n + 1.0f));
  const F sin_theta = sqrt(x * (2.0f - x));
  const SinCos<F> phi = sin_cos_turn(v);
  return {sin_theta * phi.cos, sin_theta * phi.sin, 1.0f - x};
}

template <class F> LANCER_LANE LobeValue<F> phong_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  // 1 - R.V from the distance of both: near the peak a cosine has no digits left for the power.
  const Vec3<F> difference = reflect_local(wo) - wi;
  const F one_minus_cos = 0.5f * dot(difference, difference);
  const auto near = one_minus_cos < 1.0f;
  const F n = lobe.shininess;
  const F power = exp(n * log1p(-one_minus_cos)) * (0.5f * kInvPi);
  return where<F>(near, LobeValue<F>{(n + 2.0f) * power, (n + 1.0f) * power});
}

template <class F> LANCER_LANE Vec3<F> phong_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const Frame<F> around_mirror(reflect_local(wo));
  return around_mirror.to_world(sample_cosine_power(lobe.shininess, u, v));
}

template <class F> LANCER_LANE LobeValue<F> blinn_phong_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &h) {
  const F cos_oh = dot(wo, h), n = lobe.shininess;
  // cos^n from tan^2, which keeps its digits near n where the cosine has none.
  const F power = select(n > 0.0f, exp(-0.5f * n * log1p(tan2_theta(h))), F(1.0f));
  const F f = (n + 2.0f) * (0.125f * kInvPi) * ((n + 4.0f) / (exp(-0.5f * std::numbers::ln2_v<float> * n) + n)) * power;
  // Half vectors of density (n + 1) / (2 pi) cos^n become directions of density / (4 wo.h), which overflows float if both
  // directions are opposite along the horizon.
  const F pdf = (n + 1.0f) * (0.125f * kInvPi) * power / cos_oh;
  return where<F>((h.z > 0.0f) & (cos_oh > 0.0f) & (abs(pdf) < __builtin_inff()), LobeValue<F>{f, pdf});
}

} // namespace lancer
