#include "accel/parallel.h"
#include "lights/light_cut.h"
#include "lights/light_importance.h"
#include "lights/light_tree.h"

#include <algorithm>

namespace lancer {

namespace {

// Lights so many that branches which are nearly empty would leave the cache for the others too small.
constexpr uint32_t kCrowd = 2048;

// Light does not leave to all sides alike.
bool aimed(const ShineCone &cone) { return cone.cos_o > -1.0f || cone.cos_all > -1.0f; }

bool any_aimed(const LightBranch &branch) {
  return std::any_of(std::begin(branch.child), std::end(branch.child),
                     [](uint32_t child) { return child & LightBranch::kAimed; });
}

} // namespace

LightTree::LightTree(std::vector<DescribedLight> lights, uint32_t count, const BuildContext &context)
    : kernel_(&light_kernel()), place_of_(count, kNone) {
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
  // Cut the costliest child in two until there are sixteen, or only such as need no cut.
  const bool deep = part.depth >= LightBranches::kEvenFrom;
  const uint32_t whole = crowded_ && part.end - part.begin > kBranchWidth ? kBranchWidth : 1;
  const auto child_of = [&](uint32_t begin, uint32_t end) {
    Child child{begin, end, bounds_of(lights, begin, end), 0.0};
    // What has no size still has to be cut.
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
  // Set them side by side.
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
  // Within that ball it counts as on its edge: nearer, under emitting blocks, adds a tenth to the variance.
  branch.per_near2[i] = 1.0f / std::max(r2, kNearest2);
  branch.energy[i] = shape.energy;
  aim.cos_o[i] = shape.cone.cos_o;
  aim.sin_o[i] = shape.cone.sin_o;
  aim.cos_all[i] = shape.cone.cos_all;
  if (aimed(shape.cone))
    branch.child[i] |= LightBranch::kAimed;
  for (uint32_t k = child.begin; k < child.end; ++k)
    if (lights[k].met)
      branch.child[i] |= LightBranch::kMet;
}

} // namespace lancer
