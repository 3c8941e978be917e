// The traversal of the wide BVH, one copy per instruction set.
#pragma once

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

} // namespace lancer
