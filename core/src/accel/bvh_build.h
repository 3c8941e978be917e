// Builds eight-wide trees over boxes by the surface-area heuristic.
#pragma once

#include "accel/accelerator.h"
#include "accel/bounds.h"
#include "accel/bvh.h"

#include <vector>

namespace lancer {

struct WideTree {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order; // ids of the refs, leaf after leaf
};

// refs is used up. group: how many primitives are tested at the price of one, and the most that a leaf holds. The result
// depends on refs alone.
WideTree build_wide_tree(std::vector<BuildRef> refs, uint32_t group, const BuildContext &context);

struct MeshBvh {
  std::vector<BvhNode> nodes;
  std::vector<TriangleBlock> blocks;

  BvhView view() const { return {nodes.empty() ? nullptr : nodes.data(), blocks.data()}; }
  size_t bytes() const { return nodes.capacity() * sizeof(BvhNode) + blocks.capacity() * sizeof(TriangleBlock); }
};

MeshBvh build_mesh_bvh(const Mesh &mesh, const PlacementFrame &frame, const BuildContext &context);

} // namespace lancer
