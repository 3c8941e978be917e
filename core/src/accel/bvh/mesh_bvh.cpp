#include "accel/bvh/moving_nodes.h"

#include "simd/parallel.h"

#include <algorithm>
#include <limits>
#include <new>

namespace lancer {
namespace {

constexpr uint32_t kPiece = 16384;
// Number of blocks by which triangle indices are prefetched ahead; corners are prefetched half as far ahead.
constexpr size_t kAhead = 16;

// Returns the entry of a child for the traversal's stack.
uint32_t entry(uint32_t kind, size_t number, uint32_t steps) {
  if (number * steps > kBvhPlace)
    throw std::bad_alloc(); // more than 16 GiB
  return kind << kBvhKindShift | static_cast<uint32_t>(number * steps);
}

SphereBlock sphere_block(const PlacedShape *shapes, const LeafRef *refs, uint32_t count) {
  SphereBlock block;
  for (uint32_t lane = 0; lane < 4; ++lane) {
    const uint32_t instance = refs[lane < count ? lane : 0].id;
    block.instance[lane] = lane < count ? instance : kNone;
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row)
        block.to_object[column][row][lane] = shapes[instance].to_object[column][row];
  }
  return block;
}

// Returns the block of a leaf at a key.
TriangleBlock key_block(const MeshView &mesh, const LeafRef *leaf, uint32_t used, uint32_t key) {
  TriangleBlock block;
  for (uint32_t lane = 0; lane < 4; ++lane) {
    block.primitive[lane] = lane < used ? leaf[lane].id : kNone;
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 p =
          lane < used ? mesh.key_vertex(leaf[lane].id, corner, key) : glm::vec3(std::numeric_limits<float>::quiet_NaN());
      for (int axis = 0; axis < 3; ++axis)
        block.corner[corner][axis][lane] = p[axis];
    }
  }
  return block;
}

// Converts the leaves of a finished tree to blocks. key_count: of the one mesh that changes its shape.
template <class MeshOf>
MeshBvh gather_blocks(WideTree tree, uint32_t kind, bool owned, const MeshOf &mesh_of, const PlacedShape *shapes,
                      const BuildContext &context, uint32_t key_count = 0) {
  // Number the blocks in the order of their nodes.
  MeshBvh bvh;
  bvh.key_count = key_count;
  std::vector<uint32_t> firsts, sphere_leaves;
  for (BvhNode &node : tree.nodes)
    for (uint32_t &child : node.child) {
      if (child == kBuildEmpty)
        continue;
      if (!(child & kBuildLeaf)) {
        child = entry(kBvhInner, child, kBvhSteps<BvhNode>);
        continue;
      }
      const uint32_t leaf = child & ~kBuildLeaf;
      const LeafRef &first = tree.leaves[leaf >> 2];
      if (first.owner == kWholeInstance) {
        child = entry(kBvhInstance, first.id, kBvhSteps<PlacedShape>);
        continue;
      }
      if (first.owner == kSpheres) {
        child = entry(kBvhSpheres, sphere_leaves.size(), kBvhSteps<SphereBlock>);
        sphere_leaves.push_back(leaf);
        continue;
      }
      child = entry(kind, firsts.size(), kBvhSteps<TriangleBlock>);
      firsts.push_back(leaf);
    }

  // Gather the corners of each block. They are scattered over the mesh: prefetch them some blocks ahead.
  const auto prefetch_block = [&](const LeafRef *leaf, uint32_t last, bool indices) {
    const MeshView &mesh = mesh_of(leaf->owner);
    for (uint32_t lane = 0; lane <= last; ++lane) {
      const glm::uvec3 &triangle = mesh.triangles[leaf[lane].id];
      if (indices)
        __builtin_prefetch(&triangle);
      else
        for (int corner = 0; corner < 3; ++corner)
          __builtin_prefetch(&mesh.positions[triangle[corner]]);
    }
  };
  bvh.blocks.resize(firsts.size() * std::max(key_count, 1u));
  bvh.owners.resize(owned ? firsts.size() : 0);
  parallel_for(context, (firsts.size() + kPiece - 1) / kPiece, [&](size_t piece) {
    const size_t begin = piece * kPiece;
    for (size_t b = begin; b < std::min(begin + kPiece, firsts.size()); ++b) {
      if (b + kAhead < firsts.size())
        prefetch_block(&tree.leaves[firsts[b + kAhead] >> 2], firsts[b + kAhead] & 3, true);
      if (b + kAhead / 2 < firsts.size())
        prefetch_block(&tree.leaves[firsts[b + kAhead / 2] >> 2], firsts[b + kAhead / 2] & 3, false);
      TriangleBlock &block = bvh.blocks[b];
      const uint32_t first = firsts[b] >> 2, used = (firsts[b] & 3) + 1;
      const MeshView &mesh = mesh_of(tree.leaves[first].owner);
      if (owned)
        bvh.owners[b] = tree.leaves[first].owner;
      for (uint32_t lane = 0; lane < 4; ++lane) {
        const uint32_t triangle = lane < used ? tree.leaves[first + lane].id : kNone;
        block.primitive[lane] = triangle;
        for (int corner = 0; corner < 3; ++corner) {
          const glm::vec3 p = lane < used ? mesh.vertex(triangle, corner) : glm::vec3(std::numeric_limits<float>::quiet_NaN());
          for (int axis = 0; axis < 3; ++axis)
            block.corner[corner][axis][lane] = p[axis];
        }
      }
      for (uint32_t key = 0; key < key_count; ++key)
        bvh.blocks[key * firsts.size() + b] = key_block(mesh, &tree.leaves[first], used, key);
    }
  });
  bvh.spheres.resize(sphere_leaves.size());
  for (size_t b = 0; b < sphere_leaves.size(); ++b)
    bvh.spheres[b] = sphere_block(shapes, &tree.leaves[sphere_leaves[b] >> 2], (sphere_leaves[b] & 3) + 1);
  bvh.nodes = std::move(tree.nodes);
  return bvh;
}

