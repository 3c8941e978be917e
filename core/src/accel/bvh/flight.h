// The state of a ray in the wide BVH: its box test, its stack, its best hit. Part of bvh_kernel.cpp: everything has internal
// linkage.
#pragma once

#include "accel/bvh/bvh.h"
#include "accel/hit_tests.h"
#include "simd/sorted_lanes.h"

namespace lancer {

namespace {

// The variant of a query, a template parameter of the traversal.
struct Question {
  bool any = false;      // any hit ends the query, not only the closest
  bool filtered = false; // a filter may reject hits
  bool counted = false;  // count the work
  bool moving = false;   // something in the scene moves
};

// Returns whether the filter rejects a hit.
template <Question q> LANCER_LANE bool left_out(HitFilter *filter, size_t number, const Hit &hit) {
  if constexpr (q.filtered)
    return filter->instances[hit.instance] != 0 && !filter->counts(number, hit);
  else
    return false;
}

// Rays in flight per thread: while one waits for its node or block, the others proceed.
constexpr uint32_t kFlights = 32;
constexpr uint32_t kStackSize = 2 * kBvhTreeStack;

// The input of the float slab test, in a box frame: the ray meets the plane x = b at the parameter b * inverse - shift.
struct Slab {
  float inverse[3], shift[3];
  float tau_min, tau_max;
  double t0, inverse_unit, scale; // conversion of t to tau, see box_tau_above()
  uint32_t octant;                // bit i: the direction is negative along axis i
};

// The input of the triangle test: a ray in the space of an instance.
struct alignas(32) MeshRay {
  double o[4];
  double shear[4]; // direction over its largest component; then one over this component
  double d[4], q[4];
  double t0, unit, inverse_unit;
  RayAxes axes;
};

struct alignas(64) Flight {
  Slab slab;
  const char *arrays[kBvhKinds]; // by kind: the array of its entries
  const char *at;                // current entry
  uint32_t kind;                 // its kind
  uint32_t size;                 // of the stack
  uint32_t base;                 // start of the current tree's entries on the stack
  uint32_t instance;             // instance that the ray is in
  uint32_t skip;
  uint32_t unbounded; // number of unbounded instances still to test
  uint32_t number;    // of the ray in its batch
  bool usable;        // whether the ray can hit the instance
  // State of queries in which something moves: whether the current tree has moving nodes; for the current mesh, the bytes from
  // a block to that of the next key, and the share of the way to it.
  bool tree_moves;
  size_t key_step;
  float key_share, time;
  double tmin, tmax;
  Hit best;
  MeshRay ray;
  Slab outer;
  float entries[kStackSize + 8];
  uint32_t children[kStackSize + 8];
};

// Returns a float not below x, so that narrowing cuts off no hit.
template <class D> LANCER_LANE auto round_up(const D &x) { return narrow(x + D(0x1p-22) * abs(x)); }
template <class D> LANCER_LANE auto round_down(const D &x) { return narrow(x - D(0x1p-22) * abs(x)); }

// Directions below 2^-66 of the largest component move a ray by less than 2^-63 of the box frame: they are replaced by 2^-66,
// which kBoxPad covers, and infinity times zero cannot arise.
template <class D> LANCER_LANE auto inverse_component(const D &d) {
  const auto x = narrow(d);
  using F = std::remove_const_t<decltype(x)>;
  return select(abs(x) < F(0x1p-66f), copysign(F(0x1p66f), x), F(1.0f) / x);
}
// Shift along one axis.
template <class D, class F> LANCER_LANE F slab_shift(const PlacementFrame &frame, const D &q, const F &inverse) {
  return narrow(q * D(frame.scale)) * inverse;
}

// Ends the ray at t.
LANCER_LANE void end_slab(Slab &s, double t) { s.tau_max = round_up(box_tau_above(s, s.scale, t)); }

LANCER_LANE void make_slab(const PlacementFrame &frame, const MeshRay &ray, double tmin, double tmax, Slab &slab) {
  slab.octant = 0;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    slab.inverse[axis] = inverse_component(ray.d[axis]);
    slab.shift[axis] = slab_shift(frame, ray.q[axis], slab.inverse[axis]);
    slab.octant |= uint32_t{slab.inverse[axis] < 0.0f} << axis;
  }
  slab.t0 = ray.t0;
  slab.inverse_unit = ray.inverse_unit;
  slab.scale = frame.scale;
  slab.tau_min = round_down(box_tau_below(slab, frame.scale, tmin));
  end_slab(slab, tmax);
}

LANCER_LANE void push(Flight &s, float entry, uint32_t child) {
  s.entries[s.size] = entry;
  s.children[s.size] = child;
  ++s.size;
}

// Pops the top of the stack and prefetches its data.
LANCER_LANE void go_on(Flight &s) {
  const uint32_t child = s.children[--s.size];
  s.kind = child >> kBvhKindShift;
  s.at = s.arrays[s.kind] + size_t{child & kBvhPlace} * kBvhStep;
  for (int offset = 0; offset < 256; offset += 64)
    __builtin_prefetch(s.at + offset);
}

// Drops entries behind the best hit.
LANCER_LANE void shorten(Flight &s) {
  end_slab(s.slab, s.best.t);
  uint32_t kept = s.base;
  for (uint32_t i = s.base; i < s.size; i += 8)
    kept += keep_below(s.entries + kept, s.children + kept, s.entries + i, s.children + i, s.size - i, s.slab.tau_max);
  s.size = kept;
}

} // namespace
} // namespace lancer
