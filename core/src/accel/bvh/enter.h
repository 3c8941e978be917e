// Transformation of rays into the world's frame and into the space of a mesh: one ray, or a packet of neighbours. Part of
// bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/flight.h"
#include "simd/kernel_lanes.h"

#include <cstddef>

namespace lancer {
namespace {

// The three components of one ray, one axis per lane. Single rays that enter meshes take half the work of scalar code (a closed
// room renders 2.5 % faster).
struct Axes {
  using D4 = Double<4>;
  D4 v;

  friend LANCER_LANE Axes operator+(const Axes &a, const Axes &b) { return {a.v + b.v}; }
  friend LANCER_LANE Axes operator-(const Axes &a, const Axes &b) { return {a.v - b.v}; }
  friend LANCER_LANE Axes operator*(const Axes &a, double s) { return {a.v * D4(s)}; }
  friend LANCER_LANE Axes operator*(double s, const Axes &a) { return {D4(s) * a.v}; }
  friend LANCER_LANE Axes abs(const Axes &a) { return {abs(a.v)}; }
  friend LANCER_LANE double dot(const Axes &a, const Axes &b) { return sum_of_components(Axes{a.v * b.v}); }
  friend LANCER_LANE double sum_of_components(const Axes &a) {
    const Vector3<double> of = a.numbers();
    return of.x + of.y + of.z;
  }
  friend LANCER_LANE double largest_component(const Axes &a) { return largest_component(a.numbers()); }

private:
  LANCER_LANE Vector3<double> numbers() const {
    alignas(32) double of[4];
    store(of, v);
    return {of[0], of[1], of[2]};
  }
};

LANCER_LANE bool enter_mesh(const PlacedShape &shape, const Ray &ray, MeshRay &r) {
  using D4 = Double<4>;
  const auto column = [&](int i) __attribute__((always_inline)) { return load_doubles<4>(shape.to_object[i]); };
  const D4 x = column(0), y = column(1), z = column(2);
  const Axes o{x * D4(ray.o.x) + y * D4(ray.o.y) + z * D4(ray.o.z) + column(3)};
  const Axes d{x * D4(ray.d.x) + y * D4(ray.d.y) + z * D4(ray.d.z)};
  EnteredRay<Axes, double> entered;
  if (!enter_frame(Axes{load_anywhere<4>(shape.frame.centre)}, o, d, entered))
    return false;
  store(r.o, entered.o.v);
  store(r.q, entered.q.v);
  store(r.d, entered.d.v);
  r.t0 = entered.t0;
  r.unit = entered.unit;
  r.inverse_unit = entered.inverse_unit;
  // Shear along the largest axis.
  r.axes = axes_from(longest_axis(r.d));
  const double up = r.d[r.axes.kz];
  store(r.shear, entered.d.v / D4(up));
  r.shear[3] = 1.0 / up;
  return true;
}

// Rays of a packet, transformed together.
constexpr uint32_t kPacket = 16;
constexpr uint32_t kAllOfPacket = (1u << kPacket) - 1;

// The input of the box test for each ray of a packet, one ray per lane: see Slab.
struct alignas(64) PacketSlabs {
  float inverse[3][kPacket], shift[3][kPacket], tau_min[kPacket], tau_max[kPacket];
  double t0[kPacket], inverse_unit[kPacket];
  double scale;
};

// A packet of rays that enter the world.
struct Entering : PacketSlabs {
  const Ray *rays[kPacket];
  uint32_t number[kPacket];                                                                   // in the batch
  alignas(64) double origin[3][kPacket], tmin[kPacket], direction[3][kPacket], tmax[kPacket]; // as given
  alignas(64) double d[3][kPacket], q[3][kPacket];
  uint32_t usable = 0; // lanes
};

// A packet of rays in the space of a mesh: see MeshRay.
struct alignas(64) PacketRays {
  double o[3][kPacket], shear[3][kPacket], upright[kPacket];
  double t0[kPacket], unit[kPacket];
  uint32_t longest[3]; // lanes whose direction is longest along each axis
  uint32_t usable;     // lanes
};

using PacketRay = EnteredRay<D3, D>;

LANCER_LANE D3 centre_of(const PlacementFrame &frame) { return {D(frame.centre[0]), D(frame.centre[1]), D(frame.centre[2])}; }

// make_slab() for the lanes from first on.
LANCER_LANE void make_slabs(const PlacementFrame &frame, const PacketRay &ray, const D &tmin, const D &tmax, uint32_t first,
                            PacketSlabs &slabs) {
  const V3 inverse{inverse_component(ray.d.x), inverse_component(ray.d.y), inverse_component(ray.d.z)};
  store3(slabs.inverse, first, inverse);
  store3(
      slabs.shift, first,
      V3{slab_shift(frame, ray.q.x, inverse.x), slab_shift(frame, ray.q.y, inverse.y), slab_shift(frame, ray.q.z, inverse.z)});
  store(slabs.t0 + first, ray.t0);
  store(slabs.inverse_unit + first, ray.inverse_unit);
  store(slabs.tau_min + first, round_down(box_tau_below(ray, frame.scale, tmin)));
  store(slabs.tau_max + first, round_up(box_tau_above(ray, frame.scale, tmax)));
}
LANCER_LANE void end_slab(PacketSlabs &slabs, uint32_t lane, double t) {
  const struct { double t0, inverse_unit; } ray{slabs.t0[lane], slabs.inverse_unit[lane]};
  slabs.tau_max[lane] = round_up(box_tau_above(ray, slabs.scale, t));
}

// Transposes rays into lanes.
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
LANCER_LANE void enter_world_packet(const PlacementFrame &world, Entering &e) {
  turn_into_lanes(e);
  e.scale = world.scale;
  e.usable = 0;
  for (uint32_t i = 0; i < kPacket; i += kLanes) {
    const D tmin = load(e.tmin + i), tmax = load(e.tmax + i);
    PacketRay ray;
    const M usable = enter_frame(centre_of(world), load3(e.origin, i), load3(e.direction, i), ray) & (tmin < tmax);
    e.usable |= bits(usable) << i;
    store3(e.d, i, ray.d);
    store3(e.q, i, ray.q);
    make_slabs(world, ray, tmin, tmax, i, e);
  }
}

// Limits of a heuristic: rays with directions in a narrow cone that pass close to each other at the scene's centre visit the
// same boxes. A wrong choice costs only time: with 0.9 and 0.999 in place of 0.99, six scenes of `make bench` take 1.001
// and 1.007 times as long.
constexpr double kPacketCosine2 = 0.99;
constexpr double kPacketWidth = 0.25; // in the scene's frame

// Returns the number of rays between a ray of the batch and its neighbour in the next row of the image; 4 if the batch does not
// consist of rows.
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

// Returns the bits of the lanes whose direction is negative along the axis.
LANCER_LANE uint32_t lanes_down(const float *inverse) {
  uint32_t down = 0;
  for (uint32_t i = 0; i < kPacket; i += kLanes)
    down |= bits(load(inverse + i) < F(0.0f)) << i;
  return down;
}

// Returns whether all lanes are usable, have the same octant and lie close together.
LANCER_LANE bool stay_together(const PlacementFrame &world, const Entering &e) {
  if (e.usable != kAllOfPacket)
    return false;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t down = lanes_down(e.inverse[axis]);
    if (down != 0 && down != kAllOfPacket)
      return false;
  }
  const double first2 = e.d[0][0] * e.d[0][0] + e.d[1][0] * e.d[1][0] + e.d[2][0] * e.d[2][0];
  const double width = kPacketWidth / world.scale;
  const D cosine2(kPacketCosine2 * first2);
  for (uint32_t i = 0; i < kPacket; i += kLanes) {
    const D3 d = load3(e.d, i);
    const D along = dot(D3(D(e.d[0][0]), D(e.d[1][0]), D(e.d[2][0])), d);
    M near = (D(0.0) <= along) & (cosine2 * dot(d, d) <= along * along);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const D q = load(e.q[axis] + i);
      near = near & (D(e.q[axis][0] - width) <= q) & (q <= D(e.q[axis][0] + width));
    }
    if (!all(near))
      return false;
  }
  return true;
}

