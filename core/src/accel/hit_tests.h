// One ray against one primitive, kept where it is closer: for the traversals that take primitives one by one.
#pragma once

#include "accel/quadric.h"
#include "accel/triangle.h"

namespace lancer {

inline void try_triangle(const Ray &ray, const ObjectRay &object_ray, const Shear &shear, const Mesh &mesh, uint32_t instance,
                         uint32_t triangle, Hit &best) {
  if (ray.skip_instance == instance && ray.skip_primitive == triangle)
    return;
  const glm::vec3 a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1), c = mesh.vertex(triangle, 2);
  double t, u, v;
  if (intersect_triangle(object_ray, shear, &a.x, &b.x, &c.x, t, u, v) && ray.tmin < t && t < ray.tmax &&
      closer(t, instance, triangle, best))
    best = {t, u, v, instance, triangle};
}

inline void try_quadric(const Ray &ray, const PlacedShape &shape, uint32_t instance, Hit &best) {
  double t;
  if (intersect_quadric(shape, ray, ray.skip_instance == instance, t) && closer(t, instance, 0, best))
    best = {t, 0.0, 0.0, instance, 0};
}

} // namespace lancer
