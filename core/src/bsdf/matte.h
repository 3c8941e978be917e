// Smooth, wide lobes, told apart by Lobe::variant: Oren-Nayar, Burley's diffuse, velvet, the dust sheen of 3.x, translucency,
// Minnaert.
// Local frame, wo.z > 0. Values are f |cos(wi)| without the lobe's colour.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"
#include "bsdf/minnaert.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"

namespace lancer {

enum class Matte : uint8_t { OrenNayar = 0, Burley = 1, Velvet = 2, DustSheen = 3, Translucent = 4, Minnaert = 5 };

// Coloured, with the cosine in it; pdf per solid angle of wi.
struct ColorValue {
  glm::vec3 f{0.0f};
  float pdf = 0.0f;
};

// Below this roughness Cycles takes Lambert in place of Oren-Nayar.
inline constexpr float kLambertRoughness = 1e-5f;

inline float fifth_power(float x) { return x * x * (x * x) * x; }

// (1 - cos)^5, Schlick's weight.
inline float schlick_weight(float cos_theta) { return fifth_power(std::clamp(1.0f - cos_theta, 0.0f, 1.0f)); }

// The part of Fujii's directional albedo that the roughness scales. (1 - s^3) tan is taken apart so that the horizon needs no
// case of its own.
inline float oren_nayar_g(float cos_theta) {
  const float c = std::clamp(cos_theta, 0.0f, 1.0f);
  const float s = std::sqrt((1.0f - c) * (1.0f + c));
  return s * (atan2(s, c) - 2.0f / 3.0f - s * c) + 2.0f / 3.0f * s * c * (1.0f + s + s * s) / (1.0f + s);
}

// Blender's Diffuse BSDF. weight carries the colour; preserving: the form of 4.3 and newer, whose lost light comes back with
// the colour's share of each further bounce. A smooth one is Lambert.
inline Lobe make_diffuse(const glm::vec3 &weight, const glm::vec3 &color, float roughness, bool preserving, float cos_o) {
  Lobe lobe;
  lobe.component = Component::Diffuse;
  lobe.color = lobe.albedo = weight;
  if (!(roughness >= kLambertRoughness)) {
    lobe.shape = LobeShape::Lambert;
    return lobe;
  }
  lobe.shape = LobeShape::Matte;
  lobe.variant = static_cast<uint8_t>(Matte::OrenNayar);
  const float sigma = std::min(roughness, 1.0f);
  const float a = 1.0f / (kPi + sigma * (0.5f * kPi - 2.0f / 3.0f)), b = sigma * a;
  lobe.alpha_x = a;
  lobe.alpha_y = b;
  lobe.f0 = glm::vec3(0.0f);
  if (preserving) {
    // Light that single scattering loses, spread by the reciprocal product of what both directions lack.
    const glm::vec3 rho = glm::clamp(color, 0.0f, 1.0f);
    const float mean = a * kPi + (2.0f * kPi - 5.6f) / 3.0f * b;
    const glm::vec3 bounces = rho * rho * (mean / (1.0f - mean)) / (1.0f - rho * (1.0f - mean));
    lobe.f0 = kInvPi * bounces * (1.0f - (a * kPi + b * oren_nayar_g(cos_o)));
  }
  return lobe;
}

inline Lobe make_matte(Matte variant, const glm::vec3 &weight) {
  Lobe lobe;
  lobe.shape = LobeShape::Matte;
  lobe.variant = static_cast<uint8_t>(variant);
  lobe.component = Component::Diffuse;
  lobe.color = lobe.albedo = weight;
  return lobe;
}

// Principled's diffuse of 3.x.
inline Lobe make_burley(const glm::vec3 &weight, float roughness) {
  Lobe lobe = make_matte(Matte::Burley, weight);
  lobe.alpha_x = roughness;
  return lobe;
}

// Ashikhmin's velvet; Cycles keeps sigma at 0.01 or more.
inline Lobe make_velvet(const glm::vec3 &weight, float sigma) {
  Lobe lobe = make_matte(Matte::Velvet, weight);
  const float s = std::clamp(sigma, 0.01f, 1.0f);
  lobe.alpha_x = 1.0f / (s * s);
  return lobe;
}

// Light that comes out behind. As in Cycles it counts as diffuse: in passes, and for lights that are hidden from such rays.
inline Lobe make_translucent(const glm::vec3 &weight) { return make_matte(Matte::Translucent, weight); }

// The course's Minnaert; rho as of complete_minnaert.
inline Lobe make_minnaert(const glm::vec3 &weight, float k, float rho, const glm::vec3 &wo) {
  Lobe lobe = make_matte(Matte::Minnaert, weight);
  lobe.shininess = k;
  complete_minnaert(lobe, rho, wo);
  return lobe;
}

inline bool matte_transmits(const Lobe &lobe) { return lobe.variant == static_cast<uint8_t>(Matte::Translucent); }

inline ColorValue oren_nayar_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  const float a = lobe.alpha_x, b = lobe.alpha_y;
  const float cos_o = std::max(wo.z, 0.0f);
  float t = glm::dot(wi, wo) - wi.z * cos_o;
  if (t > 0.0f)
    t /= std::max(wi.z, cos_o);
  glm::vec3 f(a + b * t);
  if (lobe.f0 != glm::vec3(0.0f))
    f += lobe.f0 * (1.0f - (a * kPi + b * oren_nayar_g(wi.z)));
  return {f * wi.z, warp_cosine_hemisphere_pdf(wi.z)};
}

