// Rays on their way into the world and into the space of a mesh, in vectors.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/kernel_slot.h"
#include "accel/bvh/simd_transpose.h"

namespace lancer {
namespace {

// enter_shape() of object_ray.h and make_shear() of triangle.h, an axis a lane. False where the ray is not usable.
LANCER_SIMD bool enter_mesh(const PlacedShape &shape, const Ray &ray, MeshRay &r) {
  const auto &m = shape.to_object;
  const D4 direction = load4(m[0]) * splat4(ray.d.x) + load4(m[1]) * splat4(ray.d.y) + load4(m[2]) * splat4(ray.d.z);
  const D4 origin = load4(m[0]) * splat4(ray.o.x) + load4(m[1]) * splat4(ray.o.y) + load4(m[2]) * splat4(ray.o.z) + load4(m[3]);

  // Divide the direction by the power of two of its largest component.
  alignas(32) double d[4];
  store4(d, direction);
  const double ax = magnitude(d[0]), ay = magnitude(d[1]), az = magnitude(d[2]);
  const double largest = larger(larger(ax, ay), az);
  if (!(largest >= 0x1p-1000 && ax + ay + az <= 0x1p1000))
    return false;
  power_of_two(largest, r.inverse_unit, r.unit);
  const D4 scaled = direction * splat4(r.unit);
  store4(r.d, scaled);

  // Start at the closest approach to the frame's centre.
  const D4 centre = load4_anywhere(shape.frame.centre);
  const D4 f = origin - centre;
  alignas(32) double along[4], length2[4];
  store4(along, f * scaled);
  store4(length2, scaled * scaled);
  const double tau0 = -(along[0] + along[1] + along[2]) / (length2[0] + length2[1] + length2[2]);
  const D4 q = f + splat4(tau0) * scaled;
  store4(r.q, q);
  store4(r.o, q + centre);
  r.t0 = tau0 * r.unit;

  // Shear the largest axis upright.
  r.kz = az >= ax && az >= ay ? 2 : (ay >= ax ? 1 : 0);
  r.kx = r.kz == 2 ? 0 : r.kz + 1;
  r.ky = r.kx == 2 ? 0 : r.kx + 1;
  const D4 up = splat4(r.d[r.kz]);
  store4(r.shear, scaled / up);
  r.shear[3] = 1.0 / r.d[r.kz];
  return magnitude(r.t0) + magnitude(r.q[0]) + magnitude(r.q[1]) + magnitude(r.q[2]) < __builtin_inf();
}

// Rays that are handled at a time when they enter a space.
constexpr uint32_t kPacket = 16;

// Rays as the box test reads them, a lane a ray: see Slab.
struct alignas(64) PacketSlabs {
  float inverse[3][kPacket], shift[3][kPacket], tau_min[kPacket], tau_max[kPacket];
  double t0[kPacket], inverse_unit[kPacket];
  double scale;
};

// Rays as they enter the world, some at a time: plain loops over lanes, which the compiler turns into vectors.
struct Entering : PacketSlabs {
  const Ray *rays[kPacket];
  uint32_t number[kPacket];                                                                   // in the batch
  alignas(64) double origin[3][kPacket], tmin[kPacket], direction[3][kPacket], tmax[kPacket]; // as they come
  alignas(64) double d[3][kPacket], q[3][kPacket], length2[kPacket];
  alignas(64) uint64_t usable[kPacket];
};

// Turns rays into lanes.
LANCER_SIMD void gather(Entering &e) {
  for (uint32_t i = 0; i < kPacket; i += 4) {
    D4 o[4], d[4];
    for (uint32_t k = 0; k < 4; ++k) {
      const double *ray = reinterpret_cast<const double *>(e.rays[i + k]);
      o[k] = load4_anywhere(ray);
      d[k] = load4_anywhere(ray + 4);
    }
    transpose4(o[0], o[1], o[2], o[3]);
    transpose4(d[0], d[1], d[2], d[3]);
    for (uint32_t k = 0; k < 3; ++k) {
      store4(e.origin[k] + i, o[k]);
      store4(e.direction[k] + i, d[k]);
    }
    store4(e.tmin + i, o[3]);
    store4(e.tmax + i, d[3]);
  }
}
static_assert(offsetof(Ray, o) == 0 && offsetof(Ray, tmin) == 24 && offsetof(Ray, d) == 32 && offsetof(Ray, tmax) == 56);

// enter_world() of object_ray.h for each lane.
LANCER_SIMD void enter_world_packet(const PlacementFrame &frame, Entering &e) {
  constexpr uint32_t n = kPacket;
  const PlacementFrame world = frame; // a copy, which no store to a lane can change
  e.scale = world.scale;
  alignas(64) double largest[n], sum[n], tau0[n];
  gather(e);
  const auto &tmin = e.tmin, &tmax = e.tmax;
  auto &d = e.d, &f = e.q;
  for (uint32_t k = 0; k < 3; ++k)
    for (uint32_t i = 0; i < n; ++i) {
      d[k][i] = e.direction[k][i];
      f[k][i] = e.origin[k][i];
    }
  for (uint32_t i = 0; i < n; ++i) {
    largest[i] = larger(larger(magnitude(d[0][i]), magnitude(d[1][i])), magnitude(d[2][i]));
    sum[i] = magnitude(d[0][i]) + magnitude(d[1][i]) + magnitude(d[2][i]);
  }
  alignas(64) double unit[n];
  for (uint32_t i = 0; i < n; ++i) {
    const uint64_t bits = __builtin_bit_cast(uint64_t, largest[i]) & 0x7ffull << 52;
    e.inverse_unit[i] = __builtin_bit_cast(double, bits);
    unit[i] = __builtin_bit_cast(double, (2046ull << 52) - bits);
  }
  for (uint32_t i = 0; i < n; ++i) {
    d[0][i] *= unit[i];
    d[1][i] *= unit[i];
    d[2][i] *= unit[i];
    f[0][i] -= world.centre[0];
    f[1][i] -= world.centre[1];
    f[2][i] -= world.centre[2];
    const double along = f[0][i] * d[0][i] + f[1][i] * d[1][i] + f[2][i] * d[2][i];
    e.length2[i] = d[0][i] * d[0][i] + d[1][i] * d[1][i] + d[2][i] * d[2][i];
    tau0[i] = -along / e.length2[i];
    f[0][i] += tau0[i] * d[0][i];
    f[1][i] += tau0[i] * d[1][i];
    f[2][i] += tau0[i] * d[2][i];
    e.t0[i] = tau0[i] * unit[i];
  }
  for (uint32_t i = 0; i < n; ++i) {
    const double reach = magnitude(e.t0[i]) + magnitude(f[0][i]) + magnitude(f[1][i]) + magnitude(f[2][i]);
    e.usable[i] = uint64_t{tmin[i] < tmax[i]} & uint64_t{largest[i] >= 0x1p-1000} & uint64_t{sum[i] <= 0x1p1000} &
                  uint64_t{reach < __builtin_inf()};
  }
  for (int axis = 0; axis < 3; ++axis)
    for (uint32_t i = 0; i < n; ++i) {
      e.inverse[axis][i] = inverse_component(d[axis][i]);
      e.shift[axis][i] = static_cast<float>(f[axis][i] * world.scale) * e.inverse[axis][i];
    }
  for (uint32_t i = 0; i < n; ++i) {
    const double a = e.t0[i];
    e.tau_min[i] =
        round_down(((tmin[i] - a) - 0x1p-51 * (magnitude(tmin[i]) + magnitude(a))) * e.inverse_unit[i] * world.scale);
    e.tau_max[i] = round_up(((tmax[i] - a) + 0x1p-51 * (magnitude(tmax[i]) + magnitude(a))) * e.inverse_unit[i] * world.scale);
  }
}

} // namespace
} // namespace lancer
