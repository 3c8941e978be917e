// A ray under way in the wide BVH: its box test, what waits on its stack, its best hit.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/bvh.h"
#include "accel/triangle.h"
#include "simd/sorted_lanes.h"

namespace lancer {

// quadric.cpp, compiled once for all.
bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t);

namespace {

// What is asked of a traversal: its variants share one source.
struct Question {
  bool any = false;      // anything answers, not the closest alone
  bool filtered = false; // some hits do not count
  bool counted = false;  // how much work it is
};

// Whether a hit does not count.
template <Question q> LANCER_LANE bool left_out(const HitFilter *filter, size_t number, const Hit &hit) {
  if constexpr (q.filtered)
    return filter->instances[hit.instance] != 0 && !filter->counts(filter->context, number, hit);
  else
    return false;
}

// The next place of a ray on an exact surface, beyond t.
LANCER_LANE bool next_place(const PlacedShape &shape, uint32_t instance, const Ray &ray, double &t) {
  if (t == ray.tmin)
    return intersect_quadric(shape, ray, ray.skip_instance == instance, t);
  Ray rest = ray;
  rest.tmin = t;
  return intersect_quadric(shape, rest, ray.skip_instance == instance, t);
}

// Rays that a thread has under way at once: while one waits for its node or block, the others go on.
constexpr uint32_t kSlots = 32;
constexpr uint32_t kStackSize = 2 * kBvhTreeStack;

// The ray as the float slab test reads it, in a box frame: the parameter of the plane x = b is b * inverse - shift.
struct Slab {
  float inverse[3], shift[3];
  float tau_min, tau_max;
  double t0, inverse_unit, scale; // how tau follows from t, see box_tau_above()
  uint32_t octant;                // bit i: the ray goes down axis i
};

// The ray in the space of an instance, as the triangle test reads it.
struct alignas(32) MeshRay {
  double o[4];
  double shear[4]; // direction over its largest component; then one over that
  double d[4], q[4];
  double t0, unit, inverse_unit;
  RayAxes axes;
};

struct alignas(64) Slot {
  Slab slab;
  const char *arrays[kBvhKinds]; // by kind: what its places are in
  const char *at;                // what comes next
  uint32_t kind;                 // and its kind
  uint32_t size;                 // of the stack
  uint32_t base;                 // where the stack of the tree that the ray is in begins
  uint32_t instance;             // whose ray this is
  uint32_t skip;
  uint32_t unbounded; // how many of the scene's are still to be tried
  uint32_t number;    // of the ray in its batch
  bool usable;        // whether the ray can meet the instance
  double tmin, tmax;
  Hit best;
  MeshRay ray;
  Slab outer;
  float entries[kStackSize + 8];
  uint32_t children[kStackSize + 8];
};

// Rounds outwards: a parameter beyond the float's last digit must not be cut off.
LANCER_LANE float round_up(double x) { return static_cast<float>(x + 0x1p-22 * abs(x)); }
LANCER_LANE float round_down(double x) { return static_cast<float>(x - 0x1p-22 * abs(x)); }

// Directions below 2^-66 of the largest component move a ray by less than 2^-63 of the box frame: kBoxPad covers taking them
// for 2^-66, and no infinity times zero can arise.
LANCER_LANE float inverse_component(double d) {
  const float x = static_cast<float>(d);
  return __builtin_fabsf(x) < 0x1p-66f ? __builtin_copysignf(0x1p66f, x) : 1.0f / x;
}

LANCER_LANE float slab_end(const Slab &s, double t) {
  return round_up(((t - s.t0) + 0x1p-51 * (abs(t) + abs(s.t0))) * s.inverse_unit * s.scale);
}

template <class AnyRay>
LANCER_LANE void make_slab(const PlacementFrame &frame, const AnyRay &ray, double tmin, double tmax, Slab &slab) {
  slab.octant = 0;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const float inverse = inverse_component(ray.d[axis]);
    slab.inverse[axis] = inverse;
    slab.shift[axis] = static_cast<float>(ray.q[axis] * frame.scale) * inverse;
    slab.octant |= uint32_t{inverse < 0.0f} << axis;
  }
  slab.t0 = ray.t0;
  slab.inverse_unit = ray.inverse_unit;
  slab.scale = frame.scale;
  slab.tau_min = round_down(((tmin - ray.t0) - 0x1p-51 * (abs(tmin) + abs(ray.t0))) * ray.inverse_unit * frame.scale);
  slab.tau_max = slab_end(slab, tmax);
}

LANCER_LANE void push(Slot &s, float entry, uint32_t child) {
  s.entries[s.size] = entry;
  s.children[s.size] = child;
  ++s.size;
}

// Takes up what waits on top of the stack, and starts loading it.
LANCER_LANE void go_on(Slot &s) {
  const uint32_t child = s.children[--s.size];
  s.kind = child >> kBvhKindShift;
  s.at = s.arrays[s.kind] + size_t{child & kBvhPlace} * kBvhStep;
  for (int offset = 0; offset < 256; offset += 64)
    __builtin_prefetch(s.at + offset);
}

// Forgets what waits behind the best hit.
LANCER_LANE void shorten(Slot &s) {
  s.slab.tau_max = slab_end(s.slab, s.best.t);
  uint32_t kept = s.base;
  for (uint32_t i = s.base; i < s.size; i += 8)
    kept += keep_below(s.entries + kept, s.children + kept, s.entries + i, s.children + i, s.size - i, s.slab.tau_max);
  s.size = kept;
}

} // namespace
} // namespace lancer
