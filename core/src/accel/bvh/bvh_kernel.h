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
  // The same of the hits that count.
  void (*closest_filtered)(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count, const HitFilter &filter);
  void (*any_filtered)(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count, const HitFilter &filter);
  // Adds up the work of the one or the other, where each ray goes alone.
  void (*count)(const BvhScene &scene, const Ray *rays, size_t count, bool any, TraversalCounts &counts);
};

// Each is the same source, bvh_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(BvhKernel, bvh_kernel)

// What a split of the builder does with each box, one copy per instruction set. A build takes a tenth less time than without.

inline constexpr uint32_t kMaxBins = 16;

// Maps centroids to bins, the same way in every pass. Lane 3 of the origin is 1 and of the scale 0: a compiler that sees that
// nobody asks for lane 3 lets numbers through there, which are denormal as floats, and a product of them takes as long as all
// of a box's other work.
struct Binning {
  Float4 origin, scale;
};

// Unset until binned: only as many as are used.
struct Bins {
  alignas(64) GrowingBox boxes[kMaxBins][3]; // bin, axis
  alignas(16) uint32_t counts[kMaxBins][4];
};

struct SplitKernel {
  // Sorts boxes into the first bins along all three axes.
  void (*bin)(const BuildRef *refs, uint32_t count, const Binning &binning, uint32_t used, Bins &bins);
  // By axis: moves boxes from refs[begin] to refs[end] to the places from left on where their bin is below the given one, else
  // from right on; and gives the boxes of both sides' centroids.
  void (*move[3])(const BuildRef *refs, uint32_t begin, uint32_t end, const Binning &binning, int32_t bin, BuildRef *to,
                  uint32_t left, uint32_t right, GrowingBox centroids[2]);
};

// Each is the same source, split_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(SplitKernel, split_kernel)

} // namespace lancer
