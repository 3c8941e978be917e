// Builds eight-wide trees over boxes by the surface-area heuristic: ranges of boxes are halved, halves become nodes, and what
// leaves hold is gathered in blocks.
#pragma once

#include "accel/accelerator.h"
#include "accel/bounds.h"
#include "accel/bvh/bvh.h"
#include "accel/bvh/bvh_kernel.h"
#include "accel/placed_scene.h"
#include "simd/huge_pages.h"

#include <vector>

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

// A tree whose leaves are blocks of triangles; in the world's also blocks of spheres, and instances.
struct MeshBvh {
  HugeVector<BvhNode> nodes;
  HugeVector<TriangleBlock> blocks;
  HugeVector<uint32_t> owners; // of blocks; empty where all have the same
  HugeVector<SphereBlock> spheres;

  BvhView view() const { return {nodes.empty() ? nullptr : nodes.data(), blocks.data()}; }
  size_t bytes() const {
    return nodes.capacity() * sizeof(BvhNode) + blocks.capacity() * sizeof(TriangleBlock) +
           owners.capacity() * sizeof(uint32_t) + spheres.capacity() * sizeof(SphereBlock);
  }
};

MeshBvh build_mesh_bvh(const Mesh &mesh, const PlacementFrame &frame, const BuildContext &context);

// The tree of the world. unfolded: instances whose triangles are in it themselves; all other bounded instances are leaves.
MeshBvh build_world_bvh(const Geometry &geometry, const PlacedScene &placed, const std::vector<uint8_t> &unfolded,
                        const BuildContext &context);

} // namespace lancer
