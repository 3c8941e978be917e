#include "accel/bvh_build.h"

#include "accel/parallel.h"
#include "accel/placed_scene.h"

#include <array>
#include <new>

namespace lancer {
namespace {

constexpr uint32_t kBins = 16;
// An owner that is an instance by itself, not a triangle's.
constexpr uint32_t kWholeInstance = 0xffffffffu;
// The owner of all spheres; their numbers are those of instances.
constexpr uint32_t kSpheres = 0xfffffffeu;

struct Range {
  uint32_t begin = 0, end = 0;
  Box box, centroids;

  uint32_t count() const { return end - begin; }
  void add(const BuildRef &ref) {
    box.grow(ref.box);
    centroids.grow(ref.box.centroid());
  }
};

struct Split {
  float cost = Box::kInf;
  int axis = -1;
  uint32_t bin = 0; // the first bin of the right side
};

// Maps centroids to bins, the same way in every pass.
struct Binning {
  Float4 origin, scale;

  explicit Binning(const Box &centroids) : origin(centroids.lo), scale{} {
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = centroids.hi[axis] - centroids.lo[axis];
      const float s = static_cast<float>(kBins) * 0.999999f / extent;
      scale[axis] = s < Box::kInf ? s : 0.0f;
    }
  }
  Int4 bins(const Box &box) const {
    const Float4 position = (box.centroid() - origin) * scale;
    return __builtin_convertvector(position, Int4);
  }
};

// A subtree that is left for the threads: its place in the tree above it, and its range.
struct Task {
  uint32_t node, slot, depth;
  Range range;
  HugeVector<BvhNode> nodes;
};

class Builder {
public:
  Builder(HugeVector<BuildRef> &r, uint32_t g, const BuildContext &c) : refs(r), group(g), context(c) {}

  // Appends the subtree of range to nodes; ranges of at most task_size are left to tasks, where given.
  uint32_t build(const Range &range, uint32_t depth, HugeVector<BvhNode> &nodes, uint32_t task_size, std::vector<Task> *tasks) {
    poll_cancel(context);

    // Split the largest part until there are eight, or nothing is left to split.
    std::array<Range, kBvhWidth> parts;
    uint32_t part_count = 1;
    parts[0] = range;
    const bool by_count = depth >= kBvhSahDepth;
    while (part_count < kBvhWidth) {
      uint32_t largest = kBvhWidth;
      float size = -1.0f;
      for (uint32_t i = 0; i < part_count; ++i) {
        const float part_size = by_count ? static_cast<float>(parts[i].count()) : parts[i].box.half_area();
        if (!is_leaf(parts[i]) && part_size > size) {
          largest = i;
          size = part_size;
        }
      }
      if (largest == kBvhWidth)
        break;
      split(parts[largest], by_count, parts[largest], parts[part_count]);
      ++part_count;
    }

    // Write the node, then its children after it.
    const uint32_t self = static_cast<uint32_t>(nodes.size());
    nodes.emplace_back();
    for (uint32_t i = 0; i < kBvhWidth; ++i) {
      const Box box = i < part_count ? parts[i].box : Box{};
      for (int axis = 0; axis < 3; ++axis) {
        nodes[self].bounds[axis][0][i] = box.lo[axis];
        nodes[self].bounds[axis][1][i] = box.hi[axis];
      }
      nodes[self].child[i] = kBuildEmpty;
    }
    set_order(parts, part_count, nodes[self]);
    for (uint32_t i = 0; i < part_count; ++i) {
      const Range &part = parts[i];
      if (is_leaf(part))
        nodes[self].child[i] = kBuildLeaf | part.begin << 2 | (part.count() - 1);
      else if (tasks && part.count() <= task_size)
        tasks->push_back({self, i, depth + 1, part, {}});
      else {
        const uint32_t child = build(part, depth + 1, nodes, task_size, tasks);
        nodes[self].child[i] = child;
      }
    }
    return self;
  }

private:
  bool is_leaf(const Range &range) const {
    if (range.count() > group)
      return false;
    for (uint32_t i = range.begin + 1; i < range.end; ++i)
      if (refs[i].owner() != refs[range.begin].owner() || refs[i].owner() == kWholeInstance)
        return false;
    return true;
  }

