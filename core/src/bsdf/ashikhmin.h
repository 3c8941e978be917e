// Two glossy lobes that no Smith term rules: Ashikhmin-Shirley's anisotropic Phong, and the clear coat of Blender 3.x, told
// apart by Lobe::variant. Local frame, wo.z > 0; values are f cos(wi) without the lobe's colour.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/matte.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"

namespace lancer {

enum class Gloss : uint8_t { AshikhminShirley = 0, ClearCoat = 1 };

// Cycles keeps both roughnesses at this or more, and takes the lobe for a mirror where neither exceeds it.
inline constexpr float kAshikhminAlpha = 1e-4f;

inline Lobe make_ashikhmin(const glm::vec3 &weight, float alpha_x, float alpha_y) {
  Lobe lobe;
  lobe.shape = LobeShape::Ashikhmin;
  lobe.variant = static_cast<uint8_t>(Gloss::AshikhminShirley);
  lobe.component = Component::Glossy;
  lobe.alpha_x = std::clamp(alpha_x, kAshikhminAlpha, 1.0f);
  lobe.alpha_y = std::clamp(alpha_y, kAshikhminAlpha, 1.0f);
  lobe.delta = std::max(lobe.alpha_x, lobe.alpha_y) <= kAshikhminAlpha;
  lobe.color = lobe.albedo = weight;
  return lobe;
}

// The dielectric's Fresnel curve, moved so that it starts at f0 and still ends at 1.
inline float lifted_fresnel(float cos_theta, float ior, float f0) {
  const float r0 = fresnel_dielectric(1.0f, ior);
  return f0 + (1.0f - f0) * (fresnel_dielectric(cos_theta, ior) - r0) / (1.0f - r0);
}

// A quarter of a coating of IOR 1.5; cos_o for the albedo that Cycles gives it.
inline Lobe make_clear_coat(const glm::vec3 &weight, float alpha, float cos_o) {
  Lobe lobe;
  lobe.shape = LobeShape::Ashikhmin;
  lobe.variant = static_cast<uint8_t>(Gloss::ClearCoat);
  lobe.component = Component::Glossy;
  lobe.alpha_x = lobe.alpha_y = std::clamp(alpha, 0.0f, 1.0f);
  // Cycles calls it a mirror where alpha^2 is 1e-7 or less.
  lobe.delta = lobe.alpha_x * lobe.alpha_x <= 1e-7f;
  lobe.ior = 1.5f;
  lobe.color = 0.25f * weight;
  lobe.albedo = lobe.color * lifted_fresnel(cos_o, lobe.ior, 0.04f);
  return lobe;
}

// What a mirror of the lobe's kind weighs, without its colour.
inline float gloss_delta_weight(const Lobe &lobe, const glm::vec3 &wo) {
  return lobe.variant == static_cast<uint8_t>(Gloss::ClearCoat) ? lifted_fresnel(wo.z, lobe.ior, 0.04f) : 1.0f;
}

// Exponent along x of a lobe as wide as GGX of that alpha.
inline float ashikhmin_exponent(float alpha) { return 2.0f * (1.0f - alpha) * (1.0f + alpha) / (alpha * alpha); }

inline ColorValue ashikhmin_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  const float n_x = ashikhmin_exponent(lobe.alpha_x), n_y = ashikhmin_exponent(lobe.alpha_y);
  const glm::vec3 h = half_vector(wo, wi);
  const float cos_h = glm::dot(h, wo), sin2 = h.x * h.x + h.y * h.y;
  if (!(cos_h > 0.0f))
    return {};
  // cos^e of h from its sine: log(cos) = log1p(-sin^2) / 2 keeps narrow lobes apart.
  const float across = sin2 > 0.0f ? (n_x * h.x * h.x + n_y * h.y * h.y) / sin2 : 0.0f;
  const float power = sin2 < 1.0f ? exp(0.5f * across * log1p(-sin2)) : (across > 0.0f ? 0.0f : 1.0f);
  const float pdf = std::sqrt((n_x + 1.0f) * (n_y + 1.0f)) * (0.125f * kInvPi) * power / cos_h;
  // A float cannot hold it where both directions are opposite along the horizon.
  if (!std::isfinite(pdf))
    return {};
  return {glm::vec3(pdf * wi.z / std::max(wo.z, wi.z)), pdf};
}

