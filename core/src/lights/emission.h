// The light that surfaces emit.
#pragma once

#include "bsdf/bsdf.h"
#include "nodes/material_nodes.h"

namespace lancer {

// Return whether light sampling chooses faces with this material, and whether their emission differs from place to place.
bool is_light(const Material &material);
bool emission_varies(const Material &material);
// Returns the weight of emitted light in a choice: the mean of the channels; 0 where no channel is positive or the mean is not
// finite.
double emission_level(const glm::vec3 &radiance);

// Evaluates the emission of surfaces. One object per thread: it keeps the values of nodes.
class EmissionAt {
public:
  // materials and all that scene points to must outlive this object.
  EmissionAt(const NodeScene &scene, std::span<const Material> materials)
      : materials_(materials), nodes_(scene, most_nodes(materials)) {}

  // Returns the radiance that a surface emits towards the unit world direction wo. path: of the vertex that samples the light.
  glm::vec3 operator()(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path);
  // Returns the weight of a surface in a choice: seen along its normal from the brighter side, by a first surface's sample.
  double level(const Surface &surface);

private:
  std::span<const Material> materials_;
  MaterialNodes nodes_;
  Bsdf<float> bsdf_; // scratch for emission below layers
};

} // namespace lancer
