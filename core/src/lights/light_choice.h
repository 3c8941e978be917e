// Choices in a binary tree of lights for lanes, which descend it together as long as their choices agree. F is a float, or
// lanes of floats.
#pragma once

#include "lights/light_importance.h"
#include "sampling/distribution.h"

namespace lancer {

// The most lights of a leaf.
inline constexpr uint32_t kLeafLights = 8;

// The children of a node are a pair that starts at an even number; a leaf holds consecutive lights.
struct LightNode {
  ClusterShape shape;
  uint32_t first = 0;      // first child, or first light of a leaf
  uint32_t count : 31 = 0; // lights of a leaf; 0: the node has children
  uint32_t distant : 1 = 0;
};

struct LightNodes {
  const LightNode *nodes;
  const TreeLight *lights;
  uint32_t root; // a node, or kNone for the pair of 0 and 1
  // node_of: the leaf that holds a light; parent: the node above a pair of nodes, unused for the first pair.
  const uint32_t *node_of, *parent;
};

// LightChoice of each lane.
template <class F> struct LightChoiceLanes {
  WordOf<F> number;
  DoubleOf<F> probability, u;
};

template <class F>
LANCER_LANE Importance<F> node_importance(const LightQueryLanes<F> &query, const LightNodes &tree, uint32_t number) {
  const LightNode &node = tree.nodes[number];
  if (node.count == 1)
    return importance(query, tree.lights[node.first]);
  return node.distant ? importance_far(query, node.shape) : importance(query, node.shape);
}

// Raises each positive upper bound to at least kRaised / count times the largest one.
template <class F> LANCER_LANE void raise(Importance<F> *parts, uint32_t count) {
  const F zero(0.0f);
  F strongest = zero;
  for (uint32_t i = 0; i < count; ++i)
    strongest = max(strongest, parts[i].most);
  const F least = F(kRaised / static_cast<float>(count)) * strongest;
  for (uint32_t i = 0; i < count; ++i)
    parts[i].most = select(parts[i].most > zero, max(parts[i].most, least), zero);
}

// The shares of several nodes or lights: the average of each one's share of the sum of upper bounds and of the sum of lower
// bounds. Where all lower bounds are 0, all that can contribute get equal shares of that half.
template <class F> struct ImportanceSums {
  using D = DoubleOf<F>;
  D most = D(0.0), least = D(0.0), able = D(0.0);

  LANCER_LANE ImportanceSums(const Importance<F> *parts, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
      most = most + widen(parts[i].most);
      least = least + widen(parts[i].least);
      able = select(parts[i].most > F(0.0f), able + D(1.0), able);
    }
  }
  LANCER_LANE D share(const Importance<F> &part) const {
    const D lower = select(least > D(0.0), widen(part.least) / least, D(1.0) / able);
    return select(part.most > F(0.0f), D(0.5) * (widen(part.most) / most + lower), D(0.0));
  }
};

// Returns the shares of the two nodes of a pair; both are 0 where neither can contribute.
template <class F>
LANCER_LANE Vector2<DoubleOf<F>> pair_shares(const LightQueryLanes<F> &query, const LightNodes &tree, uint32_t pair) {
  using D = DoubleOf<F>;
  Importance<F> parts[2] = {node_importance(query, tree, pair), node_importance(query, tree, pair + 1)};
  raise(parts, 2);
  // Use the upper bounds alone between clusters, but not between near and distant lights (pair 0): the lower bound of a cluster
  // is mostly 0 and would make the shares equal, with five times the variance under 200 lamps.
  if (pair != 0 && (tree.nodes[pair].count != 1 || tree.nodes[pair + 1].count != 1)) {
    const D zero(0.0), left = widen(parts[0].most), right = widen(parts[1].most), sum = left + right;
    return {select(sum > zero, left / sum, zero), select(sum > zero, right / sum, zero)};
  }
  const ImportanceSums<F> sums(parts, 2);
  return {sums.share(parts[0]), sums.share(parts[1])};
}

// Computes the shares of a leaf's lights, of which there must be at least two.
template <class F>
LANCER_LANE void leaf_shares(const LightQueryLanes<F> &query, const LightNodes &tree, const LightNode &node,
                             DoubleOf<F> *shares) {
  Importance<F> parts[kLeafLights];
  for (uint32_t i = 0; i < node.count; ++i)
    parts[i] = importance(query, tree.lights[node.first + i]);
  raise(parts, node.count);
  const ImportanceSums<F> sums(parts, node.count);
  for (uint32_t i = 0; i < node.count; ++i)
    shares[i] = sums.share(parts[i]);
}