// Fills refs[first + i] with box(i), the box of triangle i.
template <class BoxOf>
void add_triangles(HugeVector<BuildRef> &refs, size_t first, uint32_t count, uint32_t owner, const BoxOf &box,
                   const BuildContext &context) {
  parallel_for(context, (count + kPiece - 1) / kPiece, [&](size_t piece) {
    const uint32_t begin = static_cast<uint32_t>(piece) * kPiece;
    for (uint32_t i = begin; i < std::min(begin + kPiece, count); ++i)
      refs[first + i] = BuildRef(box(i), i, owner);
  });
}

} // namespace

MeshBvh build_mesh_bvh(const MeshView &mesh, const PlacementFrame &frame, const BuildContext &context) {
  const uint32_t count = static_cast<uint32_t>(mesh.triangles.size());
  HugeVector<BuildRef> refs(count);
  add_triangles(
      refs, 0, count, 0, [&](uint32_t i) { return triangle_box(mesh, frame, i); }, context);
  WideTree tree = build_wide_tree(std::move(refs), kBvhLeafSize, context);
  MeshBvh bvh = gather_blocks(
      std::move(tree), kBvhTriangles, false, [&](uint32_t) -> const MeshView & { return mesh; }, nullptr, context,
      mesh.key_count);
  if (mesh.key_count == 0)
    return bvh;
  // The tree divides the mesh as it stands in the middle; its boxes hold the triangles at all times.
  const auto box_of = [&](uint32_t child, const Box &) {
    const TriangleBlock &block = bvh.blocks[(child & kBvhPlace) / kBvhSteps<TriangleBlock>];
    MovingBox box;
    for (int lane = 0; lane < 4 && block.primitive[lane] != kNone; ++lane)
      box.grow(moving_triangle_box(mesh, frame, block.primitive[lane]));
    return box;
  };
  MovingNodes(bvh, box_of);
  return bvh;
}

std::shared_ptr<const MeshBvh> tree_of(const MeshView &mesh, const Mesh *owner, const PlacementFrame &frame,
                                       const BuildContext &context) {
  return made_once(owner, &Mesh::tree, [&] {
    count_made(context, &MadeCounts::mesh_trees);
    count_made(context, &MadeCounts::triangles, static_cast<uint32_t>(mesh.triangles.size()));
    return build_mesh_bvh(mesh, frame, context);
  });
}

MeshBvh build_world_bvh(const GeometryView &geometry, const PlacedScene &placed, const std::vector<uint8_t> &unfolded,
                        bool moves, const BuildContext &context) {
  const auto mesh_of = [&](uint32_t instance) -> const MeshView & {
    return geometry.meshes[geometry.instances[instance].mesh];
  };
  size_t count = 0;
  for (const uint32_t instance : placed.bounded)
    count += unfolded[instance] ? mesh_of(instance).triangles.size() : 1;
  HugeVector<BuildRef> refs(count);
  size_t filled = 0;
  bool groups = false;
  std::vector<uint32_t> number_of(placed.moving.empty() ? 0 : geometry.instances.size()); // in placed.moving
  for (size_t i = 0; i < placed.bounded.size(); ++i) {
    const uint32_t number = placed.bounded[i];
    if (!number_of.empty())
      number_of[number] = uint32_t(i);
    if (!unfolded[number]) {
      const Instance &instance = geometry.instances[number];
      const bool sphere = instance.kind == ShapeKind::Sphere && instance.key_count == 0;
      const Box box = placed.moving.empty() ? placed.boxes[i] : placed.moving[i].middle();
      refs[filled++] = BuildRef(box, number, sphere ? kSpheres : kWholeInstance);
      groups |= sphere;
      continue;
    }
    const Instance &instance = geometry.instances[number];
    const MeshView &mesh = mesh_of(number);
    const uint32_t triangles = static_cast<uint32_t>(mesh.triangles.size());
    const PlacedTriangleBoxes boxes(mesh, instance, placed.mesh_reach[instance.mesh], placed.world);
    add_triangles(refs, filled, triangles, number, boxes, context);
    filled += triangles;
    groups = true;
  }
  WideTree tree = build_wide_tree(std::move(refs), groups ? kBvhLeafSize : 1, context);
  MeshBvh bvh = gather_blocks(std::move(tree), kBvhPlaced, true, mesh_of, placed.shapes.data(), context);
  if (!moves)
    return bvh;
  const auto box_of = [&](uint32_t child, const Box &still) {
    if (child >> kBvhKindShift != kBvhInstance || placed.moving.empty())
      return MovingBox{{still, still}};
    return placed.moving[number_of[(child & kBvhPlace) / kBvhSteps<PlacedShape>]];
  };
  MovingNodes(bvh, box_of);
  return bvh;
}

} // namespace lancer
