// Builds eight-wide trees over boxes by the surface-area heuristic.
#pragma once

#include "accel/accelerator.h"
#include "accel/bounds.h"
#include "accel/bvh/bvh.h"
#include "accel/huge_pages.h"

namespace lancer {

// Children of a tree under construction that are no nodes: (first << 2 | count - 1) into leaves.
inline constexpr uint32_t kBuildLeaf = 0x80000000u;
inline constexpr uint32_t kBuildEmpty = 0xffffffffu;

// What is left of a BuildRef once its box has found its place.
struct LeafRef {
  uint32_t id, owner;
};

struct WideTree {
  HugeVector<BvhNode> nodes;
  HugeVector<LeafRef> leaves; // one after the other
};

// group: how many primitives are tested at the price of one (1 or kBvhLeafSize), and the most that a leaf holds; all of one
// owner. The result depends on refs alone.
WideTree build_wide_tree(HugeVector<BuildRef> refs, uint32_t group, const BuildContext &context);

} // namespace lancer
