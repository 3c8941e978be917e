// Neighbouring rays on their way into the world and into a mesh together: plain loops over lanes, which the compiler turns
// into vectors.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/kernel_block.h"
#include "accel/bvh/kernel_enter.h"
#include "accel/bvh/simd16.h"

namespace lancer {
namespace {

// Rays whose directions lie in a cone and that pass the scene's middle side by side look at the same boxes. Guesses: a wrong
// answer costs time only.
constexpr double kPacketCosine2 = 0.99;
constexpr double kPacketWidth = 0.25; // in the scene's frame

// How many rays lie between a ray of the batch and its neighbour in the next row of the image, if they come row by row; else 4.
LANCER_SIMD size_t find_row(const Ray *rays, size_t count) {
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

// Whether all lanes are usable, go down the same axes and lie close together.
LANCER_SIMD bool stay_together(const PlacementFrame &world, const Entering &e) {
  const D8 cosine2 = splat8(kPacketCosine2 * e.length2[0]);
  const double width = kPacketWidth / world.scale;
  uint32_t apart = 0;
  for (uint32_t first = 0; first < kPacket; first += 8) {
    D8 dot = splat8(0.0);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      dot = dot + splat8(e.d[axis][0]) * load8(e.d[axis] + first);
      const D8 q = load8(e.q[axis] + first);
      apart |= ~(less_equal(splat8(e.q[axis][0] - width), q) & less_equal(q, splat8(e.q[axis][0] + width)));
    }
    apart |= ~(less_equal(splat8(0.0), dot) & less_equal(cosine2 * load8(e.length2 + first), dot * dot));
  }
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t up = less_equal(splat16(0.0f), load16(e.inverse[axis]));
    if (up != 0 && up != (1u << kPacket) - 1)
      return false;
  }
  uint64_t usable = 1;
  for (uint32_t i = 0; i < kPacket; ++i)
    usable &= e.usable[i];
  return usable && (apart & 255) == 0;
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
LANCER_SIMD void enter_mesh_packet(const PlacedShape &shape, const Entering &e, PacketRays &r) {
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
    const double ax = magnitude(r.d[0][i]), ay = magnitude(r.d[1][i]), az = magnitude(r.d[2][i]);
    const double largest = larger(larger(ax, ay), az);
    r.usable[i] = uint64_t{largest >= 0x1p-1000} & uint64_t{ax + ay + az <= 0x1p1000};
    const uint64_t bits = __builtin_bit_cast(uint64_t, largest) & 0x7ffull << 52;
    r.inverse_unit[i] = __builtin_bit_cast(double, bits);
    r.unit[i] = __builtin_bit_cast(double, (2046ull << 52) - bits);
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
    r.usable[i] &=
        uint64_t{magnitude(r.t0[i]) + magnitude(r.q[0][i]) + magnitude(r.q[1][i]) + magnitude(r.q[2][i]) < __builtin_inf()};
  }
}

LANCER_SIMD float slab_end(const PacketSlabs &s, uint32_t i, double t) {
  return round_up(((t - s.t0[i]) + 0x1p-51 * (magnitude(t) + magnitude(s.t0[i]))) * s.inverse_unit[i] * s.scale);
}

// make_slab() for each lane.
LANCER_SIMD void make_slabs(const PlacementFrame &frame, const PacketRays &r, const double *tmin, const double *limit,
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
    s.tau_min[i] = round_down(((low - t0) - 0x1p-51 * (magnitude(low) + magnitude(t0))) * unit * scale);
    s.tau_max[i] = round_up(((high - t0) + 0x1p-51 * (magnitude(high) + magnitude(t0))) * unit * scale);
  }
}

} // namespace
} // namespace lancer
