#include "lights/light_tree.h"

namespace lancer {

LightWalk LightTree::walk(const LightQuery &query, double u) {
  LightWalk walk;
  for (int axis = 0; axis < 3; ++axis) {
    walk.p[axis] = query.p_float[axis];
    walk.n[axis] = query.n[axis];
  }
  walk.slack = query.slack;
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
