// Choices from the light trees.
#include "lights/light_tree.h"

#include "lights/light_importance.h"
#include "lights/tree_kernel.h"

#include <glm/glm.hpp>

namespace lancer {

namespace {

// Copies a vector to a plain array of a record that kernels read.
template <class T> void copy(const glm::vec<3, T> &from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i)
    to[i] = from[i];
}

LightQueryLanes<float> width_one(const LightQuery &query) {
  return {Vector3<double>(query.p), Vector3<float>(query.n), query.transmits};
}

} // namespace

LightChoice BinaryLightTree::choose(const LightQuery &query, double u) const {
  if (empty())
    return {};
  const LightChoiceLanes<float> choice = choose_light(width_one(query), nodes(), u, true);
  return {choice.number, choice.probability, choice.u};
}

double BinaryLightTree::probability(const LightQuery &query, uint32_t number) const {
  const uint32_t place = place_of(number);
  return place == kNone ? 0.0 : choice_probability(width_one(query), nodes(), place);
}

const TreeKernel &tree_kernel() { return LANCER_CHOSEN_KERNEL(tree_kernel); }

LightWalk LightTree::walk(const LightQuery &query, double u) {
  const LightQueryLanes<float> asked(Vector3<double>(query.p), Vector3<float>(query.n), query.transmits);
  LightWalk walk;
  copy(glm::vec3(asked.p_float), walk.p);
  copy(query.n, walk.n);
  walk.slack = asked.slack;
  walk.transmits = query.transmits;
  walk.u = u;
  return walk;
}

LightChoice LightTree::choose(const LightQuery &query, double u) const {
  if (empty())
    return {};
  LightWalk one = walk(query, u);
  kernel_->choose(tree(), &one, 1);
  return {one.number, one.probability, one.u};
}

double LightTree::probability(const LightQuery &query, uint32_t number) const {
  if (number >= place_of_.size() || place_of_[number] == kNone)
    return 0.0;
  return kernel_->probability(tree(), walk(query, 0.0), place_of_[number]);
}

} // namespace lancer
