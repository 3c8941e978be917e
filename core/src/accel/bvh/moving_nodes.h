// Nodes whose bounds move: made from a finished tree, from the leaves up.
#pragma once

#include "accel/bvh/bvh_build.h"

namespace lancer {

// Replaces the nodes of a tree by moving ones.
template <class BoxOf> class MovingNodes {
public:
  // box_of(child, still): returns the moving box of a leaf; child: its entry on the traversal's stack; still: its box in the
  // tree.
  MovingNodes(MeshBvh &bvh, const BoxOf &box_of) : bvh_(bvh), box_of_(box_of) {
    if (bvh.nodes.empty())
      return;
    bvh.moving_nodes.resize(bvh.nodes.size());
    make(0);
    release(bvh.nodes);
  }

private:
  // Returns the box of the subtree.
  MovingBox make(size_t number) {
    const BvhNode &node = bvh_.nodes[number];
    BvhMovingNode moving;
    MovingBox all;
    for (uint32_t i = 0; i < kBvhWidth; ++i) {
      moving.child[i] = node.child[i];
      Box still;
      for (int axis = 0; axis < 3; ++axis) {
        still.lo[axis] = node.bounds[axis][0][i];
        still.hi[axis] = node.bounds[axis][1][i];
      }
      MovingBox box{{still, still}};
      // An empty child has an empty box.
      if (still.lo[0] <= still.hi[0]) {
        if (node.child[i] >> kBvhKindShift == kBvhInner) {
          const uint32_t place = node.child[i] / kBvhSteps<BvhNode>;
          moving.child[i] = place * kBvhSteps<BvhMovingNode>;
          box = make(place);
        } else {
          box = box_of_(node.child[i], still);
        }
        all.grow(box);
      }
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          const float from = side ? box.at[0].hi[axis] : box.at[0].lo[axis],
                      to = side ? box.at[1].hi[axis] : box.at[1].lo[axis];
          moving.bounds[axis][side][i] = from;
          moving.way[axis][side][i] = from == to ? 0.0f : to - from;
        }
    }
    std::copy_n(node.order, 8, moving.order);
    bvh_.moving_nodes[number] = moving;
    return all;
  }

  MeshBvh &bvh_;
  const BoxOf &box_of_;
};

} // namespace lancer