inline ColorValue burley_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  const float view = schlick_weight(wo.z), light = schlick_weight(wi.z);
  // 2 cos^2 of the difference angle is 1 + wi.wo; it scales the light that turns back.
  const float back = lobe.alpha_x * (glm::dot(wi, wo) + 1.0f);
  const float f = (1.0f - 0.5f * view) * (1.0f - 0.5f * light) + back * (light + view + light * view * (back - 1.0f));
  return {glm::vec3(f * wi.z * kInvPi), warp_cosine_hemisphere_pdf(wi.z)};
}

inline ColorValue velvet_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  const float pdf = 0.5f * kInvPi;
  const glm::vec3 h = half_vector(wo, wi);
  const float sin2 = h.x * h.x + h.y * h.y, cos_ho = glm::dot(h, wo);
  const float inv_sigma2 = lobe.alpha_x;
  // Fibres that stand across the normal: an inverted Gaussian, which vanishes faster than any power of the sine.
  const float exponent = h.z * h.z / sin2 * inv_sigma2;
  if (!(sin2 > 0.0f && cos_ho > 0.0f && std::isfinite(exponent)))
    return {glm::vec3(0.0f), pdf};
  const float d = exp(-exponent) * inv_sigma2 * kInvPi / (sin2 * sin2);
  const float ratio = 2.0f * h.z / cos_ho;
  const float g = std::min({1.0f, ratio * wo.z, ratio * wi.z});
  return {glm::vec3(0.25f * d * g / wo.z), pdf};
}

inline ColorValue dust_sheen_eval(const glm::vec3 &wo, const glm::vec3 &wi) {
  const float cos_h = glm::dot(wi, half_vector(wo, wi));
  return {glm::vec3(schlick_weight(cos_h) * wi.z), warp_cosine_hemisphere_pdf(wi.z)};
}

// 0 where wi is on the wrong side: above for translucency, below for all others. Velvet and dust are also 0 where wo is behind
// the normal; the others go on as at the horizon, as where a coarse mesh's interpolated normal looks away from the viewer.
inline ColorValue matte_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  if (matte_transmits(lobe)) {
    const float value = std::max(-wi.z, 0.0f) * kInvPi;
    return {glm::vec3(value), value};
  }
  if (!(wi.z > 0.0f))
    return {};
  switch (static_cast<Matte>(lobe.variant)) {
  case Matte::OrenNayar:
    return oren_nayar_eval(lobe, wo, wi);
  case Matte::Burley:
    return burley_eval(lobe, wo, wi);
  case Matte::Velvet:
    return wo.z > 0.0f ? velvet_eval(lobe, wo, wi) : ColorValue{};
  case Matte::DustSheen:
    return wo.z > 0.0f ? dust_sheen_eval(wo, wi) : ColorValue{};
  case Matte::Minnaert: {
    const LobeValue value = minnaert_eval_pdf(lobe, wi);
    return {glm::vec3(value.f), value.pdf};
  }
  case Matte::Translucent:
    break;
  }
  return {};
}

// A direction with the density that matte_eval tells.
inline glm::vec3 matte_sample(const Lobe &lobe, glm::vec2 u) {
  if (lobe.variant == static_cast<uint8_t>(Matte::Velvet)) {
    // Even over the hemisphere: velvet is brightest along the horizon.
    const float sin_theta = std::sqrt((1.0f - u.x) * (1.0f + u.x));
    const SinCos phi = sin_cos_turn(u.y);
    return {sin_theta * phi.cos, sin_theta * phi.sin, u.x};
  }
  if (lobe.variant == static_cast<uint8_t>(Matte::Minnaert))
    return minnaert_sample(lobe, u);
  const glm::vec3 w = warp_cosine_hemisphere(u);
  return matte_transmits(lobe) ? glm::vec3(w.x, w.y, -w.z) : w;
}

} // namespace lancer
