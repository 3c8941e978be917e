#include "accel/bvh/bvh_build.h"

#include "simd/parallel.h"

#include <array>
#include <new>

namespace lancer {
namespace {

using Parts = std::array<BuildRange, kBvhWidth>;

// Sorts the children from far to near along the diagonal of every octant.
void set_order(const Parts &parts, uint32_t count, BvhNode &node) {
  Float4 middle[3][2]{}; // axis, half of the children
  for (uint32_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      middle[axis][i / 4][i % 4] = parts[i].box.centroid()[axis];
  for (uint32_t octant = 0; octant < 4; ++octant) {
    // The rank of a child is the number of farther children. Of two children at the same distance, the first counts as farther.
    Float4 place[2];
    Int4 rank[2]{};
    for (int half = 0; half < 2; ++half)
      place[half] = (octant & 1 ? -middle[0][half] : middle[0][half]) + (octant & 2 ? -middle[1][half] : middle[1][half]) +
                    middle[2][half];
    for (uint32_t i = 0; i < count; ++i) {
      const int32_t first = static_cast<int32_t>(i);
      const float p = place[i / 4][i % 4];
      const Float4 other{p, p, p, p};
      const Int4 after[2] = {Int4{0, 1, 2, 3} > first, Int4{4, 5, 6, 7} > first};
      for (int half = 0; half < 2; ++half)
        rank[half] -= (other > place[half]) | ((other == place[half]) & after[half]);
    }
    // The opposite octant has the reverse order.
    uint32_t order = 0, reverse = 0;
    for (uint32_t i = 0; i < kBvhWidth; ++i) {
      const uint32_t r = i < count ? static_cast<uint32_t>(rank[i / 4][i % 4]) : i;
      order |= i << 3 * r;
      reverse |= i << 3 * (i < count ? count - 1 - r : i);
    }
    node.order[octant] = order;
    node.order[7 - octant] = reverse;
  }
}

// A subtree deferred to the threads: its slot in its parent, and its range.
struct Task {
  uint32_t node, slot, depth;
  BuildRange range;
  HugeVector<BvhNode> nodes;
};

class Builder {
public:
  Builder(const RangeSplitter &s, HugeVector<LeafRef> &l, const BuildContext &c) : splitter(s), leaves(l), context(c) {}

  // Appends the subtree of range to nodes; if tasks is given, defers ranges of at most task_size to it.
  uint32_t build(const BuildRange &range, uint32_t depth, HugeVector<BvhNode> &nodes, uint32_t task_size,
                 std::vector<Task> *tasks) const {
    poll_cancel(context);

    // Split the largest part until there are eight parts or only leaves.
    Parts parts;
    uint32_t part_count = 1;
    parts[0] = range;
    const bool by_count = depth >= kBvhSahDepth;
    while (part_count < kBvhWidth) {
      uint32_t largest = kBvhWidth;
      float size = -1.0f;
      for (uint32_t i = 0; i < part_count; ++i) {
        const float part_size = by_count ? static_cast<float>(parts[i].count()) : parts[i].box.half_area();
        if (!parts[i].leaf && part_size > size) {
          largest = i;
          size = part_size;
        }
      }
      if (largest == kBvhWidth)
        break;
      splitter.split(parts[largest], by_count, parts[largest], parts[part_count]);
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
      const BuildRange &part = parts[i];
      if (part.leaf)
        nodes[self].child[i] = write_leaf(part);
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
  uint32_t write_leaf(const BuildRange &range) const {
    const BuildRef *refs = splitter.refs(range);
    for (uint32_t i = range.begin; i < range.end; ++i)
      leaves[i] = {refs[i].id(), refs[i].owner()};
    return kBuildLeaf | range.begin << 2 | (range.count() - 1);
  }

  const RangeSplitter &splitter;
  HugeVector<LeafRef> &leaves;
  const BuildContext &context;
};

// Appends the subtrees in order of creation.
void join(HugeVector<BvhNode> &nodes, std::vector<Task> &tasks, const BuildContext &context) {
  std::vector<uint32_t> offsets;
  size_t count = nodes.size();
  for (const Task &task : tasks) {
    offsets.push_back(static_cast<uint32_t>(count));
    nodes[task.node].child[task.slot] = offsets.back();
    count += task.nodes.size();
  }
  nodes.resize(count);
  parallel_for(context, tasks.size(), [&](size_t i) {
    BvhNode *to = &nodes[offsets[i]];
    for (const BvhNode &node : tasks[i].nodes) {
      *to = node;
      for (uint32_t &child : to->child)
        child += child & kBuildLeaf ? 0 : offsets[i];
      ++to;
    }
    release(tasks[i].nodes);
  });
}

} // namespace

WideTree build_wide_tree(HugeVector<BuildRef> refs, uint32_t group, const BuildContext &context) {
  WideTree tree;
  if (refs.empty())
    return tree;
  if (refs.size() > kBuildLeaf >> 2)
    throw std::bad_alloc(); // exceeds the 29 bits of a leaf
  const uint32_t count = static_cast<uint32_t>(refs.size());
  HugeVector<BuildRef> other(count);
  tree.leaves.resize(count);

  // Build the top of the tree with all threads on each range, then the subtrees in parallel. The size of the top depends on the
  // number of boxes alone, so the tree does not depend on the threads.
  const RangeSplitter splitter(refs.data(), other.data(), group, context);
  std::vector<Task> tasks;
  const uint32_t task_size = std::max(count / 64, 4096u);
  Builder(splitter, tree.leaves, context).build(splitter.all(count), 0, tree.nodes, task_size, &tasks);
  const BuildContext alone{1, context.cancel};
  const RangeSplitter alone_splitter(refs.data(), other.data(), group, alone);
  const Builder builder(alone_splitter, tree.leaves, alone);
  parallel_for(context, tasks.size(), [&](size_t i) {
    Task &task = tasks[i];
    task.nodes.reserve(task.range.count() / 10 + 8);
    builder.build(task.range, task.depth, task.nodes, 0, nullptr);
  });

  release(refs);
  release(other);
  join(tree.nodes, tasks, context);
  return tree;
}

} // namespace lancer
