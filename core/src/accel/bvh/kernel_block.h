// The triangle test of the wide BVH, four at a time.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/bvh.h"
#include "accel/bvh/kernel_edges.h"
#include "accel/bvh/kernel_slot.h"
#include "accel/bvh/simd.h"

namespace lancer {
namespace {

// Four triangles that may be met: their parameters and edge functions.
struct BlockHits {
  alignas(32) double t[4], wb[4], wc[4], det[4];
};

// intersect_triangle() of triangle.h, four at a time. Bit i: triangle i is met with tmin < t < tmax and t <= limit.
LANCER_SIMD uint32_t intersect_block(const TriangleBlock &block, const MeshRay &s, double tmin, double tmax, double limit,
                                     BlockHits &hits) {
  const D4 ox = splat4(s.o[s.kx]), oy = splat4(s.o[s.ky]), oz = splat4(s.o[s.kz]);
  const D4 sx = splat4(s.shear[s.kx]), sy = splat4(s.shear[s.ky]), sz = splat4(s.shear[3]);
  D4 x[3], y[3], z[3];
  for (int corner = 0; corner < 3; ++corner) {
    z[corner] = widen4(block.corner[corner][s.kz]) - oz;
    x[corner] = (widen4(block.corner[corner][s.kx]) - ox) - sx * z[corner];
    y[corner] = (widen4(block.corner[corner][s.ky]) - oy) - sy * z[corner];
  }
  const Edges<D4> e = edges_of(x, y, splat4(0.0));
  uint32_t met = e.met;
  if (met == 0)
    return 0;
  const D4 det = sum_in_any_order(e.wa, e.wb, e.wc);
  const D4 depth = sum_in_any_order(e.wa * (sz * z[0]), e.wb * (sz * z[1]), e.wc * (sz * z[2]));
  store4(hits.t, splat4(s.t0) + (depth / det) * splat4(s.unit));
  store4(hits.wb, e.wb);
  store4(hits.wc, e.wc);
  store4(hits.det, det);
  for (uint32_t rest = met; rest != 0; rest &= rest - 1) {
    const int i = __builtin_ctz(rest);
    const double t = hits.t[i];
    if (!(tmin < t && t < tmax && t <= limit))
      met &= ~(1u << i);
  }
  return met;
}

} // namespace
} // namespace lancer
