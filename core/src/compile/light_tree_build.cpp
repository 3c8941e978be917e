// Builds the tree of many lights and the tree of few lights.
#include "compile/steps.h"
#include "lights/light_bounds.h"
#include "lights/light_importance.h"
#include "lights/light_tree.h"
#include "simd/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lancer {

namespace {

constexpr int kBuckets = 12;
// The least energy of a light relative to the brightest: a float sum would round smaller ones away.
constexpr double kLeastEnergy = 0x1p-60;

// Returns the position by which a light is sorted.
glm::dvec3 place(const DescribedLight &light) { return light.light.centre; }

// Finds the cheapest cut along one axis between twelve equal slices of the lights' centres.
void try_axis(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, int axis, double low, double extent,
              double regularization, LightCut &best) {
  LightBounds slices[kBuckets];
  uint32_t counts[kBuckets] = {};
  for (uint32_t i = begin; i < end; ++i) {
    const int slice = std::clamp(int(kBuckets * ((place(lights[i])[axis] - low) / extent)), 0, kBuckets - 1);
    slices[slice].add(lights[i].bounds);
    ++counts[slice];
  }
  // Sum up the costs from the right, then evaluate the cuts from the left.
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

LightBounds bounds_of(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end) {
  LightBounds whole;
  for (uint32_t i = begin; i < end; ++i)
    whole.add(lights[i].bounds);
  return whole;
}

LightCut find_cut(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, double cost) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (uint32_t i = begin; i < end; ++i) {
    low = glm::min(low, place(lights[i]));
    high = glm::max(high, place(lights[i]));
  }
  LightCut cut{-1, begin + (end - begin) / 2, cost};
  const glm::dvec3 extent = high - low;
  const double widest = std::max({extent.x, extent.y, extent.z});
  for (int axis = 0; axis < 3; ++axis)
    if (extent[axis] > 0.0)
      try_axis(lights, begin, end, axis, low[axis], extent[axis], widest / extent[axis], cut);
  return cut;
}

void make_cut(std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, const LightCut &cut) {
  if (cut.axis < 0)
    return;
  // Ties are broken by number, and each side keeps its order, in which its lights are summed: so every machine builds the same
  // tree.
  const auto key = [&](const DescribedLight &light) { return std::pair(place(light)[cut.axis], light.light.number); };
  std::vector<std::pair<double, uint32_t>> keys;
  for (uint32_t i = begin; i < end; ++i)
    keys.push_back(key(lights[i]));
  const auto middle = keys.begin() + (cut.middle - begin);
  std::nth_element(keys.begin(), middle, keys.end());
  std::stable_partition(lights.begin() + begin, lights.begin() + end,
                        [&, first = *middle](const DescribedLight &light) { return key(light) < first; });
}

LightBounds prepare(std::vector<DescribedLight> &lights) {
  std::erase_if(lights, [](const DescribedLight &light) { return !(light.bounds.energy > 0.0); });
  LightBounds whole;
  double brightest = 0.0;
  for (const DescribedLight &light : lights) {
    brightest = std::max(brightest, light.bounds.energy);
    whole.add(light.bounds);
  }
  const int exponent = lights.empty() ? 0 : -std::ilogb(brightest);
  for (DescribedLight &light : lights) {
    light.bounds.energy = std::max(std::ldexp(light.bounds.energy, exponent), kLeastEnergy);
    light.light.energy = float(light.bounds.energy);
  }
  return whole;
}

namespace {

// Above this number of lights, up to sixteen lights stay together in a branch: nearly empty branches would evict the others
// from the cache.
constexpr uint32_t kCrowd = 2048;

// Whether the light differs between directions.
bool aimed(const ShineCone &cone) { return cone.cos_o > -1.0f || cone.cos_all > -1.0f; }

bool any_aimed(const LightBranch &branch) {
  return std::any_of(std::begin(branch.child), std::end(branch.child),
                     [](uint32_t child) { return child & LightBranch::kAimed; });
}

} // namespace

LightTree::LightTree(std::vector<DescribedLight> lights, uint32_t count, const BuildContext &context)
    : kernel_(&tree_kernel()), place_of_(count, kNone) {
  bounds_ = prepare(lights);
  if (lights.empty())
    return;
  crowded_ = lights.size() > kCrowd;
  std::vector<Part> waiting{{0, uint32_t(lights.size()), LightBranches::kRoot, 0}};
  while (!waiting.empty()) {
    poll_cancel(context);
    const Part part = waiting.back();
    waiting.pop_back();
    add_branch(part, lights, waiting);
  }
  if (std::none_of(branches_.begin(), branches_.end(), any_aimed))
    aims_ = {};
}

void LightTree::add_branch(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting) {
  const uint32_t number = uint32_t(branches_.size()), slot = number * kBranchWidth;
  if (part.slot != LightBranches::kRoot)
    branches_[part.slot / kBranchWidth].child[part.slot % kBranchWidth] |= number;
  // Cut the costliest child in two until there are sixteen children, or none needs a cut.
  const bool deep = part.depth >= LightBranches::kEvenFrom;
  const uint32_t whole = crowded_ && part.end - part.begin > kBranchWidth ? kBranchWidth : 1;
  const auto child_of = [&](uint32_t begin, uint32_t end) {
    Child child{begin, end, bounds_of(lights, begin, end), 0.0};
    // A child with several lights must be cut even if its bounds have no extent.
    if (end - begin > whole)
      child.cost = deep ? double(end - begin) : std::max(child.bounds.cost(), std::numeric_limits<double>::min());
    return child;
  };
  std::vector<Child> children{child_of(part.begin, part.end)};
  while (children.size() < kBranchWidth) {
    const auto costliest =
        std::max_element(children.begin(), children.end(), [](const Child &a, const Child &b) { return a.cost < b.cost; });
    const Child child = *costliest;
    if (!(child.cost > 0.0))
      break;
    LightCut cut = find_cut(lights, child.begin, child.end, std::numeric_limits<double>::infinity());
    if (deep)
      cut.middle = child.begin + (child.end - child.begin) / 2;
    make_cut(lights, child.begin, child.end, cut);
    *costliest = child_of(child.begin, cut.middle);
    children.push_back(child_of(cut.middle, child.end));
  }
  // Write the children into the branch.
  LightBranch branch;
  LightAim aim;
  for (uint32_t i = 0; i < children.size(); ++i) {
    const Child &child = children[i];
    set(child, i, lights, branch, aim);
    if (child.end - child.begin > 1) {
      waiting.push_back({child.begin, child.end, slot + i, part.depth + 1});
      continue;
    }
    const uint32_t light = lights[child.begin].light.number;
    branch.child[i] |= LightBranch::kLight | light;
    place_of_[light] = slot + i;
  }
  branches_.push_back(branch);
  aims_.push_back(aim);
  slot_of_.push_back(part.slot);
}

void LightTree::set(const Child &child, uint32_t i, const std::vector<DescribedLight> &lights, LightBranch &branch,
                    LightAim &aim) {
  const ClusterShape shape = cluster_shape(child.bounds);
  for (int axis = 0; axis < 3; ++axis) {
    branch.centre[axis][i] = shape.centre[axis];
    branch.half[axis][i] = shape.half[axis];
    aim.axis[axis][i] = shape.cone.axis[axis];
  }
  const float r2 = glm::dot(shape.half, shape.half);
  branch.radius[i] = std::sqrt(r2);
  // A point within the ball is treated as on its surface: smaller distances, under emitting blocks, add a tenth to the
  // variance.
  branch.per_near2[i] = 1.0f / std::max(r2, kNearest2);
  branch.energy[i] = shape.energy;
  aim.cos_o[i] = shape.cone.cos_o;
  aim.sin_o[i] = shape.cone.sin_o;
  aim.cos_all[i] = shape.cone.cos_all;
  if (aimed(shape.cone))
    branch.child[i] |= LightBranch::kAimed;
  for (uint32_t k = child.begin; k < child.end; ++k)
    if (lights[k].met)
      branch.child[i] |= LightBranch::kMayBeHit;
}

// Builds the tree of few lights.
BinaryLightTree::BinaryLightTree(std::vector<DescribedLight> lights, uint32_t count) : place_of_(count, kNone) {
  prepare(lights);
  if (lights.empty())
    return;
  // Lights with a position go to the left of the root, distant ones to the right.
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

void BinaryLightTree::split(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting) {
  const uint32_t count = part.end - part.begin;
  const LightBounds whole = bounds_of(lights, part.begin, part.end);
  nodes_[part.node].shape = cluster_shape(whole);
  nodes_[part.node].distant = part.distant;
  // Search for a cut that costs less than a leaf.
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
