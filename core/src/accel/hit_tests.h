// One ray against one primitive, kept where it is closer: for the traversals that take primitives one by one.
#pragma once

#include "accel/quadric.h"
#include "accel/triangle.h"

namespace lancer {

// Whether a hit of a ray counts; without a filter all do.
struct Counting {
  const HitFilter *filter = nullptr;
  size_t ray = 0; // number in its batch

  bool operator()(const Hit &hit) const {
    return !filter || !filter->instances[hit.instance] || filter->counts(filter->context, ray, hit);
  }
};

inline void try_triangle(const Ray &ray, const ObjectRay &object_ray, const Shear &shear, const Mesh &mesh, uint32_t instance,
                         uint32_t triangle, const Counting &counting, Hit &best) {
  if (ray.skip_instance == instance && ray.skip_primitive == triangle)
    return;
  const glm::vec3 a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1), c = mesh.vertex(triangle, 2);
  double t, u, v;
  if (!intersect_triangle(object_ray, shear, &a.x, &b.x, &c.x, t, u, v) || !(ray.tmin < t && t < ray.tmax) ||
      !closer(t, instance, triangle, best))
    return;
  if (const Hit hit{t, u, v, instance, triangle}; counting(hit))
    best = hit;
}

inline void try_quadric(const Ray &ray, const PlacedShape &shape, uint32_t instance, const Counting &counting, Hit &best) {
  // Look beyond each place that does not count.
  Ray rest = ray;
  double t;
  while (intersect_quadric(shape, rest, ray.skip_instance == instance, t) && closer(t, instance, 0, best)) {
    if (const Hit hit{t, 0.0, 0.0, instance, 0}; counting(hit)) {
      best = hit;
      return;
    }
    rest.tmin = t;
  }
}

} // namespace lancer
