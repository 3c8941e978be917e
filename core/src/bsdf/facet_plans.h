// Lobes of facets that the nodes Glossy, Metallic and Glass make, and plans of those that are the same wherever they are met.
#pragma once

#include "bsdf/inputs.h"
#include "bsdf/microfacet.h"

#include <optional>

namespace lancer {

// Still to be completed (see microfacet.h), with the weight of the node in color.
Lobe glossy_facets(const LobeInputs &inputs, uint8_t frame, float alpha_x, float alpha_y);
Lobe conductor_facets(const LobeInputs &inputs, uint8_t frame, float alpha_x, float alpha_y);
// Not by the rules of Blender 3.x, but where it preserves energy. inside: seen from within.
Lobe glass_facets(const LobeInputs &inputs, uint8_t frame, bool inside);

// The index from wo's side; Cycles keeps the node's away from 0.
float index_from(bool inside, float ior);

struct FacetPlans {
  MicrofacetPlan side[2]; // seen from outside, from inside
};
// Of inputs without a normal of their own; none where the lobe has a direction along the surface, or is no plain one of facets.
std::optional<FacetPlans> plan_facets(const LobeInputs &inputs);
void add_facets(Bsdf &bsdf, const FacetPlans &plans);

} // namespace lancer
