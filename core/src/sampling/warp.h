// Warps from the unit square, each with its density: to disks, directions and triangles, and to the solid angle of a triangle,
// a parallelogram or a rectangle. F is a float, D a double, or lanes of them.
#pragma once

#include "sampling/elementary.h"
#include "simd/vectors.h"

#include <glm/glm.hpp>
#include <numbers>

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

template <class D> struct SphericalTriangle {
  using V = Vector3<D>;
  V a, b, c; // unit, towards the corners
  D solid_angle;

  // Takes vectors from the point to the corners. The solid angle is 0 if the triangle is seen edge on.
  LANCER_LANE SphericalTriangle(const V &to_a, const V &to_b, const V &to_c)
      : a(to_a / sqrt(dot(to_a, to_a))), b(to_b / sqrt(dot(to_b, to_b))), c(to_c / sqrt(dot(to_c, to_c))) {
    // Van Oosterom, Strackee, "The solid angle of a plane triangle", 1983.
    const D triple = abs(dot(a, cross(b, c)));
    const D angles = D(2.0) * angle(triple, D(1.0) + dot(a, b) + dot(b, c) + dot(c, a));
    solid_angle = select(angles > D(0.0), angles, D(0.0));
  }

  // Arvo, "Stratified sampling of spherical triangles", 1995. Returns a unit direction of density 1 / solid_angle, which must
  // be above 0.
  LANCER_LANE V sample(const D &u, const D &v) const {
    const D zero(0.0), one(1.0);
    // Move c along its arc with a, so that the triangle of a, b and the moved c has the share u of the area.
    const V c_along = across(c, a);
    const D cos_alpha = min(max(dot(across(b, a), c_along), -one), one);
    const D sin_alpha = sqrt((one - cos_alpha) * (one + cos_alpha));
    const SinCos<D> cut = sin_cos_turn(D(u * solid_angle * D(0.5 * std::numbers::inv_pi)));
    const D sin_phi = cut.sin * cos_alpha - cut.cos * sin_alpha, cos_phi = cut.cos * cos_alpha + cut.sin * sin_alpha;
    const D k1 = cos_phi - cos_alpha, k2 = sin_phi + sin_alpha * dot(a, b);
    const D below = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
    const D ratio = ((k2 * cos_phi - k1 * sin_phi) * cos_alpha - k2) / below;
    const D cos_b = select(below != zero, min(max(ratio, -one), one), one);
    const V moved = cos_b * a + sqrt((one - cos_b) * (one + cos_b)) * c_along;
    // Move from b along the arc: area about b is linear in 1 - cos.
    const D down = v * (one - min(dot(moved, b), one)), cos_theta = one - down;
    return cos_theta * b + sqrt(max(zero, down * (one + cos_theta))) * across(moved, b);
  }

private:
  // Returns the unit component of v perpendicular to unit n; 0 if they are parallel.
  static LANCER_LANE V across(const V &v, const V &n) {
    const V w = v - dot(v, n) * n;
    const D length = sqrt(dot(w, w));
    return select(length > D(0.0), w / length, V(D(0.0)));
  }
};

// The two triangles beside a diagonal, each sampled as often as its solid angle demands.
template <class D> struct SphericalParallelogram {
  using V = Vector3<D>;
  SphericalTriangle<D> first, second;
  D solid_angle;

  // corner: as seen from the point; along, across: the sides that leave it.
  LANCER_LANE SphericalParallelogram(const V &corner, const V &along, const V &across)
      : first(corner, corner + along, corner + across), second(corner + along + across, corner + across, corner + along),
        solid_angle(first.solid_angle + second.solid_angle) {}

  // Returns a unit direction of density 1 / solid_angle, which must be above 0.
  LANCER_LANE V sample(const D &u, const D &v) const {
    const D one(1.0), share = first.solid_angle / solid_angle;
    const auto in_first = u < share;
    const D rest = select(in_first, u / share, (u - share) / (one - share));
    SphericalTriangle<D> chosen = second;
    chosen.a = select(in_first, first.a, second.a);
    chosen.b = select(in_first, first.b, second.b);
    chosen.c = select(in_first, first.c, second.c);
    chosen.solid_angle = select(in_first, first.solid_angle, second.solid_angle);
    return chosen.sample(min(max(rest, D(0.0)), one), v);
  }
};

// The rectangle low <= (x, y) <= high of the plane at z > 0, seen from the origin.
template <class D> struct SphericalRectangle {
  Vector2<D> low, high;
  D z, solid_angle;

  LANCER_LANE SphericalRectangle(const Vector2<D> &low_, const Vector2<D> &high_, const D &z_) : low(low_), high(high_), z(z_) {
    // The solid angle is that up to high.x minus that up to low.x.
    left_ = between(low.x);
    solid_angle = between(high.x) - left_;
  }

  // Returns the point of the plane hit by a direction of density 1 / solid_angle (Urena, Fajardo, King, "An area-preserving
  // parametrization for spherical rectangles", 2013). solid_angle must exceed its rounding error.
  LANCER_LANE Vector2<D> sample(const D &u, const D &v) const {
    const D zero(0.0);
    // Cut the rectangle at the x below which lies the share u of the solid angle.
    const SinCos<D> cut = sin_cos_turn(wrapped((u * solid_angle + left_) * D(0.5 * std::numbers::inv_pi)));
    // n.z of the planes through the lower and upper sides; the angles there are those of the cut.
    const D over_low = sqrt(z * z + low.y * low.y), over_high = sqrt(z * z + high.y * high.y);
    const D b0 = -low.y / over_low, b1 = high.y / over_high;
    const D along = cut.cos * b0 + b1, tilt = z / over_low;
    const D apart2 = (along - tilt * cut.sin) * (along + tilt * cut.sin);
    const D signed_sin = select(along < zero, -cut.sin, cut.sin);
    const D limit = select(signed_sin < zero, low.x, high.x);
    const D found = select(apart2 > zero, z * signed_sin / sqrt(max(apart2, D(0x1p-1000))), limit);
    const D x = min(max(found, low.x), high.x);
    // Along the cut, the solid angle is linear in the sine of the elevation above the plane's horizon.
    const D d2 = x * x + z * z;
    const D h0 = low.y / sqrt(d2 + low.y * low.y), h1 = high.y / sqrt(d2 + high.y * high.y);
    const D h = h0 + v * (h1 - h0), cos2 = (D(1.0) - h) * (D(1.0) + h);
    const D y = select(cos2 > zero, h * sqrt(d2 / max(cos2, D(0x1p-1000))), high.y);
    return {x, min(max(y, low.y), high.y)};
  }

private:
  D left_; // solid angle up to low.x, which is also the angle of the cut there

  // Returns the solid angle of the part from the foot of the origin up to x, with the sign of x. The rectangle from the foot to
  // (x, y) has the angle of a complex number (z sqrt(x^2 + y^2 + z^2), x y); the part has the angle of a quotient of two.
  LANCER_LANE D between(const D &x) const {
    const D low_sin = x * low.y, low_cos = z * sqrt(x * x + low.y * low.y + z * z);
    const D high_sin = x * high.y, high_cos = z * sqrt(x * x + high.y * high.y + z * z);
    return angle(high_sin * low_cos - high_cos * low_sin, high_cos * low_cos + high_sin * low_sin);
  }
  // Maps turns from -1 ... 1 to 0 ... 1.
  static LANCER_LANE D wrapped(const D &turns) { return select(turns < D(0.0), turns + D(1.0), turns); }
};

} // namespace lancer
