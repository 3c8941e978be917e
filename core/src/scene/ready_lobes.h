// What of a material's lobes is the same wherever the material is met, made once when the material is added.
#pragma once

#include "bsdf/facet_plans.h"
#include "bsdf/principled.h"

#include <optional>
#include <vector>

namespace lancer {

struct Material;

struct ReadyLobe {
  // Where the material has no nodes.
  LobeInputs inputs;
  PrincipledInputs principled;

  bool whole = false;               // `lobe` is all of it
  bool flat_only = false;           // only where the shading normal is the geometric one
  Lobe lobe;                        // where it is whole
  std::optional<LayerPlan> layers;  // of Principled: those that are the same
  std::optional<FacetPlans> facets; // of a node of facets, where the material has no nodes
};

// One for each lobe.
std::vector<ReadyLobe> make_ready_lobes(const Material &material);

} // namespace lancer
