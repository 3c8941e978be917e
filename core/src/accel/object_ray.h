// A ray carried into the space of a mesh and started afresh near its middle: the same numbers for every accelerator.
// Plain doubles and forced inlining: the SIMD kernels are compiled once per instruction set and may leave no shared symbol.
#pragma once

#include "accel/placed_shape.h"
#include "accel/ray.h"

#include <cstring>

namespace lancer {

#define LANCER_INLINE [[gnu::always_inline]] inline

// Points o + tau d; t = t0 + tau * unit is the parameter of the world ray.
// d is the object-space direction over a power of two, its largest component in [1, 2): no scale overflows or underflows.
// o is the closest approach to the frame's centre, so that coordinates are of the mesh's own size however far the eye is.
struct ObjectRay {
  double o[3];
  double q[3]; // o relative to the frame's centre
  double d[3];
  double t0;
  double unit, inverse_unit; // powers of two
};

LANCER_INLINE double magnitude(double x) { return __builtin_fabs(x); }

LANCER_INLINE double larger(double a, double b) { return a > b ? a : b; }

// 2^floor(log2(x)) and its inverse, exactly; x in [2^-1000, 2^1000].
LANCER_INLINE void power_of_two(double x, double &power, double &inverse) {
  uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits &= 0x7ffull << 52;
  const uint64_t inverse_bits = (2046ull << 52) - bits;
  std::memcpy(&power, &bits, sizeof power);
  std::memcpy(&inverse, &inverse_bits, sizeof inverse);
}

// Divides d by the power of two of its largest component. False where d is zero, not finite, or beyond 2^+-1000.
LANCER_INLINE bool normalise_direction(const double d[3], ObjectRay &ray) {
  const double largest = larger(larger(magnitude(d[0]), magnitude(d[1])), magnitude(d[2]));
  const double sum = magnitude(d[0]) + magnitude(d[1]) + magnitude(d[2]);
  if (!(largest >= 0x1p-1000 && sum <= 0x1p1000))
    return false;
  power_of_two(largest, ray.inverse_unit, ray.unit);
  for (int i = 0; i < 3; ++i)
    ray.d[i] = d[i] * ray.unit;
  return true;
}

// Starts the ray o + t d afresh at its closest approach to the frame's centre. False where it is not usable.
LANCER_INLINE bool enter_frame(const PlacementFrame &frame, const double o[3], const double d[3], ObjectRay &ray) {
  if (!normalise_direction(d, ray))
    return false;
  const double f[3] = {o[0] - frame.centre[0], o[1] - frame.centre[1], o[2] - frame.centre[2]};
  const double along = f[0] * ray.d[0] + f[1] * ray.d[1] + f[2] * ray.d[2];
  const double length2 = ray.d[0] * ray.d[0] + ray.d[1] * ray.d[1] + ray.d[2] * ray.d[2];
  const double tau0 = -along / length2;
  for (int i = 0; i < 3; ++i) {
    ray.q[i] = f[i] + tau0 * ray.d[i];
    ray.o[i] = ray.q[i] + frame.centre[i];
  }
  ray.t0 = tau0 * ray.unit;
  return magnitude(ray.t0) + magnitude(ray.q[0]) + magnitude(ray.q[1]) + magnitude(ray.q[2]) < __builtin_inf();
}

// Origin and direction in the shape's object space; t is unchanged.
LANCER_INLINE void to_object_space(const PlacedShape &shape, const Ray &ray, double o[3], double d[3]) {
  for (int i = 0; i < 3; ++i) {
    const double(&m)[4][4] = shape.to_object;
    o[i] = m[0][i] * ray.o.x + m[1][i] * ray.o.y + m[2][i] * ray.o.z + m[3][i];
    d[i] = m[0][i] * ray.d.x + m[1][i] * ray.d.y + m[2][i] * ray.d.z;
  }
}

// Whether the ray can see the shape at all.
LANCER_INLINE bool visible(const PlacedShape &shape, const Ray &ray) { return (ray.kinds & ~shape.hidden_from) != 0; }

LANCER_INLINE bool enter_shape(const PlacedShape &shape, const Ray &ray, ObjectRay &object_ray) {
  double o[3], d[3];
  to_object_space(shape, ray, o, d);
  return enter_frame(shape.frame, o, d, object_ray);
}

// The ray in the scene's frame. False where it meets nothing by decree: not finite, no direction, an empty or undefined range.
LANCER_INLINE bool enter_world(const PlacementFrame &world, const Ray &ray, ObjectRay &world_ray) {
  const double o[3] = {ray.o.x, ray.o.y, ray.o.z}, d[3] = {ray.d.x, ray.d.y, ray.d.z};
  return ray.tmin < ray.tmax && enter_frame(world, o, d, world_ray);
}

LANCER_INLINE double world_t(const ObjectRay &ray, double tau) { return ray.t0 + tau * ray.unit; }

// Box-frame parameters that no hit with parameter <= t (>= t) exceeds. t = t0 + tau unit was rounded once and t - t0 is rounded
// once here: together at most 2^-53 (|t| + |t - t0|) <= 2^-51 (|t| + |t0|).
LANCER_INLINE double box_tau_above(const ObjectRay &ray, const PlacementFrame &frame, double t) {
  return ((t - ray.t0) + 0x1p-51 * (magnitude(t) + magnitude(ray.t0))) * ray.inverse_unit * frame.scale;
}
LANCER_INLINE double box_tau_below(const ObjectRay &ray, const PlacementFrame &frame, double t) {
  return ((t - ray.t0) - 0x1p-51 * (magnitude(t) + magnitude(ray.t0))) * ray.inverse_unit * frame.scale;
}

} // namespace lancer