// enter_mesh() for each lane, with slabs if slabs is given. limit: of each lane's t.
LANCER_LANE void enter_mesh_packet(const PlacedShape &shape, const Entering &e, PacketRays &r, PacketSlabs *slabs = nullptr,
                                   const double *limit = nullptr) {
  r.usable = r.longest[0] = r.longest[1] = r.longest[2] = 0;
  for (uint32_t i = 0; i < kPacket; i += kLanes) {
    D o[3], d[3];
    const D3 from_o = load3(e.origin, i), from_d = load3(e.direction, i);
    to_object_space(
        [&](int column, int row) __attribute__((always_inline)) { return D(shape.to_object[column][row]); },
        {from_o.x, from_o.y, from_o.z}, {from_d.x, from_d.y, from_d.z}, o, d);
    PacketRay ray;
    r.usable |= bits(enter_frame(centre_of(shape.frame), {o[0], o[1], o[2]}, {d[0], d[1], d[2]}, ray)) << i;
    // Shear along the largest axis.
    const D x = abs(d[0]), y = abs(d[1]), z = abs(d[2]);
    const M on_z = (z >= x) & (z >= y), on_y = (y >= x) & !on_z;
    r.longest[2] |= bits(on_z) << i;
    r.longest[1] |= bits(on_y) << i;
    r.longest[0] |= bits(!(on_z | on_y)) << i;
    const D up = select(on_z, ray.d.z, select(on_y, ray.d.y, ray.d.x));
    store3(r.o, i, ray.o);
    store3(r.shear, i, D3(ray.d / up));
    store(r.upright + i, D(1.0) / up);
    store(r.t0 + i, ray.t0);
    store(r.unit + i, ray.unit);
    if (slabs)
      make_slabs(shape.frame, ray, load(e.tmin + i), load(limit + i), i, *slabs);
  }
  if (slabs)
    slabs->scale = shape.frame.scale;
}

} // namespace
} // namespace lancer
