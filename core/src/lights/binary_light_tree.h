// Which of a few lights to ask at a point: a binary tree, each choice weighted by what may arrive.
// Between lights, and between what is near and what is distant, shares of the upper and of the lower bounds are averaged, as in
// Cycles; between clusters the upper bounds decide.
#pragma once

#include "lights/light_choice.h"

#include <vector>

namespace lancer {

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
  LightNodes nodes() const { return {nodes_.data(), lights_.data(), root_}; }
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

  double share_of_leaf(const LightQueryLanes<float> &query, const LightNode &node, uint32_t place) const;
  void split(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting);

  std::vector<LightNode> nodes_; // 0 and 1 are what is near and what is distant
  std::vector<TreeLight> lights_;
  std::vector<uint32_t> node_of_;  // of each light
  std::vector<uint32_t> parent_;   // of each pair of nodes; unused for the first
  std::vector<uint32_t> place_of_; // by number; kNone: never chosen
  uint32_t root_ = 0;              // the pair of 0 and 1 where both have lights: kNone
};

} // namespace lancer
