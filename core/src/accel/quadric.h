// Exact surfaces in their unit frames: sphere, plane, cylinder, cone (lancer.h says which).
#pragma once

#include "accel/placed_shape.h"
#include "accel/ray.h"
#include "scene/geometry.h"
#include "scene/quadric_point.h"

namespace lancer {

// The first t with tmin < t < tmax where the ray meets the surface; false where there is none.
// leaves: the ray starts on this surface, so the root that is its own start is left out.
bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t);

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
