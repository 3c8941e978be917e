// The wide BVH's data, for build and traversal: plain arrays.
#pragma once

#include "accel/placed_shape.h"

#include <cstddef>

namespace lancer {

inline constexpr uint32_t kBvhWidth = 8;
inline constexpr uint32_t kBvhLeafSize = 4;
// Below this depth, nodes are halved by count. So a path from the root is at most kBvhSahDepth + log8(2^32) < 48 nodes long,
// and each of its nodes leaves at most 7 siblings on the stack.
inline constexpr uint32_t kBvhSahDepth = 36;
inline constexpr uint32_t kBvhTreeStack = 7 * 48 + 8;

// Kinds of entries on a ray's stack. The upper three bits of an entry are its kind; the others are the offset into the kind's
// array, in steps of kBvhStep bytes.
enum BvhKind : uint32_t {
  kBvhInner = 0,     // a node of the current tree
  kBvhTriangles = 1, // a block of the current mesh
  kBvhPlaced = 2,    // a block of BvhScene::blocks
  kBvhInstance = 3,  // an instance
  kBvhLeave = 4,     // the end of the instance's tree
  kBvhUnbounded = 5, // the unbounded instances
  kBvhSpheres = 6,   // a block of BvhScene::spheres
  kBvhDone = 7,      // the end of the traversal
};
inline constexpr uint32_t kBvhKinds = 8;
inline constexpr uint32_t kBvhKindShift = 29;
inline constexpr uint32_t kBvhPlace = (1u << kBvhKindShift) - 1;
inline constexpr size_t kBvhStep = 32;
template <class T> inline constexpr uint32_t kBvhSteps = sizeof(T) / kBvhStep;

// Unused children have empty boxes.
struct alignas(64) BvhNode {
  float bounds[3][2][kBvhWidth]; // axis; low, high; child
  uint32_t child[kBvhWidth];
  // Children from far to near for a ray whose direction is negative along the axes of the set bits: three bits each.
  uint32_t order[8];
};

// Four triangles, corner by corner. Unused lanes are NaN, which no ray hits.
struct alignas(32) TriangleBlock {
  float corner[3][3][4]; // corner, axis, lane
  uint32_t primitive[4];
};

// Four spheres: their maps to unit spheres. Unused lanes have instance kNone and are never hit.
struct alignas(32) SphereBlock {
  double to_object[4][3][4]; // column, row, lane
  uint32_t instance[4];
};

struct BvhView {
  const BvhNode *nodes; // root first; null for an empty tree
  const TriangleBlock *blocks;
};

// The data that a traversal reads.
struct BvhScene {
  PlacementFrame world;
  const PlacedShape *shapes;
  const BvhView *meshes;
  // The tree of the world: over instances, and over the triangles of unfolded instances (see bvh_accelerator.cpp).
  const BvhNode *top;
  const TriangleBlock *blocks;
  const uint32_t *block_instance;
  const SphereBlock *spheres;
  const uint32_t *unbounded;
  uint32_t unbounded_count;
};

} // namespace lancer
