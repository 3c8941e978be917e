// Watertight ray-triangle test (Woop, Benthin, Wald 2013) in double.
// The kernels of bvh_kernel.cpp do these operations in this order, four triangles at a time: the same bits.
#pragma once

#include "accel/edge_sides.h"

namespace lancer {

// The shear that turns the ray into the axis z = 1 through the origin.
struct Shear {
  int kx, ky, kz;
  double sx, sy, sz;
};

LANCER_INLINE Shear make_shear(const ObjectRay &ray) {
  const double ax = magnitude(ray.d[0]), ay = magnitude(ray.d[1]), az = magnitude(ray.d[2]);
  Shear s;
  s.kz = az >= ax && az >= ay ? 2 : (ay >= ax ? 1 : 0);
  s.kx = s.kz == 2 ? 0 : s.kz + 1;
  s.ky = s.kx == 2 ? 0 : s.kx + 1;
  s.sx = ray.d[s.kx] / ray.d[s.kz];
  s.sy = ray.d[s.ky] / ray.d[s.kz];
  s.sz = 1.0 / ray.d[s.kz];
  return s;
}

// t, u, v of the point where the ray meets the triangle; false where it does not. t is the same bits for any order of the
// corners. Edge functions change sign exactly when their corners are swapped, so of triangles that share an edge one is met.
LANCER_INLINE bool intersect_triangle(const ObjectRay &ray, const Shear &s, const float a[3], const float b[3],
                                      const float c[3], double &t, double &u, double &v) {
  // Shear the corners into the ray's frame.
  const double az = a[s.kz] - ray.o[s.kz], bz = b[s.kz] - ray.o[s.kz], cz = c[s.kz] - ray.o[s.kz];
  const double ax = (a[s.kx] - ray.o[s.kx]) - s.sx * az, ay = (a[s.ky] - ray.o[s.ky]) - s.sy * az;
  const double bx = (b[s.kx] - ray.o[s.kx]) - s.sx * bz, by = (b[s.ky] - ray.o[s.ky]) - s.sy * bz;
  const double cx = (c[s.kx] - ray.o[s.kx]) - s.sx * cz, cy = (c[s.ky] - ray.o[s.ky]) - s.sy * cz;

  // Keep the triangle if the origin lies on one side of all three edges.
  double w[3] = {cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax};
  if (!((w[0] >= 0.0 && w[1] >= 0.0 && w[2] >= 0.0) || (w[0] <= 0.0 && w[1] <= 0.0 && w[2] <= 0.0)))
    return false;
  if (w[0] * w[1] * w[2] == 0.0) {
    const double x[3] = {ax, bx, cx}, y[3] = {ay, by, cy};
    if (!within_edges(x, y, w))
      return false;
  }

  // Interpolate the depth and return to the world's parameter.
  const double det = sum_in_any_order(w[0], w[1], w[2]);
  const double depth = sum_in_any_order(w[0] * (s.sz * az), w[1] * (s.sz * bz), w[2] * (s.sz * cz));
  t = world_t(ray, depth / det);
  u = w[1] / det;
  v = w[2] / det;
  return true;
}

} // namespace lancer
