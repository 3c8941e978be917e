// The wide BVH's data, as built and as traversed: plain arrays.
#pragma once

#include "accel/placed_shape.h"

namespace lancer {

inline constexpr uint32_t kBvhWidth = 8;
inline constexpr uint32_t kBvhLeafSize = 4;
// Below this depth nodes are halved by count, so a path is at most kBvhSahDepth + log8(2^32) < 48 nodes long, and each node
// on it leaves at most 7 siblings on the stack.
inline constexpr uint32_t kBvhSahDepth = 36;
inline constexpr uint32_t kBvhStackSize = 7 * 48 + 8;

// child: a node's number; or, with kBvhLeaf set, (first << 2 | count - 1) into the order of primitives, which for triangles
// becomes the number of a block. Unused children have empty boxes.
inline constexpr uint32_t kBvhLeaf = 0x80000000u;

struct alignas(64) BvhNode {
  float bounds[6][kBvhWidth]; // lo x, y, z, hi x, y, z
  uint32_t child[kBvhWidth];
};

// Four triangles, corner by corner. Unused lanes repeat one point, which no ray meets.
struct alignas(32) TriangleBlock {
  float corner[3][3][4]; // corner, axis, lane
  uint32_t primitive[4];
};

struct BvhView {
  const BvhNode *nodes; // the root is the first; null where there is nothing
  const TriangleBlock *blocks;
};

// Everything that a traversal reads.
struct BvhScene {
  PlacementFrame world;
  const PlacedShape *shapes;
  const BvhView *meshes;
  const BvhNode *top;
  const uint32_t *top_order; // leaf entries of top -> instance
  const uint32_t *unbounded;
  uint32_t unbounded_count;
};

} // namespace lancer
