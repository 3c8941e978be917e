// The weights of all children of a branch at a point, in lanes: the upper bound of importance() for clusters. A point within a
// cluster's ball is treated as a point on the ball's surface. For kernels only, like simd/lanes.h.
#pragma once

#include "lights/light_importance.h"
#include "lights/tree_kernel.h"
#include "simd/double_register.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

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

} // namespace
} // namespace lancer
