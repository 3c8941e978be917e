// Rays on their way into the world and into the space of a mesh: one, an axis a lane; or neighbours together, by plain loops
// over lanes, which the compiler turns into vectors.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/slot.h"
#include "simd/kernel_lanes.h"

#include <cstddef>

namespace lancer {
namespace {

// enter_shape() of placed_shape.h and shear_ray() of triangle.h, an axis a lane. False where the ray is not usable.
LANCER_LANE bool enter_mesh(const PlacedShape &shape, const Ray &ray, MeshRay &r) {
  const auto &m = shape.to_object;
  using D4 = Double<4>;
  const auto load4 = [](const double *p) __attribute__((always_inline)) { return load_doubles<4>(p); };
  const D4 direction = load4(m[0]) * D4(ray.d.x) + load4(m[1]) * D4(ray.d.y) + load4(m[2]) * D4(ray.d.z);
  const D4 origin = load4(m[0]) * D4(ray.o.x) + load4(m[1]) * D4(ray.o.y) + load4(m[2]) * D4(ray.o.z) + load4(m[3]);

  // Divide the direction by the power of two of its largest component.
  alignas(32) double d[4];
  store(d, direction);
  const double ax = abs(d[0]), ay = abs(d[1]), az = abs(d[2]);
  const double largest = max(az, max(ay, ax));
  if (!(largest >= 0x1p-1000 && ax + ay + az <= 0x1p1000))
    return false;
  r.inverse_unit = power_of_two_within(largest);
  r.unit = inverse_of_power(r.inverse_unit);
  const D4 scaled = direction * D4(r.unit);
  store(r.d, scaled);

  // Start at the closest approach to the frame's centre.
  const D4 centre = load_anywhere<4>(shape.frame.centre);
  const D4 f = origin - centre;
  alignas(32) double along[4], length2[4];
  store(along, f * scaled);
  store(length2, scaled * scaled);
  const double tau0 = -(along[0] + along[1] + along[2]) / (length2[0] + length2[1] + length2[2]);
  const D4 q = f + D4(tau0) * scaled;
  store(r.q, q);
  store(r.o, q + centre);
  r.t0 = tau0 * r.unit;

  // Shear the largest axis upright.
  r.axes = axes_from(longest_axis(d));
  const double up = r.d[r.axes.kz];
  store(r.shear, scaled / D4(up));
  r.shear[3] = 1.0 / up;
  return abs(r.t0) + abs(r.q[0]) + abs(r.q[1]) + abs(r.q[2]) < __builtin_inf();
}

// Rays that are handled at a time when they enter a space.
constexpr uint32_t kPacket = 16;
constexpr uint32_t kAllOfPacket = (1u << kPacket) - 1;
// Doubles that are handled at a time.
constexpr int kDoubles = kLanes < 8 ? kLanes : 8;

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
LANCER_LANE void turn_into_lanes(Entering &e) {
  for (uint32_t i = 0; i < kPacket; i += 4) {
    Double<4> o[4], d[4];
    for (uint32_t k = 0; k < 4; ++k) {
      const double *ray = reinterpret_cast<const double *>(e.rays[i + k]);
      o[k] = load_anywhere<4>(ray);
      d[k] = load_anywhere<4>(ray + 4);
    }
    transpose(o[0], o[1], o[2], o[3]);
    transpose(d[0], d[1], d[2], d[3]);
    for (uint32_t k = 0; k < 3; ++k) {
      store(e.origin[k] + i, o[k]);
      store(e.direction[k] + i, d[k]);
    }
    store(e.tmin + i, o[3]);
    store(e.tmax + i, d[3]);
  }
}
static_assert(offsetof(Ray, o) == 0 && offsetof(Ray, tmin) == 24 && offsetof(Ray, d) == 32 && offsetof(Ray, tmax) == 56);

// enter_world() of placed_shape.h for each lane.
LANCER_LANE void enter_world_packet(const PlacementFrame &frame, Entering &e) {
  constexpr uint32_t n = kPacket;
  const PlacementFrame world = frame; // a copy, which no store to a lane can change
  e.scale = world.scale;
  alignas(64) double largest[n], sum[n], tau0[n];
  turn_into_lanes(e);
  const auto &tmin = e.tmin, &tmax = e.tmax;
  auto &d = e.d, &f = e.q;
  for (uint32_t k = 0; k < 3; ++k)
    for (uint32_t i = 0; i < n; ++i) {
      d[k][i] = e.direction[k][i];
      f[k][i] = e.origin[k][i];
    }
  // In lanes: of comparisons in a plain loop the compiler makes one after the other.
  for (uint32_t i = 0; i < n; i += kDoubles) {
    const auto of = [&](uint32_t axis) __attribute__((always_inline)) { return abs(load_doubles<kDoubles>(d[axis] + i)); };
    const Double<kDoubles> x = of(0), y = of(1), z = of(2);
    store(largest + i, max(z, max(y, x)));
    store(sum + i, x + y + z);
  }
  alignas(64) double unit[n];
  for (uint32_t i = 0; i < n; ++i) {
    e.inverse_unit[i] = power_of_two_within(largest[i]);
    unit[i] = inverse_of_power(e.inverse_unit[i]);
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
    const double reach = abs(e.t0[i]) + abs(f[0][i]) + abs(f[1][i]) + abs(f[2][i]);
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
    e.tau_min[i] = round_down(((tmin[i] - a) - 0x1p-51 * (abs(tmin[i]) + abs(a))) * e.inverse_unit[i] * world.scale);
    e.tau_max[i] = round_up(((tmax[i] - a) + 0x1p-51 * (abs(tmax[i]) + abs(a))) * e.inverse_unit[i] * world.scale);
  }
}

// Rays whose directions lie in a cone and that pass the scene's middle side by side look at the same boxes. Guesses: a wrong
// answer costs time only.
constexpr double kPacketCosine2 = 0.99;
constexpr double kPacketWidth = 0.25; // in the scene's frame

// How many rays lie between a ray of the batch and its neighbour in the next row of the image, if they come row by row; else 4.
LANCER_LANE size_t find_row(const Ray *rays, size_t count) {
  const auto apart = [&](size_t i) __attribute__((always_inline)) {
    const double x = rays[i].d.x - rays[0].d.x, y = rays[i].d.y - rays[0].d.y, z = rays[i].d.z - rays[0].d.z;
    return x * x + y * y + z * z;
  };
  size_t row = 4;
  if (count > 64) {
    double least = apart(8);
    for (size_t i = 16; i <= 64; i *= 2)
      if (const double distance = apart(i); distance < least) {
        least = distance;
        row = i;
      }
  }
  return row;
}

// Bit i: lane i goes down the axis.
LANCER_LANE uint32_t lanes_down(const float *inverse) {
  uint32_t down = 0;
  for (uint32_t i = 0; i < kPacket; i += kLanes)
    down |= bits(load(inverse + i) < F(0.0f)) << i;
  return down;
}

// Whether all lanes are usable, go down the same axes and lie close together.
LANCER_LANE bool stay_together(const PlacementFrame &world, const Entering &e) {
  using Doubles = Double<kDoubles>;
  const Doubles cosine2(kPacketCosine2 * e.length2[0]);
  const double width = kPacketWidth / world.scale;
  uint32_t together = ~0u;
  for (uint32_t first = 0; first < kPacket; first += kDoubles) {
    Doubles dot(0.0);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      dot = dot + Doubles(e.d[axis][0]) * load_doubles<kDoubles>(e.d[axis] + first);
      const Doubles q = load_doubles<kDoubles>(e.q[axis] + first);
      together &= bits((Doubles(e.q[axis][0] - width) <= q) & (q <= Doubles(e.q[axis][0] + width)));
    }
    together &= bits((Doubles(0.0) <= dot) & (cosine2 * load_doubles<kDoubles>(e.length2 + first) <= dot * dot));
  }
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t up = kAllOfPacket & ~lanes_down(e.inverse[axis]);
    if (up != 0 && up != kAllOfPacket)
      return false;
  }
  uint64_t usable = 1;
  for (uint32_t i = 0; i < kPacket; ++i)
    usable &= e.usable[i];
  return usable && together << (32 - kDoubles) == ~0u << (32 - kDoubles);
}