inline glm::vec3 ashikhmin_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  const float n_x = ashikhmin_exponent(lobe.alpha_x), n_y = ashikhmin_exponent(lobe.alpha_y);
  // An ellipse of azimuths, quadrant by quadrant so that nothing is divided by 0.
  const float quadrant = std::floor(4.0f * u.x), share = 4.0f * u.x - quadrant;
  const SinCos even = sin_cos_turn(0.25f * share);
  const float phi_quarter = atan2(std::sqrt(n_x + 1.0f) * even.sin, std::sqrt(n_y + 1.0f) * even.cos);
  const bool mirrored = quadrant == 1.0f || quadrant == 3.0f;
  const float phi = (mirrored ? -phi_quarter : phi_quarter) + kPi * std::ceil(0.5f * quadrant);
  const float c = cos(phi), s = sin(phi);
  // 1 - cos(theta) by expm1, as narrow lobes need.
  const float x = -expm1(log1p(-u.y) / (n_x * c * c + n_y * s * s + 1.0f));
  const float sin_theta = std::sqrt(x * (2.0f - x));
  const glm::vec3 h(sin_theta * c, sin_theta * s, 1.0f - x);
  return reflect_about(wo, h);
}

// Generalised Trowbridge-Reitz with exponent 1, with tan^2 so that narrow peaks keep their digits.
inline float gtr1_d(const glm::vec3 &h, float alpha) {
  const float a2 = alpha * alpha;
  if (a2 >= 1.0f)
    return kInvPi;
  const float sin2 = h.x * h.x + h.y * h.y;
  return (1.0f - a2) / (-kPi * log(a2) * (a2 + sin2 * (1.0f - a2)));
}

// Smith's G1 of GGX with the fixed alpha 0.25.
inline float clear_coat_g1(float cos_theta) {
  const float tan2 = (1.0f - cos_theta) * (1.0f + cos_theta) / (cos_theta * cos_theta);
  return 2.0f / (1.0f + std::sqrt(1.0f + 0.0625f * tan2));
}

inline ColorValue clear_coat_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  const glm::vec3 h = half_vector(wo, wi);
  const float cos_h = glm::dot(wo, h);
  if (!(cos_h > 0.0f && h.z > 0.0f))
    return {};
  const float d = gtr1_d(h, lobe.alpha_x);
  const float f = 0.25f * d * lifted_fresnel(cos_h, lobe.ior, 0.04f) * clear_coat_g1(wo.z) * clear_coat_g1(wi.z) / wo.z;
  return {glm::vec3(f), 0.25f * d * h.z / cos_h};
}

inline glm::vec3 clear_coat_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  const float a2 = lobe.alpha_x * lobe.alpha_x;
  // cos^2 = (1 - a2^(1 - u)) / (1 - a2), so that sin^2 = a2 (a2^(-u) - 1) / (1 - a2).
  const float sin2 = a2 < 1.0f ? a2 * expm1(-u.x * log(a2)) / (1.0f - a2) : u.x;
  const float sin_theta = std::sqrt(std::min(sin2, 1.0f));
  const SinCos phi = sin_cos_turn(u.y);
  const glm::vec3 h(sin_theta * phi.cos, sin_theta * phi.sin, std::sqrt(std::max(0.0f, 1.0f - sin2)));
  return reflect_about(wo, h);
}

// Both of the shape; 0 below the horizon. A mirror has no value: gloss_delta_weight.
inline ColorValue gloss_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  if (!(wi.z > 0.0f && wo.z > 0.0f))
    return {};
  return lobe.variant == static_cast<uint8_t>(Gloss::ClearCoat) ? clear_coat_eval(lobe, wo, wi) : ashikhmin_eval(lobe, wo, wi);
}

// wi.z <= 0: below the horizon, no sample.
inline glm::vec3 gloss_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  return lobe.variant == static_cast<uint8_t>(Gloss::ClearCoat) ? clear_coat_sample(lobe, wo, u)
                                                                : ashikhmin_sample(lobe, wo, u);
}

} // namespace lancer
