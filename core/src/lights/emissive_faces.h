// The emitting faces of a mesh and the choice among them. Instances of one mesh with the same materials share this record.
#pragma once

#include "lights/emission.h"
#include "lights/light_tree.h"
#include "sampling/distribution.h"
#include "scene/material.h"

namespace lancer {

class EmissiveFaces {
public:
  // of_mesh: the tree is made in the object's space and serves all instances, with the emission that this instance has;
  // otherwise it is made in world space. Throws BuildCancelled.
  EmissiveFaces(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                uint32_t instance, bool of_mesh, EmissionAt &emission, const BuildContext &context);

  bool empty() const { return tree_.empty(); }
  // The choice by power, for callers without a shading normal.
  const WeightedChoice &by_power() const { return by_power_; }
  // Returns the walk that chooses a face for one point, by an upper bound of the light that the point gets from each. Walks for
  // several points are made together, and may belong to different instances of the mesh.
  LightWalk walk(const Instance &placed, const LightQuery &query, double u) const {
    return LightTree::walk(to_tree(placed, query), u);
  }
  void choose(std::span<LightWalk> walks) const { tree_.choose(walks); }
  double probability(const Instance &placed, const LightQuery &query, uint32_t face) const {
    return tree_.probability(to_tree(placed, query), face);
  }
  // Returns bounds in world space; their energy is radiance times area.
  LightBounds bounds(const Instance &placed) const;
  size_t bytes() const { return tree_.bytes() + by_power_.size() * sizeof(double); }

private:
  // Returns radiance times area of each face, in the space of the tree.
  std::vector<double> powers(const Geometry &geometry, const std::vector<uint32_t> &slots,
                             const std::vector<Material> &materials, uint32_t instance, EmissionAt &emission,
                             const BuildContext &context) const;
  LightQuery to_tree(const Instance &placed, const LightQuery &query) const;

  bool of_mesh_;
  // The tree's space is (p - centre_) * scale_.
  glm::dvec3 centre_{0.0};
  double scale_ = 1.0;
  WeightedChoice by_power_;
  LightTree tree_;
};

} // namespace lancer
