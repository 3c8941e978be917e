// From the unit square to disks, directions and triangles; each warp stands beside its density.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "sampling/octant.h"

namespace lancer {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;

// Uniform on the unit disk; squares around the middle become circles, so that neighbours stay neighbours.
inline glm::vec2 warp_disk(glm::vec2 u) {
  const float a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
  if (a == 0.0f && b == 0.0f)
    return {0.0f, 0.0f};
  if (std::abs(a) > std::abs(b)) {
    const float phi = 0.25f * kPi * (b / a);
    return {a * cos_octant(phi), a * sin_octant(phi)};
  }
  const float phi = 0.25f * kPi * (a / b);
  return {b * sin_octant(phi), b * cos_octant(phi)};
}

// Directions around +z with a density proportional to the cosine.
inline glm::vec3 warp_cosine_hemisphere(glm::vec2 u) {
  const glm::vec2 p = warp_disk(u);
  // The disk's radius is known before it is rotated: (1 - r)(1 + r) keeps its digits at grazing angles.
  const float r = std::max(std::abs(2.0f * u.x - 1.0f), std::abs(2.0f * u.y - 1.0f));
  return {p.x, p.y, std::sqrt((1.0f - r) * (1.0f + r))};
}
inline float warp_cosine_hemisphere_pdf(float cos_theta) { return std::max(0.0f, cos_theta) * kInvPi; }

// Uniform over all directions.
inline glm::vec3 warp_sphere(glm::vec2 u) {
  const float sin_theta = 2.0f * std::sqrt(u.x * (1.0f - u.x));
  const SinCos phi = sin_cos_turn(u.y);
  return {sin_theta * phi.cos, sin_theta * phi.sin, 1.0f - 2.0f * u.x};
}
inline float warp_sphere_pdf() { return 0.25f * kInvPi; }

// 1 - cos(theta) from sin(theta)^2, without the cancellation: a cone keeps its size however narrow it is.
inline float one_minus_cos(float sin2) { return sin2 / (1.0f + std::sqrt(std::max(0.0f, 1.0f - sin2))); }

// Uniform over the cone of directions around +z with cos(theta) >= 1 - one_minus_cos_max.
inline glm::vec3 warp_cone(glm::vec2 u, float one_minus_cos_max) {
  const float x = u.x * one_minus_cos_max;
  const float sin_theta = std::sqrt(x * (2.0f - x));
  const SinCos phi = sin_cos_turn(u.y);
  return {sin_theta * phi.cos, sin_theta * phi.sin, 1.0f - x};
}
inline float warp_cone_pdf(float one_minus_cos_max) { return 0.5f * kInvPi / one_minus_cos_max; }

// Uniform on a triangle: barycentric weights of corners 1 and 2. The square is folded over its diagonal, not squeezed into a
// corner.
inline glm::vec2 warp_triangle(glm::vec2 u) {
  if (u.y > u.x) {
    const float half = 0.5f * u.x;
    return {half, u.y - half};
  }
  const float half = 0.5f * u.y;
  return {u.x - half, half};
}

} // namespace lancer