  // Sorts the children from far to near along the diagonal of every octant.
  static void set_order(const std::array<Range, kBvhWidth> &parts, uint32_t count, BvhNode &node) {
    Float4 middles[kBvhWidth];
    for (uint32_t i = 0; i < count; ++i)
      middles[i] = parts[i].box.centroid();
    for (uint32_t octant = 0; octant < 8; ++octant) {
      float place[kBvhWidth];
      uint32_t lanes[kBvhWidth];
      for (uint32_t i = 0; i < kBvhWidth; ++i) {
        lanes[i] = i;
        place[i] = -Box::kInf;
        if (i < count)
          place[i] = (octant & 1 ? -middles[i][0] : middles[i][0]) + (octant & 2 ? -middles[i][1] : middles[i][1]) +
                     (octant & 4 ? -middles[i][2] : middles[i][2]);
      }
      for (uint32_t i = 1; i < count; ++i) {
        const uint32_t lane = lanes[i];
        uint32_t k = i;
        for (; k > 0 && place[lanes[k - 1]] < place[lane]; --k)
          lanes[k] = lanes[k - 1];
        lanes[k] = lane;
      }
      node.order[octant] = 0;
      for (uint32_t i = 0; i < kBvhWidth; ++i)
        node.order[octant] |= lanes[i] << 3 * i;
    }
  }

  Split find_split(const Range &range) const {
    // Sort the primitives into bins along all three axes.
    const Binning binning(range.centroids);
    Box boxes[3][kBins];
    uint32_t counts[3][kBins] = {};
    for (uint32_t i = range.begin; i < range.end; ++i) {
      const Box &box = refs[i].box;
      const Int4 bin = binning.bins(box);
      for (int axis = 0; axis < 3; ++axis) {
        boxes[axis][bin[axis]].grow(box);
        ++counts[axis][bin[axis]];
      }
    }

    // Sweep the planes between the bins from both sides.
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      float right_cost[kBins];
      Box right;
      uint32_t right_count = 0;
      for (uint32_t bin = kBins - 1; bin > 0; --bin) {
        right.grow(boxes[axis][bin]);
        right_count += counts[axis][bin];
        right_cost[bin] = right_count ? right.half_area() * tests(right_count) : Box::kInf;
      }
      Box left;
      uint32_t left_count = 0;
      for (uint32_t bin = 1; bin < kBins; ++bin) {
        left.grow(boxes[axis][bin - 1]);
        left_count += counts[axis][bin - 1];
        const float cost = left_count ? left.half_area() * tests(left_count) + right_cost[bin] : Box::kInf;
        if (cost < best.cost)
          best = {cost, axis, bin};
      }
    }
    return best;
  }

  float tests(uint32_t count) const { return static_cast<float>((count + group - 1) / group); }

  // left may be range itself.
  void split(const Range range, bool by_count, Range &left, Range &right) {
    Range sides[2];
    uint32_t middle = range.begin;
    const Split best = by_count ? Split{} : find_split(range);
    if (best.axis >= 0) {
      // Partition by bin, finding the boxes of both sides on the way.
      const Binning binning(range.centroids);
      uint32_t end = range.end;
      while (middle < end) {
        if (binning.bins(refs[middle].box)[best.axis] < static_cast<int32_t>(best.bin)) {
          sides[0].add(refs[middle++]);
        } else {
          sides[1].add(refs[middle]);
          std::swap(refs[middle], refs[--end]);
        }
      }
    } else {
      // All centroids coincide, or the tree is too deep: halve by count along the widest axis.
      const Float4 extent = range.centroids.hi - range.centroids.lo;
      const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : (extent[1] >= extent[2] ? 1 : 2);
      middle = range.begin + range.count() / 2;
      std::nth_element(refs.begin() + range.begin, refs.begin() + middle, refs.begin() + range.end,
                       [axis](const BuildRef &a, const BuildRef &b) {
                         const float x = a.box.centroid()[axis], y = b.box.centroid()[axis];
                         return x != y ? x < y : a.id() < b.id();
                       });
      for (uint32_t i = range.begin; i < range.end; ++i)
        sides[i >= middle].add(refs[i]);
    }
    sides[0].begin = range.begin;
    sides[0].end = sides[1].begin = middle;
    sides[1].end = range.end;
    left = sides[0];
    right = sides[1];
  }

