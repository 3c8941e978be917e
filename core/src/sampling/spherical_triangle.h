// Samples a triangle uniformly in solid angle. D is double or lanes of it.
#pragma once

#include "sampling/angle.h"
#include "simd/vectors.h"

#include <numbers>

namespace lancer {

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

} // namespace lancer
