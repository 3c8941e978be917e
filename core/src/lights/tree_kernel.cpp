// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "lights/tree_kernel.h"

#include "lights/light_tree.h"
#include "lights/light_weights.h"
#include "simd/kernel_choice.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// Descends one level. Returns the child's word; 0 where no light can arrive.
LANCER_LANE uint32_t go_down(const LightBranches &tree, uint32_t number, LightWalk &walk) {
  LightWeights weights;
  weigh_all(tree, number, walk, weights);
  if (weights.able == 0) {
    walk.probability = 0.0;
    return 0;
  }
  // Walk along the cumulative weights; if rounding leaves a rest at the end, the last child with a positive weight is chosen.
  const double target = walk.u * weights.sum;
  alignas(64) double up_to[kChildren];
  uint32_t beyond = 0;
  for (int i = 0; i < kParts; i += 2) {
    const D sums{weights.up_to[i], weights.up_to[i + 1]};
    store(up_to + i * kHalf, sums);
    beyond |= bits(D(target) < sums) << (i * kHalf);
  }
  beyond &= weights.able;
  const int child = beyond ? __builtin_ctz(beyond) : 31 - __builtin_clz(weights.able);
  const double left = child > 0 ? target - up_to[child - 1] : target, most = static_cast<double>(weights.most[child]);
  const double rest = left > 0.0 ? left / most : 0.0;
  walk.u = rest < kBelowOne ? rest : kBelowOne;
  walk.probability *= most / weights.sum;
  return tree.branches[number].child[child];
}

[[gnu::flatten]] void choose(const LightBranches &tree, LightWalk *walks, uint32_t count) {
  // Descend level by level: the step of the next walk starts before the previous walk's step has ended.
  constexpr uint32_t kMost = kBlockLanes;
  for (uint32_t begin = 0; begin < count; begin += kMost) {
    uint32_t at[kMost], open[kMost], open_count = count - begin < kMost ? count - begin : kMost;
    for (uint32_t i = 0; i < open_count; ++i) {
      at[i] = 0;
      open[i] = i;
      walks[begin + i].probability = 1.0;
    }
    while (open_count > 0) {
      uint32_t left = 0;
      for (uint32_t k = 0; k < open_count; ++k) {
        const uint32_t i = open[k], child = go_down(tree, at[i], walks[begin + i]);
        at[i] = walks[begin + i].number = child & LightBranch::kNumber;
        open[left] = i;
        left += !(child & LightBranch::kLight) && child != 0;
      }
      open_count = left;
    }
  }
}

[[gnu::flatten]] double probability(const LightBranches &tree, const LightWalk &walk, uint32_t slot) {
  // Climb from the light to the root.
  double result = 1.0;
  for (; slot != LightBranches::kRoot; slot = tree.slot_of[slot / kBranchWidth]) {
    LightWeights weights;
    weigh_all(tree, slot / kBranchWidth, walk, weights);
    if (!(weights.able >> slot % kBranchWidth & 1))
      return 0.0;
    result *= static_cast<double>(weights.most[slot % kBranchWidth]) / weights.sum;
  }
  return result;
}

// A segment in float, and a bound of the rounding error of its origin.
struct FloatWay {
  F o[3], inverse[3], slack, end;
};

// Bound of the relative error of a box coordinate from the seven roundings of its two distances.
constexpr float kLost = 0x1p-21f;

// A direction component of 0 is replaced by this one: the change that it makes to a position is below the padding of the boxes.
constexpr float kLeastDirection = 0x1p-64f;

LANCER_LANE F inverse_of(F wi) { return F(1.0f) / copysign(max(abs(wi), F(kLeastDirection)), wi); }

// Returns the bits of the children that the segment may hit.
LANCER_LANE uint32_t pass(const LightBranch &branch, const FloatWay &way) {
  uint32_t passed = 0;
  for (int first = 0; first < kChildren; first += kLanes) {
    F begin(0.0f), end = way.end;
    for (int axis = 0; axis < 3; ++axis) {
      const F x = load(branch.centre[axis] + first) - way.o[axis], half = load(branch.half[axis] + first);
      const F wide = half + (F(kLost) * (half + abs(x)) + way.slack);
      const F middle = x * way.inverse[axis], reach = wide * abs(way.inverse[axis]);
      begin = max(begin, middle - reach);
      end = min(end, middle + reach);
    }
    const M may = !equal(load(branch.child + first) & U(LightBranch::kMayBeHit), U(0u));
    passed |= bits((begin <= end) & may) << first;
  }
  return passed;
}

[[gnu::flatten]] void along(const LightBranches &tree, const SegmentBlock &segments, uint32_t count, TreeKernel::Visit visit,
                            void *context) {
  // Round the segments to float.
  alignas(64) float o[3][kBlockLanes], inverse[3][kBlockLanes], slack[kBlockLanes], end[kBlockLanes];
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const D3 d = load3(segments.d, first);
    const V3 from = narrow(load3(segments.from, first)), wi = narrow(d / sqrt(dot(d, d)));
    store3(o, first, from);
    store3(inverse, first, V3{inverse_of(wi.x), inverse_of(wi.y), inverse_of(wi.z)});
    store(slack + first, F(kLost) * (abs(from.x) + abs(from.y) + abs(from.z)));
    store(end + first, narrow(load(segments.end + first)) * F(1.0f + kLost));
  }
  struct Waiting {
    uint32_t number, children;
  };
  Waiting waiting[LightBranches::kDeepest];
  for (uint32_t lane = 0; lane < count; ++lane) {
    const FloatWay way{{F(o[0][lane]), F(o[1][lane]), F(o[2][lane])},
                       {F(inverse[0][lane]), F(inverse[1][lane]), F(inverse[2][lane])},
                       F(slack[lane]),
                       F(end[lane])};
    uint32_t depth = 0;
    Waiting at{0, pass(tree.branches[0], way)};
    for (;;) {
      if (at.children == 0) {
        if (depth == 0)
          break;
        at = waiting[--depth];
      }
      const LightBranch &branch = tree.branches[at.number];
      const uint32_t child = branch.child[__builtin_ctz(at.children)], number = child & LightBranch::kNumber;
      at.children &= at.children - 1;
      if (child & LightBranch::kLight) {
        visit(context, lane, number);
        continue;
      }
      if (at.children != 0)
        waiting[depth++] = at;
      at = {number, pass(tree.branches[number], way)};
    }
  }
}

} // namespace

namespace LANCER_ISA {
const TreeKernel tree_kernel = {LANCER_ISA_NAME, choose, probability, along};
}

} // namespace lancer
