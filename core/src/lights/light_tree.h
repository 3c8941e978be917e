// Light trees: the choice among many lights at a point, and the search for the lights that a ray may hit. The tree of many
// lights has clusters with sixteen children to a branch; clusters are chosen by the upper bound of their contribution.
#pragma once

#include "lights/light_bounds.h"
#include "lights/light_choice.h"
#include "lights/tree_kernel.h"
#include "simd/parallel.h"

#include <span>
#include <vector>

namespace lancer {

// The choice among a few lights at a point: a binary tree whose choices are weighted by the possible contribution. Between
// lights, and between near and distant clusters, the shares of upper and of lower bounds are averaged, as in Cycles; between
// clusters, the upper bounds decide.
class BinaryLightTree {
public:
  BinaryLightTree() = default;
  // count: light numbers are below it. Lights without energy are never chosen.
  BinaryLightTree(std::vector<DescribedLight> lights, uint32_t count);

  bool empty() const { return lights_.empty(); }
  size_t size() const { return lights_.size(); }

  // The nodes, for kernels: choose_light() chooses.
  LightNodes nodes() const { return {nodes_.data(), lights_.data(), root_, node_of_.data(), parent_.data()}; }
  // Returns kNone for a light that is never chosen.
  uint32_t place_of(uint32_t number) const { return number < place_of_.size() ? place_of_[number] : kNone; }
  // Returns the probability with which choose_light() returns a light.
  double probability(const LightQuery &query, uint32_t number) const;

  size_t bytes() const {
    return lights_.size() * sizeof(TreeLight) + nodes_.size() * sizeof(LightNode) + (node_of_.size() + place_of_.size()) * 4;
  }

private:
  struct Part {
    uint32_t node, begin, end;
    bool distant;
  };

  void split(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting);

  std::vector<LightNode> nodes_; // 0 and 1 are the near and the distant cluster
  std::vector<TreeLight> lights_;
  std::vector<uint32_t> node_of_, parent_; // LightNodes
  std::vector<uint32_t> place_of_;         // by number; kNone: never chosen
  uint32_t root_ = 0;                      // kNone if both 0 and 1 have lights: the root is then this pair
};

class LightTree {
public:
  LightTree() = default;
  // count: light numbers are below it. Lights without energy are never chosen, and no light may be distant. Coordinates should
  // be at most about 1024. Throws BuildCancelled.
  LightTree(std::vector<DescribedLight> lights, uint32_t count, const BuildContext &context = {});

  bool empty() const { return branches_.empty(); }
  // Bounds of the whole tree; energy in the user's units.
  const LightBounds &bounds() const { return bounds_; }

  // The walks that choose lights for several points together. u in [0, 1): one random number serves all levels of the tree.
  static LightWalk walk(const LightQuery &query, double u);
  void choose(std::span<LightWalk> walks) const { kernel_->choose(tree(), walks.data(), uint32_t(walks.size())); }
  // Returns the probability with which choose() returns a light.
  double probability(const LightQuery &query, uint32_t number) const;

  // Hands each light that one of the first count segments may hit to the visitor, with the number of the segment. The tree must
  // not be empty.
  void along(const SegmentBlock &segments, uint32_t count, LightVisitor &visitor) const {
    kernel_->along(tree(), segments, count, visitor);
  }

  size_t bytes() const {
    return branches_.size() * (sizeof(LightBranch) + sizeof(uint32_t)) + aims_.size() * sizeof(LightAim) +
           place_of_.size() * sizeof(uint32_t);
  }

private:
  struct Part {
    uint32_t begin, end, slot, depth; // slot: of the parent
  };
  struct Child {
    uint32_t begin, end;
    LightBounds bounds;
    double cost;
  };

  LightBranches tree() const { return {branches_.data(), aims_.empty() ? nullptr : aims_.data(), slot_of_.data()}; }
  void add_branch(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting);
  static void set(const Child &child, uint32_t i, const std::vector<DescribedLight> &lights, LightBranch &branch,
                  LightAim &aim);

  const TreeKernel *kernel_ = nullptr;
  std::vector<LightBranch> branches_;
  std::vector<LightAim> aims_; // of each branch; empty where no light is aimed
  std::vector<uint32_t> slot_of_;
  std::vector<uint32_t> place_of_; // slot by number of light; kNone: never chosen
  LightBounds bounds_;
  bool crowded_ = false;
};

} // namespace lancer
