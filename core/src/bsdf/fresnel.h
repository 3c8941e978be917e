// Unpolarised Fresnel reflectance of a smooth dielectric boundary, and the direction that goes through it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace lancer {

struct Fresnel {
  float reflectance; // F; 1 - F goes through
  float cos_t;       // cosine of the refracted direction; 0 under total internal reflection
};

// cos_i: cosine on the incident side, taken as at least 0. eta: index beyond the boundary over index before it; infinite =
// mirror. Double carries the whole range of float indices: e^2 neither overflows nor vanishes, and the small differences near
// eta = 1 keep at least 8 digits. So one form serves everywhere, and F is exact to the rounding of the result.
inline Fresnel fresnel(float cos_i, float eta) {
  const double c = std::clamp(static_cast<double>(cos_i), 0.0, 1.0);
  if (eta == 1.0f)
    return {0.0f, static_cast<float>(c)};
  if (std::isinf(eta))
    return {1.0f, 1.0f};
  // Snell's law; total internal reflection where no cosine is left.
  const double n = eta, e = 1.0 / n;
  const double cos2_t = (n - 1.0) * e * ((n + 1.0) * e) + (e * c) * (e * c);
  if (!(cos2_t > 0.0))
    return {1.0f, 0.0f};
  const double g = std::sqrt(cos2_t);
  if (c == 0.0)
    return {1.0f, static_cast<float>(g)};
  // Amplitudes of both polarisations.
  const double rs = (e * c - g) / (e * c + g);
  const double rp = (c - e * g) / (c + e * g);
  return {static_cast<float>(0.5 * (rs * rs + rp * rp)), static_cast<float>(g)};
}

inline float fresnel_dielectric(float cos_i, float eta) { return fresnel(cos_i, eta).reflectance; }

// The refracted direction for wo with wo.z > 0; cos_t from fresnel(wo.z, eta). It leaves on the other side, z < 0.
inline glm::vec3 refract_local(const glm::vec3 &wo, float eta, float cos_t) {
  return glm::normalize(glm::vec3(-wo.x / eta, -wo.y / eta, -cos_t));
}

} // namespace lancer