  HugeVector<BuildRef> &refs;
  const uint32_t group;
  const BuildContext &context;
};

} // namespace

WideTree build_wide_tree(HugeVector<BuildRef> refs, uint32_t group, const BuildContext &context) {
  WideTree tree;
  if (refs.empty())
    return tree;
  if (refs.size() > kBuildLeaf >> 2)
    throw std::bad_alloc(); // more than a leaf's 29 bits can address
  const uint32_t count = static_cast<uint32_t>(refs.size());
  Range all;
  all.end = count;
  for (const BuildRef &ref : refs)
    all.add(ref);

  // Build the top, then the subtrees on all threads. Where the top ends depends on the size alone.
  Builder builder(refs, group, context);
  std::vector<Task> tasks;
  const uint32_t task_size = std::max(count / 64, 4096u);
  builder.build(all, 0, tree.nodes, task_size, &tasks);
  parallel_for(context, tasks.size(), [&](size_t i) {
    Task &task = tasks[i];
    task.nodes.reserve(task.range.count() / 12 + 8);
    builder.build(task.range, task.depth, task.nodes, 0, nullptr);
  });

  tree.refs = std::move(refs);

  // Join the subtrees in the order in which they were met.
  size_t node_count = tree.nodes.size();
  for (const Task &task : tasks)
    node_count += task.nodes.size();
  tree.nodes.reserve(node_count);
  for (Task &task : tasks) {
    const uint32_t offset = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes[task.node].child[task.slot] = offset;
    for (BvhNode &node : task.nodes) {
      for (uint32_t &child : node.child)
        child += child & kBuildLeaf ? 0 : offset;
      tree.nodes.push_back(node);
    }
    task.nodes = {};
  }
  return tree;
}

namespace {

constexpr uint32_t kPiece = 16384;

// What a traversal reads of a child.
uint32_t entry(uint32_t kind, size_t number, uint32_t steps) {
  if (number * steps > kBvhPlace)
    throw std::bad_alloc(); // more than 16 GiB
  return kind << kBvhKindShift | static_cast<uint32_t>(number * steps);
}

SphereBlock sphere_block(const PlacedShape *shapes, const BuildRef *refs, uint32_t count) {
  SphereBlock block;
  for (uint32_t lane = 0; lane < 4; ++lane) {
    const uint32_t instance = refs[lane < count ? lane : 0].id();
    block.instance[lane] = lane < count ? instance : kNone;
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row)
        block.to_object[column][row][lane] = shapes[instance].to_object[column][row];
  }
  return block;
}