// Rays in the space of a mesh: see MeshRay.
struct alignas(64) PacketRays {
  double o[3][kPacket], shear[3][kPacket], upright[kPacket];
  double d[3][kPacket], q[3][kPacket];
  double t0[kPacket], unit[kPacket], inverse_unit[kPacket];
  uint64_t longest[kPacket]; // axis
  uint64_t usable[kPacket];
};

// enter_mesh() for each lane.
LANCER_LANE void enter_mesh_packet(const PlacedShape &shape, const Entering &e, PacketRays &r) {
  // Copies, which no store to a lane can change.
  double m[4][3], centre[3];
  for (uint32_t k = 0; k < 3; ++k) {
    centre[k] = shape.frame.centre[k];
    for (uint32_t column = 0; column < 4; ++column)
      m[column][k] = shape.to_object[column][k];
  }
  const auto &o = e.origin, &d = e.direction;
  for (uint32_t k = 0; k < 3; ++k)
    for (uint32_t i = 0; i < kPacket; ++i) {
      r.d[k][i] = m[0][k] * d[0][i] + m[1][k] * d[1][i] + m[2][k] * d[2][i];
      r.o[k][i] = m[0][k] * o[0][i] + m[1][k] * o[1][i] + m[2][k] * o[2][i] + m[3][k];
    }
  // Divide each direction by the power of two of its largest component; start at the closest approach to the frame's centre.
  for (uint32_t i = 0; i < kPacket; ++i) {
    const double ax = abs(r.d[0][i]), ay = abs(r.d[1][i]), az = abs(r.d[2][i]);
    const double largest = max(az, max(ay, ax));
    r.usable[i] = uint64_t{largest >= 0x1p-1000} & uint64_t{ax + ay + az <= 0x1p1000};
    r.inverse_unit[i] = power_of_two_within(largest);
    r.unit[i] = inverse_of_power(r.inverse_unit[i]);
    r.longest[i] = ((az >= ax) & (az >= ay)) ? 2 : (ay >= ax ? 1 : 0);
  }
  for (uint32_t i = 0; i < kPacket; ++i) {
    const double dx = r.d[0][i] * r.unit[i], dy = r.d[1][i] * r.unit[i], dz = r.d[2][i] * r.unit[i];
    const double fx = r.o[0][i] - centre[0], fy = r.o[1][i] - centre[1], fz = r.o[2][i] - centre[2];
    const double tau0 = -(fx * dx + fy * dy + fz * dz) / (dx * dx + dy * dy + dz * dz);
    r.q[0][i] = fx + tau0 * dx;
    r.q[1][i] = fy + tau0 * dy;
    r.q[2][i] = fz + tau0 * dz;
    r.d[0][i] = dx;
    r.d[1][i] = dy;
    r.d[2][i] = dz;
    r.t0[i] = tau0 * r.unit[i];
  }
  // Shear the largest axis upright.
  for (uint32_t i = 0; i < kPacket; ++i) {
    // Two choices between values at hand: of three places in memory clang makes a switch, and no vectors.
    const double x = r.d[0][i], y = r.d[1][i], z = r.d[2][i];
    const double lying = r.longest[i] == 1 ? y : x, up = r.longest[i] == 2 ? z : lying;
    for (uint32_t k = 0; k < 3; ++k) {
      r.o[k][i] = r.q[k][i] + centre[k];
      r.shear[k][i] = r.d[k][i] / up;
    }
    r.upright[i] = 1.0 / up;
    r.usable[i] &= uint64_t{abs(r.t0[i]) + abs(r.q[0][i]) + abs(r.q[1][i]) + abs(r.q[2][i]) < __builtin_inf()};
  }
}

