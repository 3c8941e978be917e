// The sphere test of the wide BVH, four at a time: the operations of quadric.cpp in the same order, hence the same bits.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/bvh.h"
#include "accel/bvh/simd.h"
#include "accel/object_ray.h"

namespace lancer {
namespace {

// What is known of four spheres and a ray: the terms of a t^2 - 2 b t + c = 0, in units of the scaled direction.
struct SphereTerms {
  alignas(32) double a[4], b[4], c[4], root[4], unit[4];
};

// PreciseSum of quadric.cpp.
struct PreciseSum4 {
  D4 value, rest;

  LANCER_SIMD void add(D4 x) {
    const D4 s = value + x, shadow = s - value;
    rest = rest + ((value - (s - shadow)) + (x - shadow));
    value = s;
  }
  LANCER_SIMD void add_square(D4 x) {
    const D4 scaled = splat4(134217729.0) * x;
    const D4 high = scaled - (scaled - x), low = x - high;
    const D4 square = x * x;
    add(square);
    rest = rest + (((high * high - square) + splat4(2.0) * high * low) + low * low);
  }
};

// Bit i: the ray's line meets sphere i.
LANCER_SIMD uint32_t intersect_spheres(const SphereBlock &block, const Ray &ray, SphereTerms &terms) {
  // Carry the ray into the four unit spaces.
  D4 o[3], d[3];
  for (int i = 0; i < 3; ++i) {
    const D4 x = load4(block.to_object[0][i]), y = load4(block.to_object[1][i]), z = load4(block.to_object[2][i]);
    o[i] = x * splat4(ray.o.x) + y * splat4(ray.o.y) + z * splat4(ray.o.z) + load4(block.to_object[3][i]);
    d[i] = x * splat4(ray.d.x) + y * splat4(ray.d.y) + z * splat4(ray.d.z);
  }
  const D4 ax = magnitude4(d[0]), ay = magnitude4(d[1]), az = magnitude4(d[2]);
  const D4 largest = max4(max4(ax, ay), az);
  const uint32_t usable = less_equal(splat4(0x1p-1000), largest) & less_equal(ax + ay + az, splat4(0x1p1000));
  D4 power, unit;
  power_of_two4(largest, power, unit);
  for (D4 &component : d)
    component = component * unit;

  // Find the squared distance of the line from the centre, by the cross product.
  const D4 mx = o[1] * d[2] - d[1] * o[2], my = o[2] * d[0] - d[2] * o[0], mz = o[0] * d[1] - d[0] * o[1];
  const D4 a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const D4 discriminant = a - (mx * mx + my * my + mz * mz);
  const uint32_t met = usable & less_equal(splat4(0.0), discriminant);
  if (met == 0)
    return 0;

  // Find how far the origin is from the surface.
  PreciseSum4 c{splat4(0.0), splat4(0.0)};
  c.add(splat4(-1.0));
  for (const D4 &component : o)
    c.add_square(component);
  store4(terms.a, a);
  store4(terms.b, o[0] * d[0] + o[1] * d[1] + o[2] * d[2]);
  store4(terms.c, c.value + c.rest);
  store4(terms.root, root4(discriminant));
  store4(terms.unit, unit);
  return met;
}

// intersect_quadric() for sphere i of those met.
LANCER_SIMD bool choose_root(const SphereTerms &terms, int i, double slack, bool leaves, double tmin, double tmax, double &t) {
  const double a = terms.a[i], b = -terms.b[i], c = terms.c[i], unit = terms.unit[i];
  const double q = b + __builtin_copysign(terms.root[i], b);
  if (q == 0.0)
    return false;
  const double first = c / q, second = q / a;
  const bool starts_here = leaves && magnitude(c) <= 4.0 * slack, in_order = first < second;
  const double entry = in_order ? first : second, exit = in_order ? second : first;
  if (!(entry <= exit))
    return false;
  t = entry * unit;
  if (!(starts_here && in_order) && tmin < t && t < tmax)
    return true;
  t = exit * unit;
  return !(starts_here && !in_order) && tmin < t && t < tmax;
}

} // namespace
} // namespace lancer
