// Building a light tree from the top: each cluster is cut where the surface area orientation heuristic likes it best.
#include "lights/light_tree.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

constexpr int kBuckets = 12;
// The least energy of a light relative to the brightest: below lies what no float sum would notice.
constexpr double kLeastEnergy = 0x1p-60;

struct Cut {
  int axis = -1; // none: keep the order
  uint32_t middle = 0;
  double cost = std::numeric_limits<double>::infinity();
};

// What lights are sorted by.
glm::dvec3 place(const DescribedLight &light) { return light.light.centre; }

// The cheapest cut along one axis between twelve equal slices of the lights' centres.
void try_axis(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, int axis, double low, double extent,
              double regularization, Cut &best) {
  LightBounds slices[kBuckets];
  uint32_t counts[kBuckets] = {};
  for (uint32_t i = begin; i < end; ++i) {
    const int slice = std::clamp(int(kBuckets * ((place(lights[i])[axis] - low) / extent)), 0, kBuckets - 1);
    slices[slice].add(lights[i].bounds);
    ++counts[slice];
  }
  // Collect from the right, then go along from the left.
  double right[kBuckets];
  LightBounds sum;
  for (int slice = kBuckets - 1; slice > 0; --slice) {
    sum.add(slices[slice]);
    right[slice] = sum.cost();
  }
  sum = {};
  uint32_t count = 0;
  for (int slice = 0; slice + 1 < kBuckets; ++slice) {
    sum.add(slices[slice]);
    count += counts[slice];
    const double cost = regularization * (sum.cost() + right[slice + 1]);
    if (cost < best.cost && count > 0 && begin + count < end)
      best = {axis, begin + count, cost};
  }
}

} // namespace

LightTree::LightTree(std::vector<DescribedLight> lights, uint32_t count) : place_of_(count, kNone) {
  std::erase_if(lights, [](const DescribedLight &light) { return !(light.bounds.energy > 0.0); });
  if (lights.empty())
    return;
  // Energies relative to the brightest, by a power of two: the same tree at any scale.
  double brightest = 0.0;
  for (const DescribedLight &light : lights) {
    brightest = std::max(brightest, light.bounds.energy);
    bounds_.add(light.bounds);
  }
  const int exponent = -std::ilogb(brightest);
  for (DescribedLight &light : lights) {
    light.bounds.energy = std::max(std::ldexp(light.bounds.energy, exponent), kLeastEnergy);
    light.light.energy = float(light.bounds.energy);
  }
  // What is near goes to the left of the root, what is distant to the right.
  const auto far = [](const DescribedLight &light) {
    return light.light.kind == TreeLight::Kind::Sun || light.light.kind == TreeLight::Kind::Sky;
  };
  const auto split_at = std::stable_partition(lights.begin(), lights.end(), [&](const auto &light) { return !far(light); });
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

void LightTree::split(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting) {
  const uint32_t count = part.end - part.begin;
  LightBounds whole;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (uint32_t i = part.begin; i < part.end; ++i) {
    whole.add(lights[i].bounds);
    low = glm::min(low, place(lights[i]));
    high = glm::max(high, place(lights[i]));
  }
  nodes_[part.node].shape = cluster_shape(whole);
  nodes_[part.node].distant = part.distant;
  // Look for a cut that costs less than a leaf.
  Cut cut{-1, part.begin + count / 2, whole.cost()};
  const glm::dvec3 extent = high - low;
  const double widest = std::max({extent.x, extent.y, extent.z});
  if (count > 1 && !part.distant)
    for (int axis = 0; axis < 3; ++axis)
      if (extent[axis] > 0.0)
        try_axis(lights, part.begin, part.end, axis, low[axis], extent[axis], widest / extent[axis], cut);
  Node &node = nodes_[part.node];
  if (cut.axis < 0 && count <= kLeafLights) {
    node.first = part.begin;
    node.count = count;
    for (uint32_t i = part.begin; i < part.end; ++i)
      node_of_[i] = part.node;
    return;
  }
  // Part the lights there; ties go by number, so that every machine builds the same tree.
  if (cut.axis >= 0)
    std::nth_element(lights.begin() + part.begin, lights.begin() + cut.middle, lights.begin() + part.end,
                     [axis = cut.axis](const DescribedLight &a, const DescribedLight &b) {
                       const double x = place(a)[axis], y = place(b)[axis];
                       return x < y || (x == y && a.light.number < b.light.number);
                     });
  const uint32_t children = uint32_t(nodes_.size());
  node.first = children;
  node.count = 0;
  parent_.push_back(part.node);
  nodes_.resize(nodes_.size() + 2);
  waiting.push_back({children + 1, cut.middle, part.end, part.distant});
  waiting.push_back({children, part.begin, cut.middle, part.distant});
}

} // namespace lancer
