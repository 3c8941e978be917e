#include "scene/exact_shape.h"

#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lancer {

SurfacePoint quadric_point(ShapeKind kind, const glm::dvec3 &o, const glm::dvec3 &d, double t) {
  const QuadricPoint<float> point = quadric_point(kinds_of(kind), Vector3<double>(o + t * d));
  return {point.p, point.n};
}

glm::dvec2 quadric_uv(ShapeKind kind, const glm::dvec3 &p) {
  if (kind == ShapeKind::Plane)
    return {p.x, p.y};
  const double turn = atan2(p.y, p.x) * (0.5 * std::numbers::inv_pi);
  const double angle = turn < 0.0 ? std::min(turn + 1.0, std::nextafter(1.0, 0.0)) : turn;
  if (kind == ShapeKind::Sphere)
    return {angle, 0.5 + atan2(p.z, hypot(p.x, p.y)) * std::numbers::inv_pi};
  return {angle, 0.5 * (p.z + 1.0)};
}

} // namespace lancer
