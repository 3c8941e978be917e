// Unpolarised Fresnel reflectance of a smooth dielectric boundary, and the direction that goes through it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "sampling/elementary.h"

namespace lancer {

struct Fresnel {
  float reflectance;   // F
  float cos_t;         // cosine of the refracted direction; 0 under total internal reflection
  float transmittance; // 1 - F, with all digits where F is nearly 1
};

// cos_i: cosine on the incident side, taken as at least 0. eta: index beyond the boundary over index before it; infinite =
// mirror. Double carries the whole range of float indices: e^2 neither overflows nor vanishes, and the small differences near
// eta = 1 keep at least 8 digits. So one form serves everywhere, and F is exact to the rounding of the result.
inline Fresnel fresnel(float cos_i, float eta) {
  const double c = std::clamp(static_cast<double>(cos_i), 0.0, 1.0);
  if (eta == 1.0f)
    return {0.0f, static_cast<float>(c), 1.0f};
  if (std::isinf(eta))
    return {1.0f, 1.0f, 0.0f};
  // Snell's law; total internal reflection where no cosine is left.
  const double n = eta, e = 1.0 / n;
  const double cos2_t = (n - 1.0) * e * ((n + 1.0) * e) + (e * c) * (e * c);
  if (!(cos2_t > 0.0))
    return {1.0f, 0.0f, 0.0f};
  const double g = std::sqrt(cos2_t);
  if (c == 0.0)
    return {1.0f, static_cast<float>(g), 0.0f};
  // Amplitudes of both polarisations.
  const double rs = (e * c - g) / (e * c + g);
  const double rp = (c - e * g) / (c + e * g);
  const double f = 0.5 * (rs * rs + rp * rp);
  return {static_cast<float>(f), static_cast<float>(g), static_cast<float>(1.0 - f)};
}

inline float fresnel_dielectric(float cos_i, float eta) { return fresnel(cos_i, eta).reflectance; }

// Unpolarised reflectance of a metal of index n + i k, seen from the vacuum.
inline float fresnel_conductor(float cos_i, float n, float k) {
  const float c = std::clamp(cos_i, 0.0f, 1.0f), c2 = c * c, sin2 = (1.0f - c) * (1.0f + c);
  // The square root u + i v of (n + i k)^2 - sin^2.
  const float re = (n - k) * (n + k) - sin2, im = 2.0f * n * k;
  const float length = hypot(re, im);
  const float u2 = std::max(0.5f * (length + re), 0.0f), v2 = std::max(0.5f * (length - re), 0.0f);
  const float u = std::sqrt(u2);
  // Polarised across the plane of incidence, then along it: rp = rs times a further ratio.
  const float across = (c - u) * (c - u) + v2, across_sum = (c + u) * (c + u) + v2;
  const float rs = across_sum > 0.0f ? across / across_sum : 1.0f;
  const float mean = (u2 + v2) * c2 + sin2 * sin2, mixed = 2.0f * c * u * sin2;
  const float rp = mean + mixed > 0.0f ? rs * (mean - mixed) / (mean + mixed) : rs;
  return 0.5f * (rs + rp);
}

// The refracted direction for wo with wo.z > 0; cos_t from fresnel(wo.z, eta). It leaves on the other side, z < 0.
inline glm::vec3 refract_local(const glm::vec3 &wo, float eta, float cos_t) {
  return glm::normalize(glm::vec3(-wo.x / eta, -wo.y / eta, -cos_t));
}

} // namespace lancer
