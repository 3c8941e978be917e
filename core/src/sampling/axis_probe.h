// Probes of the surface around a place: rays along the normal or a tangent, through a disk across the ray.
//   "BSSRDF Importance Sampling", King, Kulla, Conty, Fajardo 2013.
#pragma once

#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace lancer {

class AxisProbe {
public:
  // n, t, b: normal and tangents of the place, unit, at right angles. u: chooses the axis, and its remainder the turn of the
  // point on the disk.
  AxisProbe(const glm::dvec3 &n, const glm::dvec3 &t, const glm::dvec3 &b, float u)
      : axes_{n, t, b}, axis_(u < 0.5f    ? 0
                              : u < 0.75f ? 1
                                          : 2),
        turn_(axis_ == 0 ? 2.0f * u : 4.0f * (u - (axis_ == 1 ? 0.5f : 0.75f))) {}

  // Sets a ray through the point of the disk at distance r from p, between the ends of the ball of this radius around p.
  void place(const glm::dvec3 &p, double r, double radius, glm::dvec3 &o, glm::dvec3 &d, double &length) const {
    const double height = std::sqrt(std::max((radius - r) * (radius + r), 0.0));
    const SinCos<float> at = sin_cos_turn(turn_);
    const glm::dvec3 &across = axes_[(axis_ + 1) % 3], &along = axes_[(axis_ + 2) % 3];
    o = p + height * axes_[axis_] + r * (double(at.cos) * across + double(at.sin) * along);
    d = -axes_[axis_];
    length = 2.0 * height;
  }
  // Returns the weight of a surface that the ray meets, by the power heuristic over the rays along all axes. The mean of this
  // weight times f(distance of the surface) / f(r) is the integral of f over the surface, if r follows f over the disk.
  double weight(const glm::dvec3 &ng) const {
    double squares = 0.0;
    for (int k = 0; k < 3; ++k)
      squares += density(k, ng) * density(k, ng);
    return squares > 0.0 ? density(axis_, ng) / squares : 0.0;
  }

private:
  // Probabilities of the normal and of the two tangents.
  static constexpr double kShare[3] = {0.5, 0.25, 0.25};

  double density(int k, const glm::dvec3 &ng) const { return kShare[k] * std::abs(glm::dot(axes_[k], ng)); }

  glm::dvec3 axes_[3];
  int axis_;
  float turn_;
};

} // namespace lancer
