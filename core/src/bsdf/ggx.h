// The GGX distribution of microfacets, stretched along the frame's axes: density, masking, sampling of what is seen from wo.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "sampling/warp.h"

namespace lancer {

// D: density of microfacet normals per solid angle. A sum of squares: no digit is lost for small roughness.
inline float ggx_d(const glm::vec3 &h, float alpha_x, float alpha_y) {
  const float x = h.x / alpha_x, y = h.y / alpha_y, length2 = x * x + y * y + h.z * h.z;
  return kInvPi / (alpha_x * alpha_y * length2 * length2);
}

// The length of a direction's part along the surface after squeezing facets of that roughness to roughness 1.
inline float squeezed(const glm::vec3 &w, float alpha_x, float alpha_y) {
  const float x = alpha_x * w.x, y = alpha_y * w.y;
  return std::sqrt(x * x + y * y);
}

// Facets hidden from w, as area: Smith's Lambda times |cos|, which no grazing direction sends to infinity.
inline float ggx_hidden(const glm::vec3 &w, float alpha_x, float alpha_y) {
  const float along = squeezed(w, alpha_x, alpha_y), z = std::abs(w.z);
  const float all = z + std::sqrt(z * z + along * along);
  return all > 0.0f ? 0.5f * along * (along / all) : 0.0f;
}

// A normal h visible from wo (wo.z > 0), density G1(wo) max(0, wo.h) D(h) / wo.z. Dupuy and Benyoub 2023: mirrored at facets of
// roughness 1, a view falls evenly on a cap of the sphere.
inline glm::vec3 ggx_sample_visible(const glm::vec3 &wo, float alpha_x, float alpha_y, glm::vec2 u) {
  const glm::vec3 w = glm::normalize(glm::vec3(alpha_x * wo.x, alpha_y * wo.y, wo.z));
  // 1 - cos of the angle on the cap, so that its apex keeps its digits.
  const float s = u.x * (1.0f + w.z);
  const float sin_theta = std::sqrt(std::max(0.0f, s * (2.0f - s)));
  const SinCos phi = sin_cos_turn(u.y);
  const glm::vec3 h(sin_theta * phi.cos + w.x, sin_theta * phi.sin + w.y, (1.0f - u.x) * (1.0f + w.z));
  return glm::normalize(glm::vec3(alpha_x * h.x, alpha_y * h.y, h.z));
}

} // namespace lancer
