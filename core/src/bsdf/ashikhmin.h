// Two glossy lobes without a Smith term, distinguished by Lobe::variant: Ashikhmin-Shirley's anisotropic Phong, and the clear
// coat of Blender 3.x. Local frame, wo.z > 0; values are f cos(wi) without the lobe's colour.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "sampling/warp.h"

namespace lancer {

enum class Gloss : uint8_t { AshikhminShirley = 0, ClearCoat = 1 };
template <class F> bool is_clear_coat(const Lobe<F> &lobe) { return lobe.variant == static_cast<uint8_t>(Gloss::ClearCoat); }

// Cycles clamps both roughnesses to at least this, and treats the lobe as a mirror if neither exceeds it.
inline constexpr float kAshikhminAlpha = 1e-4f;

template <class F> LANCER_LANE Lobe<F> make_ashikhmin(const Vec3<F> &weight, F alpha_x, F alpha_y) {
  const F least(kAshikhminAlpha), one(1.0f);
  Lobe<F> lobe;
  lobe.shape = LobeShape::Ashikhmin;
  lobe.variant = static_cast<uint8_t>(Gloss::AshikhminShirley);
  lobe.component = Component::Glossy;
  lobe.alpha_x = min(max(alpha_x, least), one);
  lobe.alpha_y = min(max(alpha_y, least), one);
  lobe.delta = max(lobe.alpha_x, lobe.alpha_y) <= least;
  lobe.color = lobe.albedo = weight;
  return lobe;
}

// Returns the dielectric's Fresnel curve, remapped to start at f0 and end at 1.
template <class F> LANCER_LANE F lifted_fresnel(F cos_theta, F ior, float f0) {
  const F r0 = fresnel_dielectric(F(1.0f), ior);
  return f0 + (1.0f - f0) * (fresnel_dielectric(cos_theta, ior) - r0) / (1.0f - r0);
}

// Makes a coating of IOR 1.5 with a quarter of its strength. cos_o: the cosine at which the albedo is evaluated, as in Cycles.
template <class F> LANCER_LANE Lobe<F> make_clear_coat(const Vec3<F> &weight, F alpha, F cos_o) {
  Lobe<F> lobe;
  lobe.shape = LobeShape::Ashikhmin;
  lobe.variant = static_cast<uint8_t>(Gloss::ClearCoat);
  lobe.component = Component::Glossy;
  lobe.alpha_x = lobe.alpha_y = clamp01(alpha);
  // Cycles treats the coat as a mirror if alpha^2 is 1e-7 or less.
  lobe.delta = lobe.alpha_x * lobe.alpha_x <= 1e-7f;
  lobe.ior = F(1.5f);
  lobe.color = 0.25f * weight;
  lobe.albedo = lobe.color * lifted_fresnel(cos_o, lobe.ior, 0.04f);
  return lobe;
}

// Returns the weight of a mirror of the lobe's kind, without its colour.
template <class F> LANCER_LANE F gloss_delta_weight(const Lobe<F> &lobe, const Vec3<F> &wo) {
  return is_clear_coat(lobe) ? lifted_fresnel(wo.z, lobe.ior, 0.04f) : F(1.0f);
}

// Returns the exponent along x of a lobe as wide as GGX with this alpha.
template <class F> LANCER_LANE F ashikhmin_exponent(F alpha) {
  return 2.0f * (1.0f - alpha) * (1.0f + alpha) / (alpha * alpha);
}

template <class F> LANCER_LANE ColorValue<F> ashikhmin_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F zero(0.0f), one(1.0f), n_x = ashikhmin_exponent(lobe.alpha_x), n_y = ashikhmin_exponent(lobe.alpha_y);
  const Vec3<F> h = half_vector(wo, wi);
  const F cos_h = dot(h, wo), sin2 = h.x * h.x + h.y * h.y;
  // cos^e of h from its sine: log(cos) = log1p(-sin^2) / 2 keeps the digits of narrow lobes.
  const F across = select(sin2 > zero, (n_x * h.x * h.x + n_y * h.y * h.y) / sin2, zero);
  const F power = select(sin2 < one, exp(0.5f * across * log1p(-sin2)), select(across > zero, zero, one));
  const F pdf = sqrt((n_x + 1.0f) * (n_y + 1.0f)) * (0.125f * kInvPi) * power / cos_h;
  // The density overflows float if the directions are opposite along the horizon.
  const auto held = (cos_h > zero) & (abs(pdf) < __builtin_inff());
  return where<F>(held, {Vec3<F>(pdf * wi.z / max(wo.z, wi.z)), pdf});
}

