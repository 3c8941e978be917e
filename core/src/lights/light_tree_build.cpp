#include "lights/light_cut.h"
#include "lights/light_tree.h"

#include <algorithm>

namespace lancer {

LightTree::LightTree(std::vector<DescribedLight> lights, uint32_t count) : place_of_(count, kNone) {
  bounds_ = prepare(lights);
  if (lights.empty())
    return;
  std::vector<Part> waiting{{0, uint32_t(lights.size()), kNone}};
  while (!waiting.empty()) {
    const Part part = waiting.back();
    waiting.pop_back();
    add_node(part, lights, waiting);
  }
}

void LightTree::add_node(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting) {
  const uint32_t number = uint32_t(nodes_.size());
  if (part.slot != kNone)
    nodes_[part.slot / kWidth].child[part.slot % kWidth] = number;
  // Cut the costliest child in two until there are eight, or only single lights.
  struct Child {
    uint32_t begin, end;
    LightBounds bounds;
    double cost;
  };
  const auto child_of = [&](uint32_t begin, uint32_t end) {
    const LightBounds bounds = bounds_of(lights, begin, end);
    // What has no size still has to be cut.
    return Child{begin, end, bounds, end - begin > 1 ? std::max(bounds.cost(), std::numeric_limits<double>::min()) : 0.0};
  };
  std::vector<Child> children{child_of(part.begin, part.end)};
  while (children.size() < kWidth) {
    const auto costliest =
        std::max_element(children.begin(), children.end(), [](const Child &a, const Child &b) { return a.cost < b.cost; });
    const Child child = *costliest;
    if (!(child.cost > 0.0))
      break;
    const LightCut cut = find_cut(lights, child.begin, child.end, std::numeric_limits<double>::infinity());
    make_cut(lights, child.begin, child.end, cut);
    *costliest = child_of(child.begin, cut.middle);
    children.push_back(child_of(cut.middle, child.end));
  }
  Node node;
  for (uint32_t i = 0; i < children.size(); ++i) {
    const Child &child = children[i];
    const ClusterShape shape = cluster_shape(child.bounds);
    for (int axis = 0; axis < 3; ++axis) {
      node.centre[axis][i] = shape.centre[axis];
      node.half[axis][i] = shape.half[axis];
      node.axis[axis][i] = shape.cone.axis[axis];
    }
    node.cos_o[i] = shape.cone.cos_o;
    node.sin_o[i] = shape.cone.sin_o;
    node.cos_all[i] = shape.cone.cos_all;
    node.energy[i] = shape.energy;
    const uint32_t slot = number * kWidth + i;
    if (child.end - child.begin > 1) {
      waiting.push_back({child.begin, child.end, slot});
      continue;
    }
    node.child[i] = kLight | lights[child.begin].light.number;
    place_of_[lights[child.begin].light.number] = slot;
  }
  nodes_.push_back(node);
  slot_of_.push_back(part.slot);
}

} // namespace lancer
