// Directions to a triangle, even over the solid angle that it fills.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "sampling/elementary.h"

namespace lancer {

struct SphericalTriangle {
  glm::dvec3 a, b, c; // unit, towards the corners
  double solid_angle = 0.0;

  // Towards corners that are given as seen from the point. 0 where it is seen edge on.
  SphericalTriangle(const glm::dvec3 &to_a, const glm::dvec3 &to_b, const glm::dvec3 &to_c)
      : a(to_a / glm::length(to_a)), b(to_b / glm::length(to_b)), c(to_c / glm::length(to_c)) {
    // Van Oosterom, Strackee, "The solid angle of a plane triangle", 1983.
    const double triple = std::abs(glm::dot(a, glm::cross(b, c)));
    solid_angle = 2.0 * atan2(triple, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
    if (!(solid_angle > 0.0))
      solid_angle = 0.0;
  }

  // Arvo, "Stratified sampling of spherical triangles", 1995. Unit; density 1 / solid_angle, which is above 0.
  glm::dvec3 sample(const glm::dvec2 &u) const {
    // Cut off a triangle that keeps a and b and has the share u.x of the area: c moves along its arc with a.
    const glm::dvec3 c_along = across(c, a);
    const double cos_alpha = std::clamp(glm::dot(across(b, a), c_along), -1.0, 1.0);
    const double sin_alpha = std::sqrt((1.0 - cos_alpha) * (1.0 + cos_alpha));
    const double cut = u.x * solid_angle, sin_cut = sin(cut), cos_cut = cos(cut);
    const double sin_phi = sin_cut * cos_alpha - cos_cut * sin_alpha, cos_phi = cos_cut * cos_alpha + sin_cut * sin_alpha;
    const double k1 = cos_phi - cos_alpha, k2 = sin_phi + sin_alpha * glm::dot(a, b);
    const double below = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
    const double cos_b = below != 0.0 ? std::clamp(((k2 * cos_phi - k1 * sin_phi) * cos_alpha - k2) / below, -1.0, 1.0) : 1.0;
    const glm::dvec3 moved = cos_b * a + std::sqrt((1.0 - cos_b) * (1.0 + cos_b)) * c_along;
    // Go from b along the arc to it: areas about b are even in 1 - cos.
    const double down = u.y * (1.0 - std::min(glm::dot(moved, b), 1.0)), cos_theta = 1.0 - down;
    return cos_theta * b + std::sqrt(std::max(0.0, down * (1.0 + cos_theta))) * across(moved, b);
  }

private:
  // The unit direction of v across unit n; any where they are parallel.
  static glm::dvec3 across(const glm::dvec3 &v, const glm::dvec3 &n) {
    const glm::dvec3 w = v - glm::dot(v, n) * n;
    const double length = glm::length(w);
    return length > 0.0 ? w / length : glm::dvec3(0.0);
  }
};

} // namespace lancer
