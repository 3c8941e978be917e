// Watertight ray-triangle test (Woop, Benthin, Wald 2013) in double.
// The kernels of bvh_kernel.cpp do these operations in this order, four triangles at a time: the same bits.
#pragma once

#include "accel/object_ray.h"

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

// t, u, v of the point where the ray meets the triangle's interior, edges or corners; false where it does not.
// Edge functions change sign exactly when their corners are swapped, so triangles that share an edge cannot both miss.
LANCER_INLINE bool intersect_triangle(const ObjectRay &ray, const Shear &s, const float a[3], const float b[3],
                                      const float c[3], double &t, double &u, double &v) {
  // Shear the corners into the ray's frame.
  const double az = a[s.kz] - ray.o[s.kz], bz = b[s.kz] - ray.o[s.kz], cz = c[s.kz] - ray.o[s.kz];
  const double ax = (a[s.kx] - ray.o[s.kx]) - s.sx * az, ay = (a[s.ky] - ray.o[s.ky]) - s.sy * az;
  const double bx = (b[s.kx] - ray.o[s.kx]) - s.sx * bz, by = (b[s.ky] - ray.o[s.ky]) - s.sy * bz;
  const double cx = (c[s.kx] - ray.o[s.kx]) - s.sx * cz, cy = (c[s.ky] - ray.o[s.ky]) - s.sy * cz;

  // Keep the triangle if the origin lies on one side of all three edges.
  const double wa = cx * by - cy * bx;
  const double wb = ax * cy - ay * cx;
  const double wc = bx * ay - by * ax;
  if (!((wa >= 0.0 && wb >= 0.0 && wc >= 0.0) || (wa <= 0.0 && wb <= 0.0 && wc <= 0.0)))
    return false;
  const double det = wa + wb + wc;
  if (det == 0.0)
    return false;

  // Interpolate the depth and return to the world's parameter.
  const double depth = wa * (s.sz * az) + wb * (s.sz * bz) + wc * (s.sz * cz);
  t = world_t(ray, depth / det);
  u = wb / det;
  v = wc / det;
  return true;
}

} // namespace lancer