template <class F> LANCER_LANE Vec3<F> ashikhmin_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const F n_x = ashikhmin_exponent(lobe.alpha_x), n_y = ashikhmin_exponent(lobe.alpha_y);
  // Sample an ellipse of azimuths, quadrant by quadrant to avoid a division by 0.
  const F quadrant = floor(4.0f * u), share = 4.0f * u - quadrant;
  const SinCos<F> even = sin_cos_turn(0.25f * share);
  const F phi_quarter = atan2(sqrt(n_x + 1.0f) * even.sin, sqrt(n_y + 1.0f) * even.cos);
  const auto mirrored = (quadrant == F(1.0f)) | (quadrant == F(3.0f));
  const F phi = select(mirrored, -phi_quarter, phi_quarter) + kPi * -floor(-0.5f * quadrant);
  const F c = cos(phi), s = sin(phi);
  // 1 - cos(theta) by expm1 keeps the digits of narrow lobes.
  const F x = -expm1(log1p(-v) / (n_x * c * c + n_y * s * s + 1.0f));
  const F sin_theta = sqrt(x * (2.0f - x));
  return reflect_about(wo, Vec3<F>(sin_theta * c, sin_theta * s, 1.0f - x));
}

// Generalised Trowbridge-Reitz with exponent 1, with sin^2 so that narrow peaks keep their digits.
template <class F> LANCER_LANE F gtr1_d(const Vec3<F> &h, F alpha) {
  const F a2 = alpha * alpha, sin2 = h.x * h.x + h.y * h.y;
  return select(a2 >= F(1.0f), F(kInvPi), (1.0f - a2) / (-kPi * log(a2) * (a2 + sin2 * (1.0f - a2))));
}

// Smith's G1 of GGX with the constant alpha 0.25.
template <class F> LANCER_LANE F clear_coat_g1(F cos_theta) {
  const F tan2 = (1.0f - cos_theta) * (1.0f + cos_theta) / (cos_theta * cos_theta);
  return 2.0f / (1.0f + sqrt(1.0f + 0.0625f * tan2));
}

template <class F> LANCER_LANE ColorValue<F> clear_coat_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const Vec3<F> h = half_vector(wo, wi);
  const F cos_h = dot(wo, h);
  const F d = gtr1_d(h, lobe.alpha_x);
  const F f = 0.25f * d * lifted_fresnel(cos_h, lobe.ior, 0.04f) * clear_coat_g1(wo.z) * clear_coat_g1(wi.z) / wo.z;
  return where<F>((cos_h > 0.0f) & (h.z > 0.0f), {Vec3<F>(f), 0.25f * d * h.z / cos_h});
}

template <class F> LANCER_LANE Vec3<F> clear_coat_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const F a2 = lobe.alpha_x * lobe.alpha_x;
  // cos^2 = (1 - a2^(1 - u)) / (1 - a2), so that sin^2 = a2 (a2^(-u) - 1) / (1 - a2).
  const F sin2 = select(a2 < F(1.0f), a2 * expm1(-u * log(a2)) / (1.0f - a2), u);
  const F sin_theta = sqrt(min(sin2, F(1.0f)));
  const SinCos<F> phi = sin_cos_turn(v);
  return reflect_about(wo, Vec3<F>(sin_theta * phi.cos, sin_theta * phi.sin, sqrt(max(F(0.0f), 1.0f - sin2))));
}

// Evaluates either lobe; 0 below the horizon. A mirror has no value, see gloss_delta_weight.
template <class F> LANCER_LANE ColorValue<F> gloss_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const auto above = (wi.z > 0.0f) & (wo.z > 0.0f);
  return where<F>(above, is_clear_coat(lobe) ? clear_coat_eval(lobe, wo, wi) : ashikhmin_eval(lobe, wo, wi));
}

// Samples either lobe. wi.z <= 0: below the horizon, no sample.
template <class F> LANCER_LANE Vec3<F> gloss_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  return is_clear_coat(lobe) ? clear_coat_sample(lobe, wo, u, v) : ashikhmin_sample(lobe, wo, u, v);
}

} // namespace lancer
