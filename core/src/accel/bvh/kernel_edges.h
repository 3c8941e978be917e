// Edge functions of many triangles at once: the middle of intersect_triangle() of triangle.h, whatever the number of lanes.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/simd.h"
#include "accel/edge_sides.h"

namespace lancer {
namespace {

// What lanes of any number share a name for.
LANCER_SIMD D4 lower(D4 a, D4 b) { return min4(a, b); }
LANCER_SIMD D4 upper(D4 a, D4 b) { return max4(a, b); }
LANCER_SIMD void load_lanes(const double *p, D4 &a) { a = load4(p); }
LANCER_SIMD void store_lanes(double *p, D4 a) { store4(p, a); }

// met: bits of the lanes whose corners, sheared to (x, y), lie around the origin.
template <class Lanes> struct Edges {
  Lanes wa, wb, wc;
  uint32_t met;
};

// Asks within_edges() about the lanes of ties: rays that meet an edge exactly, which are few.
template <class Lanes>
[[gnu::noinline, gnu::cold]] void settle_ties(const Lanes (&x)[3], const Lanes (&y)[3], uint32_t ties, Edges<Lanes> &e) {
  constexpr size_t count = sizeof(Lanes) / sizeof(double);
  alignas(64) double corner_x[3][count], corner_y[3][count], edge[3][count];
  for (int i = 0; i < 3; ++i) {
    store_lanes(corner_x[i], x[i]);
    store_lanes(corner_y[i], y[i]);
  }
  store_lanes(edge[0], e.wa);
  store_lanes(edge[1], e.wb);
  store_lanes(edge[2], e.wc);
  for (; ties != 0; ties &= ties - 1) {
    const int lane = __builtin_ctz(ties);
    const double lane_x[3] = {corner_x[0][lane], corner_x[1][lane], corner_x[2][lane]};
    const double lane_y[3] = {corner_y[0][lane], corner_y[1][lane], corner_y[2][lane]};
    double w[3] = {edge[0][lane], edge[1][lane], edge[2][lane]};
    if (!within_edges(lane_x, lane_y, w))
      e.met &= ~(1u << lane);
    for (int i = 0; i < 3; ++i)
      edge[i][lane] = w[i];
  }
  load_lanes(edge[0], e.wa);
  load_lanes(edge[1], e.wb);
  load_lanes(edge[2], e.wc);
}

template <class Lanes> LANCER_SIMD Edges<Lanes> edges_of(const Lanes (&x)[3], const Lanes (&y)[3], Lanes zero) {
  Edges<Lanes> e;
  e.wa = x[2] * y[1] - y[2] * x[1];
  e.wb = x[0] * y[2] - y[0] * x[2];
  e.wc = x[1] * y[0] - y[1] * x[0];
  const uint32_t front = less_equal(zero, e.wa) & less_equal(zero, e.wb) & less_equal(zero, e.wc);
  const uint32_t back = less_equal(e.wa, zero) & less_equal(e.wb, zero) & less_equal(e.wc, zero);
  e.met = front | back;
  if (e.met != 0)
    if (const uint32_t ties = e.met & ~not_equal(e.wa * e.wb * e.wc, zero); ties != 0)
      settle_ties(x, y, ties, e);
  return e;
}

// sum_in_any_order() of edge_sides.h.
template <class Lanes> LANCER_SIMD Lanes sum_in_any_order(Lanes a, Lanes b, Lanes c) {
  const Lanes low = lower(a, b), high = upper(a, b);
  return (lower(low, c) + upper(high, c)) + upper(low, lower(high, c));
}

} // namespace
} // namespace lancer
