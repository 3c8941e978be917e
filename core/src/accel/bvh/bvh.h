// The wide BVH's data, for build and traversal: plain arrays; and its kernels.
#pragma once

#include "accel/bounds.h"
#include "accel/placed_shape.h"
#include "scene/motion.h"
#include "scene/ray.h"
#include "simd/processor.h"

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

// A node of a tree in which something moves: bounds at time 0, and how far they go until time 1.
struct alignas(64) BvhMovingNode {
  float bounds[3][2][kBvhWidth], way[3][2][kBvhWidth];
  uint32_t child[kBvhWidth];
  uint32_t order[8]; // as in BvhNode
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
  const void *nodes; // BvhNode, or BvhMovingNode where key_count is not 0; root first; null for an empty tree
  const TriangleBlock *blocks;
  uint32_t key_count, block_count; // of a mesh that changes its shape: its blocks at each key, one key after the other
};

// The data that a traversal reads.
struct BvhScene {
  PlacementFrame world;
  const PlacedShape *shapes;
  const BvhView *meshes;
  // The tree of the world: over instances, and over the triangles of unfolded instances (see bvh_accelerator.cpp). For the
  // kernels of scenes in which something moves, of BvhMovingNode.
  const void *top;
  const TriangleBlock *blocks;
  const uint32_t *block_instance;
  const SphereBlock *spheres;
  const uint32_t *unbounded;
  uint32_t unbounded_count;
  const PlacementKey *keys; // of the geometry
};

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
// The same for scenes in which something moves: moving_bvh_kernel.cpp.
LANCER_DECLARE_KERNEL(BvhKernel, moving_bvh_kernel)

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
