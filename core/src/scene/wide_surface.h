// surface_at() for triangles, spheres and planes of many lanes at once, with the bits of surface.cpp. For kernels only, like
// simd/lanes.h.
#pragma once

#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// A number of every lane's placement: the doubles of Instance from to_world on.
LANCER_LANE D placed(const double *const *placements, bool same, int at) {
  if (same)
    return D(placements[0][at]);
  alignas(64) double values[kLanes];
  for (int i = 0; i < kLanes; ++i)
    values[i] = placements[i][at];
  return load(values);
}

// A 3 x 3 matrix in columns, and a translation.
struct WideMap {
  D3 x, y, z, translation;
};
LANCER_LANE WideMap placed_map(const double *const *placements, bool same, int at) {
  const auto vector = [&](int first) __attribute__((always_inline)) {
    return D3{placed(placements, same, first), placed(placements, same, first + 1), placed(placements, same, first + 2)};
  };
  return {vector(at), vector(at + 3), vector(at + 6), vector(at + 9)};
}
LANCER_LANE D3 map_vector(const WideMap &m, const D3 &v) {
  return {m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z,
          m.x.z * v.x + m.y.z * v.y + m.z.z * v.z};
}
LANCER_LANE D3 map_point(const WideMap &m, const D3 &p) { return map_vector(m, p) + m.translation; }
LANCER_LANE D3 map_transposed(const WideMap &m, const D3 &v) {
  return {m.x.x * v.x + m.x.y * v.y + m.x.z * v.z, m.y.x * v.x + m.y.y * v.y + m.y.z * v.z,
          m.z.x * v.x + m.z.y * v.y + m.z.z * v.z};
}

LANCER_LANE D largest_coordinate(const D3 &v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Unit vectors of those whose squared length is well within double; odd: the others.
LANCER_LANE V3 unit(const D3 &v, M &odd) {
  const D length2 = dot(v, v);
  odd = odd | !((length2 > D(1e-200)) & (length2 < D(1e200)));
  return narrow(v * (D(1.0) / sqrt(length2)));
}

// position_bound()
LANCER_LANE D reach_bound(const double *const *placements, bool same, const D3 &p_object, const D3 &p_world) {
  const D reach_there = placed(placements, same, 24), moved = placed(placements, same, 25);
  const D reach_back = placed(placements, same, 26), moved_back = placed(placements, same, 27);
  const D there = reach_there * largest_coordinate(p_object) + moved;
  const D back = reach_there * (reach_back * largest_coordinate(p_world) + moved_back);
  return (there + back) * D(0x1p-49);
}

struct WideSurface {
  D3 p;
  D offset;
  V3 ng, ns; // outwards
  M odd;     // lanes that only surface_at() can do
};

// v, n: corners and their normals; u, w: weights of corners 1 and 2.
LANCER_LANE WideSurface mesh_surface(const double *const *placements, bool same, const V3 (&v)[3], const V3 (&n)[3], M smooth,
                                     D u, D w) {
  const WideMap to_world = placed_map(placements, same, 0), to_object = placed_map(placements, same, 12);
  WideSurface surface;
  surface.odd = mask_of(0);
  // The point from its weights.
  const D first = D(1.0) - u - w;
  const D3 v0 = widen(v[0]), v1 = widen(v[1]), v2 = widen(v[2]);
  const D3 p = first * v0 + u * v1 + w * v2;
  surface.p = map_point(to_world, p);
  // How far it may lie from the surface.
  const D3 corner{max(abs(v0.x), max(abs(v1.x), abs(v2.x))), max(abs(v0.y), max(abs(v1.y), abs(v2.y))),
                  max(abs(v0.z), max(abs(v1.z), abs(v2.z)))};
  surface.offset = reach_bound(placements, same, corner, surface.p);
  // Both normals.
  const D3 a = v1 - v0, b = v2 - v0;
  const D3 across{a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  surface.ng = unit(map_transposed(to_object, across), surface.odd);
  surface.ns = surface.ng;
  if (any(smooth)) {
    const V3 between = narrow(first) * n[0] + narrow(u) * n[1] + narrow(w) * n[2];
    const M there_is = smooth & !black(between);
    M odd = mask_of(0);
    const V3 ns = unit(map_transposed(to_object, widen(between)), odd);
    surface.ns = select(there_is, ns, surface.ng);
    surface.odd = surface.odd | (odd & there_is);
  }
  return surface;
}

// Spheres, and in the lanes of plane unit planes. o, d: the ray; t: where it met them.
LANCER_LANE WideSurface round_surface(const double *const *placements, bool same, const D3 &o, const D3 &d, D t, M plane) {
  const WideMap to_world = placed_map(placements, same, 0), to_object = placed_map(placements, same, 12);
  const D zero(0.0), one(1.0);
  WideSurface surface;
  surface.odd = mask_of(0);
  // Move the point to the nearest place on the surface: quadric_point().
  D3 p = map_point(to_object, o) + t * map_vector(to_object, d);
  const D length = sqrt(dot(p, p));
  const M centre = !(length > zero);
  const D3 up{zero, zero, one}, on_sphere = select(centre, up, p / length);
  p = select(plane, D3{p.x, p.y, zero}, on_sphere);
  surface.p = map_point(to_world, p);
  surface.offset = reach_bound(placements, same, D3{max(abs(p.x), one), max(abs(p.y), one), max(abs(p.z), one)}, surface.p);
  surface.ng = surface.ns = unit(map_transposed(to_object, select(plane, up, on_sphere)), surface.odd);
  return surface;
}

} // namespace
} // namespace lancer