// Makes blocks of a finished tree's leaves.
template <class MeshOf>
MeshBvh gather_blocks(WideTree tree, uint32_t kind, bool owned, const MeshOf &mesh_of, const PlacedShape *shapes,
                      const BuildContext &context) {
  // Number the blocks in the order of the nodes that hold them.
  MeshBvh bvh;
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
      const BuildRef &first = tree.refs[leaf >> 2];
      if (first.owner() == kWholeInstance) {
        child = entry(kBvhInstance, first.id(), kBvhSteps<PlacedShape>);
        continue;
      }
      if (first.owner() == kSpheres) {
        child = entry(kBvhSpheres, sphere_leaves.size(), kBvhSteps<SphereBlock>);
        sphere_leaves.push_back(leaf);
        continue;
      }
      child = entry(kind, firsts.size(), kBvhSteps<TriangleBlock>);
      firsts.push_back(leaf);
    }

  // Gather the corners of each block.
  bvh.blocks.resize(firsts.size());
  bvh.owners.resize(owned ? firsts.size() : 0);
  parallel_for(context, (firsts.size() + kPiece - 1) / kPiece, [&](size_t piece) {
    const size_t begin = piece * kPiece;
    for (size_t b = begin; b < std::min(begin + kPiece, firsts.size()); ++b) {
      TriangleBlock &block = bvh.blocks[b];
      const uint32_t first = firsts[b] >> 2, used = (firsts[b] & 3) + 1;
      const Mesh &mesh = mesh_of(tree.refs[first].owner());
      if (owned)
        bvh.owners[b] = tree.refs[first].owner();
      for (uint32_t lane = 0; lane < 4; ++lane) {
        const uint32_t triangle = tree.refs[first + (lane < used ? lane : 0)].id();
        block.primitive[lane] = lane < used ? triangle : kNone;
        for (int corner = 0; corner < 3; ++corner) {
          const glm::vec3 p = mesh.vertex(triangle, lane < used ? corner : 0);
          for (int axis = 0; axis < 3; ++axis)
            block.corner[corner][axis][lane] = p[axis];
        }
      }
    }
  });
  bvh.spheres.resize(sphere_leaves.size());
  for (size_t b = 0; b < sphere_leaves.size(); ++b)
    bvh.spheres[b] = sphere_block(shapes, &tree.refs[sphere_leaves[b] >> 2], (sphere_leaves[b] & 3) + 1);
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

MeshBvh build_mesh_bvh(const Mesh &mesh, const PlacementFrame &frame, const BuildContext &context) {
  const uint32_t count = static_cast<uint32_t>(mesh.triangles.size());
  HugeVector<BuildRef> refs(count);
  add_triangles(
      refs, 0, count, 0, [&](uint32_t i) { return triangle_box(mesh, frame, i); }, context);
  WideTree tree = build_wide_tree(std::move(refs), kBvhLeafSize, context);
  return gather_blocks(
      std::move(tree), kBvhTriangles, false, [&](uint32_t) -> const Mesh & { return mesh; }, nullptr, context);
}

MeshBvh build_world_bvh(const Geometry &geometry, const PlacedScene &placed, const std::vector<uint8_t> &unfolded,
                        const BuildContext &context) {
  const auto mesh_of = [&](uint32_t instance) -> const Mesh & { return geometry.meshes[geometry.instances[instance].mesh]; };
  size_t count = 0;
  for (const uint32_t instance : placed.bounded)
    count += unfolded[instance] ? mesh_of(instance).triangles.size() : 1;
  HugeVector<BuildRef> refs(count);
  size_t filled = 0;
  bool groups = false;
  for (size_t i = 0; i < placed.bounded.size(); ++i) {
    const uint32_t number = placed.bounded[i];
    if (!unfolded[number]) {
      const bool sphere = geometry.instances[number].kind == ShapeKind::Sphere;
      refs[filled++] = BuildRef(placed.boxes[i], number, sphere ? kSpheres : kWholeInstance);
      groups |= sphere;
      continue;
    }
    const Instance &instance = geometry.instances[number];
    const Mesh &mesh = mesh_of(number);
    const uint32_t triangles = static_cast<uint32_t>(mesh.triangles.size());
    const glm::dvec3 reach = placed.mesh_reach[instance.mesh];
    add_triangles(
        refs, filled, triangles, number,
        [&](uint32_t t) { return placed_triangle_box(mesh, instance, reach, placed.world, t); }, context);
    filled += triangles;
    groups = true;
  }
  WideTree tree = build_wide_tree(std::move(refs), groups ? kBvhLeafSize : 1, context);
  return gather_blocks(std::move(tree), kBvhPlaced, true, mesh_of, placed.shapes.data(), context);
}

} // namespace lancer
