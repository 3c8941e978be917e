// The wide tree: contents of its leaves, and bits independent of the number of threads that built it.
#include "accel/bvh/bvh_build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace lancer {
namespace {

// Boxes in a slab, denser towards one end; enough for many pieces and tasks. owners: 1 for a tree of one mesh.
HugeVector<BuildRef> many_boxes(uint32_t count, uint32_t owners) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  HugeVector<BuildRef> refs(count);
  for (uint32_t i = 0; i < count; ++i) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    const Float4 middle{x * x * x, y, 0.1f * z, 0.0f}, half{1e-3f, 2e-3f, 1e-3f, 0.0f};
    refs[i] = BuildRef({middle - half, middle + half}, i, i % owners);
  }
  return refs;
}

// Walks a tree, marks the contents of its leaves, and returns the number of nodes visited.
size_t walk(const WideTree &tree, const HugeVector<BuildRef> &refs, uint32_t node, std::vector<uint8_t> &met) {
  size_t nodes = 1;
  for (uint32_t lane = 0; lane < kBvhWidth; ++lane) {
    const uint32_t child = tree.nodes[node].child[lane];
    if (child == kBuildEmpty)
      continue;
    if (!(child & kBuildLeaf)) {
      nodes += walk(tree, refs, child, met);
      continue;
    }
    const uint32_t first = (child & ~kBuildLeaf) >> 2, count = (child & 3) + 1;
    for (uint32_t i = first; i < first + count; ++i) {
      const LeafRef leaf = tree.leaves[i];
      EXPECT_EQ(leaf.owner, tree.leaves[first].owner);
      EXPECT_EQ(leaf.owner, refs[leaf.id].owner());
      ++met[leaf.id];
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(tree.nodes[node].bounds[axis][0][lane], refs[leaf.id].lo[axis]);
        EXPECT_GE(tree.nodes[node].bounds[axis][1][lane], refs[leaf.id].box().hi[axis]);
      }
    }
  }
  return nodes;
}

TEST(WideTree, HoldsEveryBoxOnce) {
  for (const uint32_t owners : {1u, 3u}) {
    const HugeVector<BuildRef> refs = many_boxes(100000, owners);
    const WideTree tree = build_wide_tree(refs, kBvhLeafSize, {.threads = 2});
    std::vector<uint8_t> met(refs.size(), 0);
    EXPECT_EQ(walk(tree, refs, 0, met), tree.nodes.size());
    EXPECT_EQ(std::count(met.begin(), met.end(), 1), static_cast<ptrdiff_t>(refs.size()));
  }
}

TEST(WideTree, AnyNumberOfThreadsGivesTheSameBits) {
  const HugeVector<BuildRef> refs = many_boxes(300000, 1);
  const WideTree one = build_wide_tree(refs, kBvhLeafSize, {.threads = 1});
  for (const uint32_t threads : {2u, 5u}) {
    const WideTree tree = build_wide_tree(refs, kBvhLeafSize, {.threads = threads});
    ASSERT_EQ(tree.nodes.size(), one.nodes.size());
    EXPECT_EQ(std::memcmp(tree.nodes.data(), one.nodes.data(), one.nodes.size() * sizeof(BvhNode)), 0);
    EXPECT_EQ(std::memcmp(tree.leaves.data(), one.leaves.data(), one.leaves.size() * sizeof(LeafRef)), 0);
  }
}

// From far to near along every diagonal: octants with a negative axis have mirrored children.
TEST(WideTree, ChildrenAreOrderedAlongTheDiagonals) {
  const HugeVector<BuildRef> refs = many_boxes(3000, 1);
  const WideTree tree = build_wide_tree(refs, kBvhLeafSize, {.threads = 1});
  for (const BvhNode &node : tree.nodes)
    for (uint32_t octant = 0; octant < 8; ++octant) {
      float last = Box::kInf;
      uint32_t seen = 0;
      for (uint32_t rank = 0; rank < kBvhWidth; ++rank) {
        const uint32_t lane = node.order[octant] >> 3 * rank & 7;
        seen |= 1u << lane;
        if (node.child[lane] == kBuildEmpty)
          continue;
        float place = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
          const float middle = node.bounds[axis][0][lane] + node.bounds[axis][1][lane];
          place += octant >> axis & 1 ? -middle : middle;
        }
        EXPECT_LE(place, last);
        last = place;
      }
      EXPECT_EQ(seen, 255u);
    }
}

} // namespace
} // namespace lancer
