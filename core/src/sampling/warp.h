// Warps from the unit square to disks, directions and triangles, each with its density. F is float or lanes of it.
#pragma once

#include <glm/glm.hpp>
#include <numbers>

#include "sampling/angle.h"
#include "simd/vectors.h"

namespace lancer {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;

// Returns a uniform point of the unit disk. Squares around the centre become circles, so neighbours remain neighbours.
template <class F> LANCER_LANE Vector2<F> warp_disk(F u, F v) {
  const F a = F(2.0f) * u - F(1.0f), b = F(2.0f) * v - F(1.0f), zero(0.0f);
  const MaskOf<F> wide = abs(a) > abs(b), middle = (a == zero) & (b == zero);
  const F radius = select(wide, a, b), phi = F(0.25f * kPi) * (select(wide, b, a) / radius);
  const F s = sin_octant(phi), c = cos_octant(phi);
  return {select(middle, zero, radius * select(wide, c, s)), select(middle, zero, radius * select(wide, s, c))};
}
LANCER_LANE glm::vec2 warp_disk(const glm::vec2 &u) { return warp_disk(u.x, u.y); }

// Directions around +z with a density proportional to the cosine.
template <class F> LANCER_LANE Vector3<F> warp_cosine_hemisphere(F u, F v) {
  const Vector2<F> p = warp_disk(u, v);
  // Compute the cosine from the disk's radius r before the rotation: (1 - r)(1 + r) keeps its digits at grazing angles.
  const F r = max(abs(F(2.0f) * u - F(1.0f)), abs(F(2.0f) * v - F(1.0f)));
  return {p.x, p.y, sqrt((F(1.0f) - r) * (F(1.0f) + r))};
}
LANCER_LANE glm::vec3 warp_cosine_hemisphere(const glm::vec2 &u) { return warp_cosine_hemisphere(u.x, u.y); }
template <class F> LANCER_LANE F warp_cosine_hemisphere_pdf(F cos_theta) { return max(F(0.0f), cos_theta) * F(kInvPi); }

// Uniform over all directions.
template <class F> LANCER_LANE Vector3<F> warp_sphere(F u, F v) {
  const F sin_theta = F(2.0f) * sqrt(u * (F(1.0f) - u));
  const SinCos phi = sin_cos_turn(v);
  return {sin_theta * phi.cos, sin_theta * phi.sin, F(1.0f) - F(2.0f) * u};
}
LANCER_LANE glm::vec3 warp_sphere(const glm::vec2 &u) { return warp_sphere(u.x, u.y); }
LANCER_LANE float warp_sphere_pdf() { return 0.25f * kInvPi; }

// Returns 1 - cos(theta) from sin(theta)^2 without cancellation: a cone of any width keeps its size.
template <class F> LANCER_LANE F one_minus_cos(F sin2) { return sin2 / (F(1.0f) + sqrt(max(F(0.0f), F(1.0f) - sin2))); }

// Uniform over the cone of directions around +z with cos(theta) >= 1 - one_minus_cos_max.
template <class F> LANCER_LANE Vector3<F> warp_cone(F u, F v, F one_minus_cos_max) {
  const F x = u * one_minus_cos_max;
  const F sin_theta = sqrt(x * (F(2.0f) - x));
  const SinCos phi = sin_cos_turn(v);
  return {sin_theta * phi.cos, sin_theta * phi.sin, F(1.0f) - x};
}
LANCER_LANE glm::vec3 warp_cone(const glm::vec2 &u, float one_minus_cos_max) { return warp_cone(u.x, u.y, one_minus_cos_max); }
template <class F> LANCER_LANE F warp_cone_pdf(F one_minus_cos_max) { return F(0.5f * kInvPi) / one_minus_cos_max; }

// Uniform on a triangle: barycentric weights of corners 1 and 2. The square is folded over its diagonal, which preserves
// stratification.
template <class F> LANCER_LANE Vector2<F> warp_triangle(F u, F v) {
  const MaskOf<F> above = v > u;
  const F half = F(0.5f) * select(above, u, v);
  return {select(above, half, u - half), select(above, v - half, half)};
}
LANCER_LANE glm::vec2 warp_triangle(const glm::vec2 &u) { return warp_triangle(u.x, u.y); }

} // namespace lancer
