// Halves ranges of boxes where the surface-area heuristic says so, on all threads where they are large.
#pragma once

#include "accel/accelerator.h"
#include "accel/bounds.h"
#include "accel/bvh/split_kernel.h"

namespace lancer {

// An owner that is an instance by itself, not a triangle's.
inline constexpr uint32_t kWholeInstance = 0xffffffffu;
// The owner of all spheres; their numbers are those of instances.
inline constexpr uint32_t kSpheres = 0xfffffffeu;

// Boxes that become a subtree.
struct BuildRange {
  uint32_t begin = 0, end = 0;
  uint32_t buffer = 0; // which of the two holds them
  bool leaf = false;
  Box box, centroids;

  uint32_t count() const { return end - begin; }
};

// Splits move boxes from one buffer to the other, in their order: the result depends on the boxes alone.
class RangeSplitter {
public:
  RangeSplitter(BuildRef *first, BuildRef *second, uint32_t g, const BuildContext &c)
      : buffers{first, second}, group(g), context(c) {}

  // The range of all boxes of the first buffer.
  BuildRange all(uint32_t count) const;
  // Neither side is empty. left may be range itself.
  void split(const BuildRange &range, bool by_count, BuildRange &left, BuildRange &right) const;
  const BuildRef *refs(const BuildRange &range) const { return buffers[range.buffer]; }

private:
  bool is_leaf(const BuildRange &range) const;
  bool split_by_area(const BuildRange &range, BuildRange sides[2]) const;
  void split_by_count(const BuildRange &range, BuildRange sides[2]) const;

  BuildRef *const buffers[2];
  const SplitKernel &kernel = split_kernel();
  const uint32_t group;
  const BuildContext &context;
};

} // namespace lancer