// Chooses a light of a leaf in the lanes that have reached it.
template <class F>
LANCER_LANE void choose_of_leaf(const LightQueryLanes<F> &query, const LightNodes &tree, const LightNode &node, MaskOf<F> here,
                                LightChoiceLanes<F> &choice) {
  using D = DoubleOf<F>;
  using M = MaskOf<F>;
  using U = WordOf<F>;
  if (node.count == 1) {
    choice.number = select(here, U(tree.lights[node.first].number), choice.number);
    return;
  }
  D shares[kLeafLights];
  leaf_shares(query, tree, node, shares);
  // Walk along the cumulative shares; if rounding leaves a rest at the end, the last light with a positive share is chosen.
  D probability(0.0), left = choice.u, rest = left;
  M open = here;
  for (uint32_t i = 0; i < node.count; ++i) {
    const M there = open & (shares[i] > D(0.0));
    choice.number = select(there, U(tree.lights[node.first + i].number), choice.number);
    probability = select(there, shares[i], probability);
    rest = select(there, min(left / shares[i], D(kBelowOne)), rest);
    const M last = there & (left < shares[i]), goes_on = there & !last;
    left = select(goes_on, left - shares[i], left);
    open = open & !last;
  }
  choice.probability = select(here, probability * choice.probability, choice.probability);
  choice.u = select(here, rest, choice.u);
}

// u in [0, 1): one random number serves all levels of the tree. lanes: the lanes that choose, at least one; the tree must not
// be empty.
template <class F>
LANCER_LANE LightChoiceLanes<F> choose_light(const LightQueryLanes<F> &query, const LightNodes &tree, DoubleOf<F> u,
                                             MaskOf<F> lanes) {
  using D = DoubleOf<F>;
  using M = MaskOf<F>;
  constexpr uint32_t kPairs = 0xffffffffu;
  struct Waiting {
    uint32_t number;
    M lanes;
  };
  LightChoiceLanes<F> choice{WordOf<F>(0u), D(1.0), u};
  const D zero(0.0);
  // Visit each node at most once, with the lanes that descend to it.
  Waiting waiting[64];
  uint32_t size = 0;
  waiting[size++] = {tree.root, lanes};
  while (size > 0) {
    const Waiting at = waiting[--size];
    if (at.number != kPairs && tree.nodes[at.number].count > 0) {
      choose_of_leaf(query, tree, tree.nodes[at.number], at.lanes, choice);
      continue;
    }
    const uint32_t pair = at.number == kPairs ? 0 : tree.nodes[at.number].first;
    const auto [x, y] = pair_shares(query, tree, pair);
    const M to_right = (y > zero) & !(choice.u < x), some = (x > zero) | to_right;
    const D share = select(to_right, y, x);
    const D rest = min(select(to_right, choice.u - x, choice.u) / share, D(kBelowOne));
    const M going = at.lanes & some, right = going & to_right, left = going & !to_right;
    choice.u = select(going, rest, choice.u);
    choice.probability = select(at.lanes, select(some, choice.probability * share, zero), choice.probability);
    if (any(right))
      waiting[size++] = {pair + 1, right};
    if (any(left))
      waiting[size++] = {pair, left};
  }
  return choice;
}

// Returns the probability with which choose_light() returns the light at this place of the tree.
template <class F>
LANCER_LANE DoubleOf<F> choice_probability(const LightQueryLanes<F> &query, const LightNodes &tree, uint32_t place) {
  using D = DoubleOf<F>;
  // Climb from the light's leaf to the root.
  uint32_t at = tree.node_of[place];
  D probability(1.0);
  if (const LightNode &leaf = tree.nodes[at]; leaf.count > 1) {
    D shares[kLeafLights];
    leaf_shares(query, tree, leaf, shares);
    probability = shares[place - leaf.first];
  }
  while (at != tree.root && any(probability > D(0.0))) {
    const uint32_t pair = at & ~1u;
    const Vector2<D> shares = pair_shares(query, tree, pair);
    probability = probability * (at & 1 ? shares.y : shares.x);
    at = pair == 0 ? tree.root : tree.parent[pair / 2];
  }
  return probability;
}

} // namespace lancer
