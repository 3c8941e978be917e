// The faces of a mesh that emit: which one to ask. Instances of one mesh with the same materials share it.
#pragma once

#include "lights/light_tree.h"
#include "sampling/distribution.h"
#include "scene/material.h"

#include <functional>

namespace lancer {

// What a surface sends towards the unit world direction wo: nodes and layers are for the caller to evaluate.
using EmissionAt = std::function<glm::vec3(const Surface &surface, const glm::vec3 &wo)>;

// Whether light samples ask for what the material emits, and whether that differs from place to place.
bool is_light(const Material &material);
bool emission_varies(const Material &material);
// What emitted light counts for in a choice: the mean of the channels, 0 where nothing shines.
double emission_level(const glm::vec3 &radiance);
// The same of a surface, seen straight on from the brighter side.
double emission_level(const EmissionAt &emission, const Surface &surface);

class EmissiveFaces {
public:
  // of_mesh: in the object's space, for all instances, by how this one looks; else in the world.
  // Throws BuildCancelled.
  EmissiveFaces(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                uint32_t instance, bool of_mesh, const EmissionAt &emission, const BuildContext &context);

  bool empty() const { return tree_.empty(); }
  // By power, for those who know no normal.
  const WeightedChoice &by_power() const { return by_power_; }
  // By what a point may get from each.
  LightChoice choose(const Instance &placed, const LightQuery &query, double u) const {
    return tree_.choose(to_tree(placed, query), u);
  }
  // The same for several points at once: walks that begin at them, of instances of their own.
  LightWalk walk(const Instance &placed, const LightQuery &query, double u) const {
    return LightTree::walk(to_tree(placed, query), u);
  }
  void choose(std::span<LightWalk> walks) const { tree_.choose(walks); }
  double probability(const Instance &placed, const LightQuery &query, uint32_t face) const {
    return tree_.probability(to_tree(placed, query), face);
  }
  // In the world; energy: radiance times area.
  LightBounds bounds(const Instance &placed) const;
  size_t bytes() const { return tree_.bytes() + by_power_.size() * sizeof(double); }

private:
  // What the faces are worth: radiance times area in the space of the tree.
  std::vector<double> powers(const Geometry &geometry, const std::vector<uint32_t> &slots,
                             const std::vector<Material> &materials, uint32_t instance, const EmissionAt &emission,
                             const BuildContext &context) const;
  LightQuery to_tree(const Instance &placed, const LightQuery &query) const;

  bool of_mesh_;
  // The tree's space: (p - centre) * scale.
  glm::dvec3 centre_{0.0};
  double scale_ = 1.0;
  WeightedChoice by_power_;
  LightTree tree_;
};

} // namespace lancer
