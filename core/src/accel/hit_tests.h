// Tests of one ray against one primitive, for traversals that test primitives one by one. Each test keeps the closer hit.
#pragma once

#include "accel/placed_shape.h"
#include "accel/triangle.h"
#include "scene/geometry.h"
#include "scene/quadric_point.h"
#include "scene/ray.h"

namespace lancer {

// Returns whether a hit of a ray counts; without a filter every hit does.
struct Counting {
  HitFilter *filter = nullptr;
  size_t ray = 0; // number in its batch

  bool operator()(const Hit &hit) const { return !filter || !filter->instances[hit.instance] || filter->counts(ray, hit); }
};

inline void try_triangle(const Ray &ray, const RayAxes &axes, const ShearedRay<double> &sheared, const Mesh &mesh,
                         uint32_t instance, uint32_t triangle, const Counting &counting, Hit &best) {
  if (ray.skip_instance == instance && ray.skip_primitive == triangle)
    return;
  double corner[3][3];
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 p = mesh.vertex(triangle, i);
    corner[i][0] = p[static_cast<int>(axes.kx)];
    corner[i][1] = p[static_cast<int>(axes.ky)];
    corner[i][2] = p[static_cast<int>(axes.kz)];
  }
  TriangleHit<double> met;
  if (!intersect_triangle(corner, sheared, met) || !(ray.tmin < met.t && met.t < ray.tmax) ||
      !closer(met.t, instance, triangle, best))
    return;
  if (const Hit hit{met.t, met.wb / met.det, met.wc / met.det, instance, triangle}; counting(hit))
    best = hit;
}

inline void try_quadric(const Ray &ray, const PlacedShape &shape, uint32_t instance, const Counting &counting, Hit &best) {
  try_places(
      instance, ray.tmin, best, [&](double &t) { return next_place(shape, instance, ray, t); },
      [&](const Hit &hit) {
        if (!counting(hit))
          return false;
        best = hit;
        return true;
      });
}

} // namespace lancer