LANCER_LANE float slab_end(const PacketSlabs &s, uint32_t i, double t) {
  return round_up(((t - s.t0[i]) + 0x1p-51 * (abs(t) + abs(s.t0[i]))) * s.inverse_unit[i] * s.scale);
}

// make_slab() for each lane.
LANCER_LANE void make_slabs(const PlacementFrame &frame, const PacketRays &r, const double *tmin, const double *limit,
                            PacketSlabs &s) {
  const double scale = s.scale = frame.scale;
  for (uint32_t k = 0; k < 3; ++k)
    for (uint32_t i = 0; i < kPacket; ++i) {
      s.inverse[k][i] = inverse_component(r.d[k][i]);
      s.shift[k][i] = static_cast<float>(r.q[k][i] * scale) * s.inverse[k][i];
    }
  for (uint32_t i = 0; i < kPacket; ++i) {
    s.t0[i] = r.t0[i];
    s.inverse_unit[i] = r.inverse_unit[i];
    const double low = tmin[i], high = limit[i], t0 = s.t0[i], unit = s.inverse_unit[i];
    s.tau_min[i] = round_down(((low - t0) - 0x1p-51 * (abs(low) + abs(t0))) * unit * scale);
    s.tau_max[i] = round_up(((high - t0) + 0x1p-51 * (abs(high) + abs(t0))) * unit * scale);
  }
}

} // namespace
} // namespace lancer
