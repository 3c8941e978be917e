// Builds eight-wide trees over boxes by the surface-area heuristic: ranges of boxes are split in two, parts become nodes, and
// the primitives of a leaf are gathered in blocks.
#pragma once

#include "accel/accelerator.h"
#include "accel/bounds.h"
#include "accel/bvh/bvh.h"
#include "accel/placed_scene.h"
#include "simd/huge_pages.h"

#include <memory>
#include <vector>

namespace lancer {

// Owner of a box that bounds a whole instance instead of a triangle.
inline constexpr uint32_t kWholeInstance = 0xffffffffu;
// Owner of all spheres; their ids are instance numbers.
inline constexpr uint32_t kSpheres = 0xfffffffeu;

// A range of boxes that becomes a subtree.
struct BuildRange {
  uint32_t begin = 0, end = 0;
  uint32_t buffer = 0; // number of the buffer with the boxes
  bool leaf = false;
  Box box, centroids;

  uint32_t count() const { return end - begin; }
};

// Splits move boxes from one buffer to the other in stable order: the result depends on the boxes alone.
class RangeSplitter {
public:
  RangeSplitter(BuildRef *first, BuildRef *second, uint32_t g, const BuildContext &c)
      : buffers{first, second}, group(g), context(c) {}

  // Returns the range of all boxes of the first buffer.
  BuildRange all(uint32_t count) const;
  // Splits range into two non-empty sides. left may alias range.
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

// Leaves as children of a tree under construction: (first << 2 | count - 1) into leaves.
inline constexpr uint32_t kBuildLeaf = 0x80000000u;
inline constexpr uint32_t kBuildEmpty = 0xffffffffu;

// The part of a BuildRef that a finished leaf keeps.
struct LeafRef {
  uint32_t id, owner;
};

struct WideTree {
  HugeVector<BvhNode> nodes;
  HugeVector<LeafRef> leaves; // leaf after leaf
};

// group: the number of primitives that are tested at the cost of one (1 or kBvhLeafSize). It is also the capacity of a leaf,
// whose primitives all have the same owner. The result depends on refs alone.
WideTree build_wide_tree(HugeVector<BuildRef> refs, uint32_t group, const BuildContext &context);

// A tree whose leaves are blocks of triangles; the world's tree also has blocks of spheres and instances as leaves.
struct MeshBvh {
  HugeVector<BvhNode> nodes;
  HugeVector<BvhMovingNode> moving_nodes; // in place of nodes, where something in the tree moves
  HugeVector<TriangleBlock> blocks;       // of a mesh that changes its shape, key after key
  HugeVector<uint32_t> owners;            // of blocks; empty if all blocks have the same owner
  HugeVector<SphereBlock> spheres;
  uint32_t key_count = 0; // of the mesh

  const void *root() const {
    return !moving_nodes.empty() ? static_cast<const void *>(moving_nodes.data()) : nodes.empty() ? nullptr : nodes.data();
  }
  BvhView view() const { return {root(), blocks.data(), key_count, key_count ? uint32_t(blocks.size() / key_count) : 0}; }
  size_t bytes() const {
    return nodes.capacity() * sizeof(BvhNode) + moving_nodes.capacity() * sizeof(BvhMovingNode) +
           blocks.capacity() * sizeof(TriangleBlock) + owners.capacity() * sizeof(uint32_t) +
           spheres.capacity() * sizeof(SphereBlock);
  }
};

MeshBvh build_mesh_bvh(const MeshView &mesh, const PlacementFrame &frame, const BuildContext &context);

// The largest number of triangles of a mesh that may become part of the world's tree instead of having one of its own.
inline constexpr size_t kMostUnfolded = 256;

// Returns the tree of a mesh, made at the first call. owner: keeps it; may be null.
std::shared_ptr<const MeshBvh> tree_of(const MeshView &mesh, const Mesh *owner, const PlacementFrame &frame,
                                       const BuildContext &context);

// Builds the tree of the world. unfolded: instances whose triangles are part of this tree; all other bounded instances are
// leaves. moves: something in the scene moves, so that nodes are moving ones.
MeshBvh build_world_bvh(const GeometryView &geometry, const PlacedScene &placed, const std::vector<uint8_t> &unfolded,
                        bool moves, const BuildContext &context);

} // namespace lancer
