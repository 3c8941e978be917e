// Trees whose leaves are blocks of triangles; in the world's also blocks of spheres, and instances.
#pragma once

#include "accel/accelerator.h"
#include "accel/bvh/bvh.h"
#include "accel/huge_pages.h"
#include "accel/placed_scene.h"

#include <vector>

namespace lancer {

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
