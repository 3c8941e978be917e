// Directions to a parallelogram, uniform over the solid angle that it subtends. D is a double, or lanes of them.
#pragma once

#include "sampling/spherical_triangle.h"

namespace lancer {

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

} // namespace lancer
