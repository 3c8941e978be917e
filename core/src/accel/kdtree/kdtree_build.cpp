#include "accel/kdtree/kdtree.h"
#include "sampling/elementary.h"
#include "simd/parallel.h"

#include <cmath>
#include <new>
#include <numbers>

namespace lancer {
namespace {

constexpr size_t kExactSize = 48; // up to this number of items every box face is a candidate
constexpr uint32_t kBins = 32;
constexpr float kEmptyBonus = 0.8f; // factor on the cost of a split that cuts off empty space
constexpr uint32_t kMaxBad = 2; // largest number of consecutive splits that do not lower the cost but may prepare one that does

struct Split {
  float cost = Box::kInf;
  float position = 0.0f;
  int axis = -1;
  size_t below = 0, above = 0;
};

// A cell to build: its node, and the items that overlap it.
struct Cell {
  uint32_t node, depth, bad;
  Box box;
  std::vector<uint32_t> items;
};

struct Subtree {
  Cell root;
  KdTree tree;
};

class Builder {
public:
  Builder(const std::vector<Box> &b, float test, const BuildContext &c)
      : boxes(b), test_cost(test),
        max_depth(static_cast<uint32_t>(8.0 + 1.3 * std::numbers::log2e * log(static_cast<double>(b.size()) + 1.0))),
        context(c) {}

  // Builds the cell into tree; if tasks is given, defers cells of at most task_size items to it.
  void build(Cell cell, KdTree &tree, size_t task_size, std::vector<Subtree> *tasks) const {
    poll_cancel(context);
    if (tasks && cell.items.size() <= task_size) {
      tasks->push_back({std::move(cell), {}});
      return;
    }

    // Make a leaf if no split lowers the expected cost.
    const size_t count = cell.items.size();
    const float leaf_cost = test_cost * static_cast<float>(count);
    const Split split = count > 1 && cell.depth < max_depth ? find_split(cell) : Split{};
    const bool pays = split.cost < leaf_cost;
    const bool may_open = cell.bad < kMaxBad && split.below + split.above < count + count / 2;
    if (split.axis < 0 || !(pays || may_open)) {
      tree.nodes[cell.node].first = static_cast<uint32_t>(tree.items.size());
      tree.nodes[cell.node].bits = static_cast<uint32_t>(count) << 2 | 3;
      tree.items.insert(tree.items.end(), cell.items.begin(), cell.items.end());
      return;
    }

    // Give each child its overlapping items: a box cut by the plane goes to both.
    const uint32_t child = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes.resize(child + 2);
    tree.nodes[cell.node].split = split.position;
    tree.nodes[cell.node].bits = child << 2 | static_cast<uint32_t>(split.axis);
    const uint32_t bad = pays ? 0 : cell.bad + 1;
    Cell below{child, cell.depth + 1, bad, cell.box, {}}, above{child + 1, cell.depth + 1, bad, cell.box, {}};
    below.box.hi[split.axis] = split.position;
    above.box.lo[split.axis] = split.position;
    below.items.reserve(split.below);
    above.items.reserve(split.above);
    for (const uint32_t item : cell.items) {
      if (boxes[item].lo[split.axis] < split.position)
        below.items.push_back(item);
      if (boxes[item].hi[split.axis] > split.position)
        above.items.push_back(item);
    }
    cell.items = {};
    build(std::move(below), tree, task_size, tasks);
    build(std::move(above), tree, task_size, tasks);
  }

private:
  // Evaluates a plane by the surface-area heuristic and keeps it if it is the best so far.
  void weigh(const Cell &cell, int axis, float position, size_t below, size_t above, Split &best) const {
    const size_t count = cell.items.size();
    if (!(cell.box.lo[axis] < position && position < cell.box.hi[axis]) || (below == count && above == count))
      return;
    Box low = cell.box, high = cell.box;
    low.hi[axis] = high.lo[axis] = position;
    const float area = cell.box.half_area();
    const float tests = (low.half_area() * static_cast<float>(below) + high.half_area() * static_cast<float>(above)) / area;
    const float cost = 1.0f + test_cost * tests * (below == 0 || above == 0 ? kEmptyBonus : 1.0f);
    if (cost < best.cost)
      best = {cost, position, axis, below, above};
  }

