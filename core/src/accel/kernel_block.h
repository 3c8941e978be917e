// The triangle test of the wide BVH, four at a time.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh.h"
#include "accel/kernel_slot.h"
#include "accel/simd.h"

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
  const D4 wa = x[2] * y[1] - y[2] * x[1];
  const D4 wb = x[0] * y[2] - y[0] * x[2];
  const D4 wc = x[1] * y[0] - y[1] * x[0];
  const D4 zero = splat4(0.0);
  const uint32_t front = less_equal(zero, wa) & less_equal(zero, wb) & less_equal(zero, wc);
  const uint32_t back = less_equal(wa, zero) & less_equal(wb, zero) & less_equal(wc, zero);
  const D4 det = wa + wb + wc;
  uint32_t met = (front | back) & not_equal(det, zero);
  if (met == 0)
    return 0;
  const D4 depth = wa * (sz * z[0]) + wb * (sz * z[1]) + wc * (sz * z[2]);
  store4(hits.t, splat4(s.t0) + (depth / det) * splat4(s.unit));
  store4(hits.wb, wb);
  store4(hits.wc, wc);
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
