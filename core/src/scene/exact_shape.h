// Points of exact surfaces in their unit frames (lancer.h says which): where they lie, and how they are numbered.
#pragma once

#include "scene/geometry.h"
#include "scene/quadric_point.h"

namespace lancer {

inline QuadricKinds<float> kinds_of(ShapeKind kind) {
  return {kind == ShapeKind::Plane, kind == ShapeKind::Cylinder, kind == ShapeKind::Cone};
}

struct SurfacePoint {
  glm::dvec3 p; // on the surface, object space
  glm::dvec3 n; // outward geometric normal, unit, object space
};

// The point o + t d of an object-space ray, moved to the nearest place exactly on the surface.
SurfacePoint quadric_point(ShapeKind kind, const glm::dvec3 &o, const glm::dvec3 &d, double t);

// The parametrisation at an object-space surface point. Sphere: longitude, latitude; cylinder and cone: angle, height; all in
// [0, 1]. Plane: x, y.
glm::dvec2 quadric_uv(ShapeKind kind, const glm::dvec3 &p);

} // namespace lancer
