// The triangle test of rays that stay together: four triangles and two rays at a time.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/kernel_edges.h"
#include "accel/bvh/kernel_enter_packet.h"
#include "accel/bvh/simd16.h"

namespace lancer {
namespace {

LANCER_SIMD void load_lanes(const double *p, D8 &a) { a = load8(p); }
LANCER_SIMD void store_lanes(double *p, D8 a) { store8(p, a); }

// Where two lanes meet four triangles.
struct alignas(64) LaneHits {
  double t[8], wb[8], wc[8], det[8];
};

// intersect_triangle() of triangle.h for four triangles and two lanes whose directions are longest along the same axis. Bit i:
// the first lane meets triangle i with tmin < t < tmax and t <= limit; bit 4 + i: the second lane.
LANCER_SIMD uint32_t intersect_pair(const D8 corner[3][3], const PacketRays &r, uint32_t longest, const uint32_t lanes[2],
                                    const Entering &e, const double *limit, LaneHits &hits) {
  const uint32_t kz = longest, kx = kz == 2 ? 0 : kz + 1, ky = kx == 2 ? 0 : kx + 1;
  const D8 ox = join(r.o[kx], lanes), oy = join(r.o[ky], lanes), oz = join(r.o[kz], lanes);
  const D8 sx = join(r.shear[kx], lanes), sy = join(r.shear[ky], lanes);
  D8 x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    z[i] = corner[i][2] - oz;
    x[i] = (corner[i][0] - ox) - sx * z[i];
    y[i] = (corner[i][1] - oy) - sy * z[i];
  }
  const Edges<D8> edge = edges_of(x, y, splat8(0.0));
  const uint32_t met = edge.met;
  if (met == 0)
    return 0;
  const D8 sz = join(r.upright, lanes);
  const D8 det = sum_in_any_order(edge.wa, edge.wb, edge.wc);
  const D8 depth = sum_in_any_order(edge.wa * (sz * z[0]), edge.wb * (sz * z[1]), edge.wc * (sz * z[2]));
  const D8 t = join(r.t0, lanes) + (depth / det) * join(r.unit, lanes);
  store8(hits.t, t);
  store8(hits.wb, edge.wb);
  store8(hits.wc, edge.wc);
  store8(hits.det, det);
  return met & less(join(e.tmin, lanes), t) & less(t, join(e.tmax, lanes)) & less_equal(t, join(limit, lanes));
}

} // namespace
} // namespace lancer
