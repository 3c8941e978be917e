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

double LightTree::probability(const LightQuery &query, uint32_t number) const {
  if (number >= place_of_.size() || place_of_[number] == kNone)
    return 0.0;
  return kernel_->probability(tree(), walk(query, 0.0), place_of_[number]);
}

} // namespace lancer
