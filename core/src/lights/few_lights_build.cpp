// Building the tree of few lights.
#include "lights/few_lights.h"
#include "lights/light_cut.h"

#include <algorithm>

namespace lancer {

FewLights::FewLights(std::vector<DescribedLight> lights, uint32_t count) : place_of_(count, kNone) {
  prepare(lights);
  if (lights.empty())
    return;
  // What is near goes to the left of the root, what is distant to the right.
  const auto split_at =
      std::stable_partition(lights.begin(), lights.end(), [&](const auto &light) { return !light.distant(); });
  const uint32_t near_count = uint32_t(split_at - lights.begin()), all = uint32_t(lights.size());
  root_ = near_count == 0 ? 1 : near_count == all ? 0 : kNone;
  nodes_.resize(2);
  parent_.push_back(kNone);
  node_of_.resize(all);
  std::vector<Part> waiting;
  if (near_count < all)
    waiting.push_back({1, near_count, all, true});
  if (near_count > 0)
    waiting.push_back({0, 0, near_count, false});
  while (!waiting.empty()) {
    const Part part = waiting.back();
    waiting.pop_back();
    split(part, lights, waiting);
  }
  // Store the lights in the order of the leaves.
  lights_.reserve(all);
  for (uint32_t i = 0; i < all; ++i) {
    lights_.push_back(lights[i].light);
    place_of_[lights[i].light.number] = i;
  }
}

void FewLights::split(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting) {
  const uint32_t count = part.end - part.begin;
  const LightBounds whole = bounds_of(lights, part.begin, part.end);
  nodes_[part.node].shape = cluster_shape(whole);
  nodes_[part.node].distant = part.distant;
  // Look for a cut that costs less than a leaf.
  LightCut cut{-1, part.begin + count / 2};
  if (count > 1 && !part.distant)
    cut = find_cut(lights, part.begin, part.end, whole.cost());
  if (cut.axis < 0 && count <= kLeafLights) {
    nodes_[part.node].first = part.begin;
    nodes_[part.node].count = count;
    for (uint32_t i = part.begin; i < part.end; ++i)
      node_of_[i] = part.node;
    return;
  }
  make_cut(lights, part.begin, part.end, cut);
  const uint32_t children = uint32_t(nodes_.size());
  nodes_[part.node].first = children;
  parent_.push_back(part.node);
  nodes_.resize(nodes_.size() + 2);
  waiting.push_back({children + 1, cut.middle, part.end, part.distant});
  waiting.push_back({children, part.begin, cut.middle, part.distant});
}

} // namespace lancer
