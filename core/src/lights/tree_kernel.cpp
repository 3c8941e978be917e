// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "lights/tree_kernel.h"

#include "lights/light_importance.h"
#include "lights/light_tree.h"
#include "simd/double_register.h"
#include "simd/kernel_lanes.h"
#include "simd/processor.h"

namespace lancer {
namespace {

// The weights of all children of a branch at a point: the upper bound of importance() for clusters. A point within a cluster's
// ball is treated as a point on the ball's surface.

constexpr int kChildren = static_cast<int>(kBranchWidth);
// Registers of doubles that hold one number for each child.
using DoubleVector = VectorOf<double, kHalf>;
constexpr int kParts = kChildren / kHalf;

// Returns the weights of kLanes children from the given one on; 0 where no light can arrive.
LANCER_LANE F weigh(const LightBranch &branch, const LightAim *aim, const LightWalk &walk, int first) {
  const F zero(0.0f), one(1.0f), little(kCosineSlack);
  const F n[3] = {F(walk.n[0]), F(walk.n[1]), F(walk.n[2])};
  const F x = load(branch.centre[0] + first) - F(walk.p[0]), y = load(branch.centre[1] + first) - F(walk.p[1]),
          z = load(branch.centre[2] + first) - F(walk.p[2]);
  const F d2 = x * x + y * y + z * z, per_d = one / sqrt(max(d2, F(kNearest2)));
  // Skip boxes that lie entirely below the surface.
  const F reach = abs(n[0]) * load(branch.half[0] + first) + abs(n[1]) * load(branch.half[1] + first) +
                  abs(n[2]) * load(branch.half[2] + first) + F(walk.slack);
  const F along = n[0] * x + n[1] * y + n[2] * z, energy = load(branch.energy + first);
  M kept = energy > zero;
  if (!walk.transmits)
    kept = kept & (along + reach > zero);
  // The half angle that the cluster subtends.
  const F radius = load(branch.radius + first);
  const M outside = d2 > radius * radius;
  const F sin_u = select(outside, radius * per_d, zero), cos_u = select(outside, sine_of(sin_u), F(-1.0f));
  // The smallest angle at which light may arrive.
  const F one_side = along * per_d, cos_i = walk.transmits ? abs(one_side) : one_side;
  const F arrives = reduced(cos_i, sine_of(cos_i), cos_u, sin_u);
  F most = energy * max(arrives, little) * min(per_d * per_d, load(branch.per_near2 + first));
  if (any(!equal(load(branch.child + first) & U(LightBranch::kAimed), U(0u)))) {
    // The smallest angle at which light may leave.
    const F cos_theta =
        -(load(aim->axis[0] + first) * x + load(aim->axis[1] + first) * y + load(aim->axis[2] + first) * z) * per_d;
    const F inner = cos_theta * cos_u + sine_of(cos_theta) * sin_u, cos_o = load(aim->cos_o + first);
    const F turned = inner * cos_o + sine_of(inner) * load(aim->sin_o + first);
    const M within = (cos_theta >= cos_u) | (inner >= cos_o);
    most = most * select(within, one, max(turned, little));
    kept = kept & ((cos_theta >= cos_u) | (inner > load(aim->cos_all + first) - little));
  }
  return select(kept, max(most, F(kLeastImportance)), zero);
}

// Adds to each child's number the number of the child that stands By places before it.
template <int By> LANCER_LANE void add_before(DoubleVector (&of)[kParts]) {
  const DoubleVector none{};
  for (int i = kParts - 1; i >= 0; --i) {
    if constexpr (By < kHalf)
      of[i] = of[i] + shifted_in<By>(i > 0 ? of[i - 1] : none, of[i]);
    else if (i >= By / kHalf)
      of[i] = of[i] + of[i - By / kHalf];
  }
}

// Returns the largest of the children's numbers; none may be negative.
LANCER_LANE float largest(const float (&of)[kChildren]) {
  using Four [[gnu::vector_size(16), gnu::may_alias]] = float;
  const Four *const parts = reinterpret_cast<const Four *>(of);
  Four most = parts[0];
  for (int i = 1; i < kChildren / 4; ++i)
    most = most > parts[i] ? most : parts[i];
  const Four turned = __builtin_shufflevector(most, most, 2, 3, 0, 1);
  most = most > turned ? most : turned;
  return most[0] > most[1] ? most[0] : most[1];
}

struct LightWeights {
  alignas(64) float most[kChildren];
  // Prefix sums of the weights: the same in every instruction set.
  DoubleVector up_to[kParts];
  uint32_t able = 0; // bits of the children with a positive weight
  double sum = 0.0;
};

LANCER_LANE void weigh_all(const LightBranches &tree, uint32_t number, const LightWalk &walk, LightWeights &weights) {
  const LightBranch &branch = tree.branches[number];
  const LightAim *aim = tree.aims + (tree.aims ? number : 0);
  for (int first = 0; first < kChildren; first += kLanes)
    store(weights.most + first, weigh(branch, aim, walk, first));
  const F zero(0.0f), least(kRaised / static_cast<float>(kChildren) * largest(weights.most));
  for (int first = 0; first < kChildren; first += kLanes) {
    const F bound = load(weights.most + first);
    const M able = bound > zero;
    const F most = select(able, max(bound, least), zero);
    store(weights.most + first, most);
    weights.able |= bits(able) << first;
    const D wide = widen(most);
    weights.up_to[first / kHalf] = wide.lo;
    weights.up_to[first / kHalf + 1] = wide.hi;
  }
  add_before<1>(weights.up_to);
  add_before<2>(weights.up_to);
  add_before<4>(weights.up_to);
  add_before<8>(weights.up_to);
  weights.sum = weights.up_to[kParts - 1][kHalf - 1];
}

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

[[gnu::flatten]] void along(const LightBranches &tree, const SegmentBlock &segments, uint32_t count, LightVisitor &visitor) {
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
        visitor.visit(lane, number);
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
