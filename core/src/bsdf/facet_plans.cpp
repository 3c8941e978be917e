#include "bsdf/facet_plans.h"

#include "bsdf/build.h"
#include "bsdf/microfacet_fresnel.h"

#include <algorithm>

namespace lancer {

namespace {

std::optional<Lobe> facets_of(const LobeInputs &inputs, bool inside) {
  if (inputs.kind == LobeKind::Glass)
    return glass_facets(inputs, 0, inside);
  if (inputs.anisotropy != 0.0f)
    return {};
  const float alpha = alpha_of(inputs.roughness);
  if (inputs.kind == LobeKind::Conductor)
    return conductor_facets(inputs, 0, alpha, alpha);
  if (inputs.kind == LobeKind::Glossy && inputs.distribution != Facets::AshikhminShirley)
    return glossy_facets(inputs, 0, alpha, alpha);
  return {};
}

} // namespace

float index_from(bool inside, float ior) {
  const float outside = std::max(ior, 1e-5f);
  return inside ? 1.0f / outside : outside;
}

Lobe glossy_facets(const LobeInputs &inputs, uint8_t frame, float alpha_x, float alpha_y) {
  Lobe lobe = make_microfacet(Scatter::Reflect, frame, colored_weight(inputs), alpha_x, alpha_y, inputs.rules);
  lobe.beckmann = inputs.distribution == Facets::Beckmann;
  set_constant(lobe, inputs.color);
  return lobe;
}

Lobe conductor_facets(const LobeInputs &inputs, uint8_t frame, float alpha_x, float alpha_y) {
  Lobe lobe = make_microfacet(Scatter::Reflect, frame, inputs.weight, alpha_x, alpha_y, inputs.rules);
  lobe.beckmann = inputs.distribution == Facets::Beckmann;
  if (inputs.option == 0)
    set_f82(lobe, glm::clamp(inputs.color, 0.0f, 1.0f), glm::clamp(inputs.edge, 0.0f, 1.0f));
  else
    set_conductor(lobe, glm::max(inputs.color, 0.0f), glm::max(inputs.edge, 0.0f));
  return lobe;
}

Lobe glass_facets(const LobeInputs &inputs, uint8_t frame, bool inside) {
  const float alpha = alpha_of(inputs.roughness), eta = index_from(inside, inputs.ior);
  const glm::vec3 color = glm::max(inputs.color, 0.0f);
  Lobe lobe = make_microfacet(Scatter::Both, frame, inputs.weight, alpha, alpha, inputs.rules);
  lobe.beckmann = inputs.distribution == Facets::Beckmann;
  set_schlick(lobe, glm::vec3(f0_of_ior(eta)), glm::vec3(1.0f), eta, color, color);
  return lobe;
}

std::optional<FacetPlans> plan_facets(const LobeInputs &inputs) {
  if (inputs.rules == Rules::Blender3 || inputs.normal != glm::vec3(0.0f))
    return {};
  FacetPlans plans;
  for (const bool inside : {false, true}) {
    const std::optional<Lobe> lobe = facets_of(inputs, inside);
    if (!lobe)
      return {};
    plans.side[inside] = plan_microfacet(*lobe, inputs.distribution == Facets::MultiGgx);
    keep_rows(plans.side[inside]);
  }
  return plans;
}

void add_facets(Bsdf &bsdf, const FacetPlans &plans) {
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, glm::vec3(0.0f)), glm::vec3(0.0f));
  const MicrofacetPlan &plan = plans.side[bsdf.inside];
  Lobe lobe = seen_from(plan, bsdf.wo_local[frame].z, plan.lobe.color);
  lobe.frame = frame;
  add(bsdf, lobe);
}

} // namespace lancer
