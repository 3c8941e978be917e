// Which of many lights to ask at a point, and which ones a ray may run into: a tree of clusters, sixteen to a branch. Clusters
// are chosen by the most that may arrive from each.
#pragma once

#include "lights/light_bounds.h"
#include "lights/light_choice.h"
#include "lights/light_kernel.h"
#include "simd/parallel.h"

#include <span>
#include <vector>

namespace lancer {

// Which of a few lights to ask at a point: a binary tree, each choice weighted by what may arrive.
// Between lights, and between what is near and what is distant, shares of the upper and of the lower bounds are averaged, as in
// Cycles; between clusters the upper bounds decide.
class BinaryLightTree {
public:
  BinaryLightTree() = default;
  // count: numbers are below it. Lights without energy are never chosen.
  BinaryLightTree(std::vector<DescribedLight> lights, uint32_t count);

  bool empty() const { return lights_.empty(); }
  size_t size() const { return lights_.size(); }

  // u in [0, 1): one number for the whole way down.
  LightChoice choose(const LightQuery &query, double u) const;
  // The tree itself, for kernels.
  LightNodes nodes() const { return {nodes_.data(), lights_.data(), root_, node_of_.data(), parent_.data()}; }
  // kNone: never chosen.
  uint32_t place_of(uint32_t number) const { return number < place_of_.size() ? place_of_[number] : kNone; }
  // With which choose() returns a light.
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

  std::vector<LightNode> nodes_; // 0 and 1 are what is near and what is distant
  std::vector<TreeLight> lights_;
  std::vector<uint32_t> node_of_, parent_; // LightNodes
  std::vector<uint32_t> place_of_;         // by number; kNone: never chosen
  uint32_t root_ = 0;                      // the pair of 0 and 1 where both have lights: kNone
};

class LightTree {
public:
  LightTree() = default;
  // count: numbers are below it. Lights without energy are never chosen, and none is distant. Coordinates should be about 1024
  // at most. Throws BuildCancelled.
  LightTree(std::vector<DescribedLight> lights, uint32_t count, const BuildContext &context = {});

  bool empty() const { return branches_.empty(); }
  // Of all of it; energy in the user's units.
  const LightBounds &bounds() const { return bounds_; }

  // u in [0, 1): one number for the whole way down.
  LightChoice choose(const LightQuery &query, double u) const;
  // The same for several at once.
  static LightWalk walk(const LightQuery &query, double u);
  void choose(std::span<LightWalk> walks) const { kernel_->choose(tree(), walks.data(), uint32_t(walks.size())); }
  // With which choose() returns a light.
  double probability(const LightQuery &query, uint32_t number) const;

  // Calls visit(way, light) for all lights that the first ways may meet before they end. The tree is not empty.
  template <class Visit> void along(const SegmentBlock &segments, uint32_t count, Visit &&visit) const {
    kernel_->along(
        tree(), segments, count,
        [](void *context, uint32_t way, uint32_t light) {
          (*static_cast<std::remove_reference_t<Visit> *>(context))(way, light);
        },
        &visit);
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

  const LightKernel *kernel_ = nullptr;
  std::vector<LightBranch> branches_;
  std::vector<LightAim> aims_; // of each branch; empty where nothing is aimed
  std::vector<uint32_t> slot_of_;
  std::vector<uint32_t> place_of_; // slot by number of light; kNone: never chosen
  LightBounds bounds_;
  bool crowded_ = false;
};

} // namespace lancer
