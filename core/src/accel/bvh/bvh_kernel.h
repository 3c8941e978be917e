// The traversal of the wide BVH, one copy per instruction set.
#pragma once

#include "accel/bounds.h"
#include "accel/bvh/bvh.h"
#include "scene/ray.h"
#include "simd/kernel_choice.h"

#include <cstddef>

namespace lancer {

struct BvhKernel {
  const char *name;
  void (*closest)(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count);
  void (*any)(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count);
  // The same queries over the hits that pass a filter.
  void (*closest_filtered)(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count, HitFilter &filter);
  void (*any_filtered)(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count, HitFilter &filter);
  // Adds the work of either query, with each ray traced alone, to counts.
  void (*count)(const BvhScene &scene, const Ray *rays, size_t count, bool any, TraversalCounts &counts);
};

// Each is bvh_kernel.cpp compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(BvhKernel, bvh_kernel)

// The part of a split that visits every box, one copy per instruction set; the wider registers make a build a tenth faster.

inline constexpr uint32_t kMaxBins = 16;

// Maps centroids to bins, identically in every pass. Lane 3 of the origin is 1 and of the scale 0. Without this, a compiler
// that finds lane 3 unused leaves ids in it. Ids are denormal as floats, and a product with them takes as long as all other
// work on a box.
struct Binning {
  Float4 origin, scale;
};

// Uninitialised; binning sets only the used bins.
struct Bins {
  alignas(64) GrowingBox boxes[kMaxBins][3]; // bin, axis
  alignas(16) uint32_t counts[kMaxBins][4];
};

struct SplitKernel {
  // Sorts boxes into the first `used` bins along all three axes.
  void (*bin)(const BuildRef *refs, uint32_t count, const Binning &binning, uint32_t used, Bins &bins);
  // By axis: moves each of the boxes refs[begin ... end) to the next position from left on if its bin is below the given one,
  // otherwise to the next from right on. Returns the bounds of the centroids of both sides.
  void (*move[3])(const BuildRef *refs, uint32_t begin, uint32_t end, const Binning &binning, int32_t bin, BuildRef *to,
                  uint32_t left, uint32_t right, GrowingBox centroids[2]);
};

// Each is split_kernel.cpp compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(SplitKernel, split_kernel)

} // namespace lancer
