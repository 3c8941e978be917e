// Which of many lights to ask at a point: a tree of clusters, eight to a node, chosen by the most that may arrive from each.
#pragma once

#include "lights/tree_light.h"

#include <vector>

namespace lancer {

class LightTree {
public:
  LightTree() = default;
  // count: numbers are below it. Lights without energy are never chosen, and none is distant. Coordinates should be about 1024
  // at most.
  LightTree(std::vector<DescribedLight> lights, uint32_t count);

  bool empty() const { return nodes_.empty(); }
  // Of all of it; energy in the user's units.
  const LightBounds &bounds() const { return bounds_; }

  // u in [0, 1): one number for the whole way down.
  LightChoice choose(const LightQuery &query, double u) const;
  // With which choose() returns a light.
  double probability(const LightQuery &query, uint32_t number) const;

  size_t bytes() const { return nodes_.size() * (sizeof(Node) + sizeof(uint32_t)) + place_of_.size() * sizeof(uint32_t); }

private:
  static constexpr int kWidth = 8;
  static constexpr uint32_t kLight = 1u << 31;

  // Of its children, side by side: they are weighed in vector registers.
  struct alignas(64) Node {
    float centre[3][kWidth] = {}, half[3][kWidth] = {}, axis[3][kWidth] = {};
    float cos_o[kWidth] = {}, sin_o[kWidth] = {}, cos_all[kWidth] = {};
    float energy[kWidth] = {};   // 0: no child
    uint32_t child[kWidth] = {}; // a node, or kLight and the number of a light
  };
  struct Weights {
    alignas(16) float most[kWidth];
    double sum = 0.0;
  };
  struct Part {
    uint32_t begin, end, slot; // slot: of the parent, kWidth times its number and the child's
  };

  static Weights weigh(const Node &node, const LightQuery &query);
  void add_node(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting);

  std::vector<Node> nodes_;        // 0 is the root
  std::vector<uint32_t> slot_of_;  // of each node in its parent
  std::vector<uint32_t> place_of_; // slot by number of light; kNone: never chosen
  LightBounds bounds_;
};

} // namespace lancer
