// A kd-tree over padded boxes: of instances, or of the triangles of a mesh.
#pragma once

#include "accel/accelerator.h"
#include "accel/bounds.h"
#include "accel/placed_shape.h"

#include <vector>

namespace lancer {

// Inner nodes: bits = below << 2 | axis; below is the child below the plane, the child above follows it.
// Leaves: bits = count << 2 | 3; first is their start in items.
struct KdNode {
  union {
    float split;
    uint32_t first;
  };
  uint32_t bits;

  bool leaf() const { return (bits & 3) == 3; }
  uint32_t axis() const { return bits & 3; }
  uint32_t below() const { return bits >> 2; }
  uint32_t count() const { return bits >> 2; }
};

// Depth is at most 8 + 1.3 log2(2^32); each level pushes one cell.
inline constexpr uint32_t kKdStackSize = 64;

struct KdTree {
  std::vector<KdNode> nodes; // root first
  std::vector<uint32_t> items;
  Box bounds;

  size_t bytes() const { return nodes.capacity() * sizeof(KdNode) + items.capacity() * sizeof(uint32_t); }

  // Calls visit(item) for the boxes on the ray, cell by cell from front to back, until it returns true. A box in several cells
  // is visited once per cell. limit(): upper bound, in the boxes' frame, on the parameter of hits that still matter.
  template <class Visit, class Limit>
  void traverse(const ObjectRay &ray, const PlacementFrame &frame, double tau_min, const Limit &limit,
                const Visit &visit) const;
};

template <class Visit, class Limit>
void KdTree::traverse(const ObjectRay &ray, const PlacementFrame &frame, double tau_min, const Limit &limit,
                      const Visit &visit) const {
  struct Cell {
    uint32_t node;
    double entry, exit;
  };
  if (nodes.empty())
    return;

  // Clip the ray to the bounds. The boxes' padding is millions of times the rounding error of these doubles.
  double o[3], inverse[3];
  double entry = tau_min, exit = limit();
  for (int axis = 0; axis < 3; ++axis) {
    o[axis] = ray.q[axis] * frame.scale;
    inverse[axis] = 1.0 / ray.d[axis];
    if (ray.d[axis] == 0.0) {
      if (!(bounds.lo[axis] <= o[axis] && o[axis] <= bounds.hi[axis]))
        return;
      continue;
    }
    const double a = (static_cast<double>(bounds.lo[axis]) - o[axis]) * inverse[axis];
    const double b = (static_cast<double>(bounds.hi[axis]) - o[axis]) * inverse[axis];
    entry = max(a < b ? a : b, entry);
    exit = exit < (a < b ? b : a) ? exit : (a < b ? b : a);
  }
  if (!(entry <= exit))
    return;

  Cell stack[kKdStackSize];
  uint32_t size = 0;
  Cell cell{0, entry, exit};
  for (;;) {
    // Descend to the nearest leaf and push the farther halves.
    const KdNode *node = &nodes[cell.node];
    while (!node->leaf()) {
      const uint32_t axis = node->axis();
      const double distance = static_cast<double>(node->split) - o[axis];
      const double tau = distance * inverse[axis];
      const bool below_first = ray.d[axis] > 0.0 || (ray.d[axis] == 0.0 && distance > 0.0);
      const uint32_t first = node->below() + (below_first ? 0 : 1);
      const uint32_t second = node->below() + (below_first ? 1 : 0);
      if (ray.d[axis] == 0.0 || tau > cell.exit) {
        cell.node = first;
      } else if (tau < cell.entry) {
        cell.node = second;
      } else {
        stack[size++] = {second, tau, cell.exit};
        cell = {first, cell.entry, tau};
      }
      node = &nodes[cell.node];
    }

    for (uint32_t i = 0; i < node->count(); ++i)
      if (visit(items[node->first + i]))
        return;

    // Stop if the best hit is in front of all remaining cells.
    if (size == 0 || limit() < cell.exit)
      return;
    cell = stack[--size];
  }
}

// test_cost: cost of testing an item relative to a traversal step. The result depends on boxes alone.
KdTree build_kdtree(const std::vector<Box> &boxes, float test_cost, const BuildContext &context);

} // namespace lancer
