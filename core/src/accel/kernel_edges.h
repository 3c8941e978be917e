// Edge functions of many triangles at once: the middle of intersect_triangle() of triangle.h, whatever the number of lanes.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/simd.h"

namespace lancer {
namespace {

// met: bits of the lanes whose corners, sheared to (x, y), lie around the origin.
template <class Lanes> struct Edges {
  Lanes wa, wb, wc, det;
  uint32_t met;
};

template <class Lanes> LANCER_SIMD Edges<Lanes> edges_of(const Lanes (&x)[3], const Lanes (&y)[3], Lanes zero) {
  Edges<Lanes> e;
  e.wa = x[2] * y[1] - y[2] * x[1];
  e.wb = x[0] * y[2] - y[0] * x[2];
  e.wc = x[1] * y[0] - y[1] * x[0];
  const uint32_t front = less_equal(zero, e.wa) & less_equal(zero, e.wb) & less_equal(zero, e.wc);
  const uint32_t back = less_equal(e.wa, zero) & less_equal(e.wb, zero) & less_equal(e.wc, zero);
  e.det = e.wa + e.wb + e.wc;
  e.met = (front | back) & not_equal(e.det, zero);
  return e;
}

} // namespace
} // namespace lancer