  Split find_split(const Cell &cell) const {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (cell.items.size() <= kExactSize)
        sweep_faces(cell, axis, best);
      else
        sweep_bins(cell, axis, best);
    }
    return best;
  }

  void sweep_faces(const Cell &cell, int axis, Split &best) const {
    float starts[kExactSize], ends[kExactSize];
    const size_t count = cell.items.size();
    for (size_t i = 0; i < count; ++i) {
      starts[i] = boxes[cell.items[i]].lo[axis];
      ends[i] = boxes[cell.items[i]].hi[axis];
    }
    std::sort(starts, starts + count);
    std::sort(ends, ends + count);

    // Walk both lists in step: below is the number of boxes that start before the plane, above the number that end behind it.
    size_t started = 0, ended = 0;
    while (ended < count) {
      const float position = started < count && starts[started] <= ends[ended] ? starts[started] : ends[ended];
      while (ended < count && ends[ended] <= position)
        ++ended;
      weigh(cell, axis, position, started, count - ended, best);
      while (started < count && starts[started] <= position)
        ++started;
    }
  }

  void sweep_bins(const Cell &cell, int axis, Split &best) const {
    const float lo = cell.box.lo[axis], extent = cell.box.hi[axis] - lo;
    const float scale = static_cast<float>(kBins) / extent;
    if (!(scale < Box::kInf))
      return;
    size_t starts[kBins] = {}, ends[kBins] = {};
    const auto bin = [&](float x) {
      return static_cast<uint32_t>(std::clamp((x - lo) * scale, 0.0f, static_cast<float>(kBins - 1)));
    };
    for (const uint32_t item : cell.items) {
      ++starts[bin(boxes[item].lo[axis])];
      ++ends[bin(boxes[item].hi[axis])];
    }
    size_t below = 0, above = cell.items.size();
    for (uint32_t i = 1; i < kBins; ++i) {
      below += starts[i - 1];
      above -= ends[i - 1];
      weigh(cell, axis, lo + extent * (static_cast<float>(i) / static_cast<float>(kBins)), below, above, best);
    }
  }

  const std::vector<Box> &boxes;
  const float test_cost;
  const uint32_t max_depth;
  const BuildContext &context;
};

// Attaches a finished subtree at its node of tree.
void graft(const Subtree &subtree, KdTree &tree) {
  const uint32_t node_offset = static_cast<uint32_t>(tree.nodes.size()) - 1; // the subtree's root moves into its node
  const uint32_t item_offset = static_cast<uint32_t>(tree.items.size());
  for (size_t i = 0; i < subtree.tree.nodes.size(); ++i) {
    KdNode node = subtree.tree.nodes[i];
    if (node.leaf())
      node.first += item_offset;
    else
      node.bits += node_offset << 2;
    if (i == 0)
      tree.nodes[subtree.root.node] = node;
    else
      tree.nodes.push_back(node);
  }
  tree.items.insert(tree.items.end(), subtree.tree.items.begin(), subtree.tree.items.end());
}

} // namespace

KdTree build_kdtree(const std::vector<Box> &boxes, float test_cost, const BuildContext &context) {
  KdTree tree;
  if (boxes.empty())
    return tree;
  if (boxes.size() >= 1u << 28)
    throw std::bad_alloc(); // a leaf has 30 bits for its count, including split boxes
  Cell root{0, 0, 0, {}, std::vector<uint32_t>(boxes.size())};
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    root.box.grow(boxes[i]);
    root.items[i] = i;
  }
  tree.bounds = root.box;
  tree.nodes.emplace_back();

  // Build the top of the tree, then the subtrees on all threads. The size of the top depends on the number of boxes alone, so
  // the tree does not depend on the threads.
  const Builder builder(boxes, test_cost, context);
  std::vector<Subtree> tasks;
  builder.build(std::move(root), tree, std::max<size_t>(boxes.size() / 64, 1024), &tasks);
  parallel_for(context, tasks.size(), [&](size_t i) {
    Cell cell = std::move(tasks[i].root);
    tasks[i].root.node = cell.node;
    cell.node = 0;
    tasks[i].tree.nodes.emplace_back();
    builder.build(std::move(cell), tasks[i].tree, 0, nullptr);
  });
  for (Subtree &task : tasks) {
    graft(task, tree);
    task.tree = {};
  }
  tree.nodes.shrink_to_fit();
  tree.items.shrink_to_fit();
  return tree;
}

} // namespace lancer
