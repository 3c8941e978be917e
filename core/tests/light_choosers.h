// Choices of one light for one point, by the two trees of lights.
#pragma once

#include "lights/light_choice.h"
#include "lights/light_tree.h"

namespace lancer {

inline LightChoice choose(const BinaryLightTree &tree, const LightQuery &query, double u) {
  if (tree.empty())
    return {};
  const LightQueryLanes<float> one(Vector3<double>(query.p), Vector3<float>(query.n), query.transmits);
  const LightChoiceLanes<float> choice = choose_light(one, tree.nodes(), u, true);
  return {choice.number, choice.probability, choice.u};
}

inline LightChoice choose(const LightTree &tree, const LightQuery &query, double u) {
  if (tree.empty())
    return {};
  LightWalk one = LightTree::walk(query, u);
  tree.choose({&one, 1});
  return {one.number, one.probability, one.u};
}

} // namespace lancer
