#include "scene/wide_materials.h"

#include "bsdf/albedo_tables.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_fresnel.h"
#include "bsdf/principled.h"
#include "lancer.h"
#include "sampling/plain_vectors.h"

namespace lancer {

namespace {

WideLobe *next(WideMaterial &material) {
  return material.count < uint32_t(kWideLobes) ? &material.lobes[material.count++] : nullptr;
}

bool add_facets(WideMaterial &material, const MicrofacetPlan &plan, WideMode mode, float share) {
  const Lobe &lobe = plan.lobe;
  const bool glass = refracts(lobe), schlick = lobe.fresnel == FresnelKind::Schlick;
  const bool known = schlick || (!glass && (lobe.fresnel == FresnelKind::None || lobe.fresnel == FresnelKind::Dielectric ||
                                            lobe.fresnel == FresnelKind::F82));
  WideLobe *wide = next(material);
  if (!wide || !known || !reflects(lobe) || lobe.beckmann || !plan.rows)
    return false;
  wide->shape = WideShape::Microfacet;
  wide->mode = mode;
  wide->share = share;
  wide->alpha_x = lobe.alpha_x;
  wide->alpha_y = lobe.alpha_y;
  wide->fresnel = uint32_t(lobe.fresnel);
  copy(lobe.f0, wide->f0);
  copy(lobe.f90, wide->f90);
  copy(lobe.b, wide->b);
  copy(lobe.reflection, wide->reflection);
  copy(lobe.transmission, wide->transmission);
  wide->delta = lobe.delta;
  wide->delta_through = lobe.delta_through;
  wide->through = glass;
  copy(plan.further, wide->further);
  wide->ior = lobe.ior;
  wide->per_range = lobe.per_range;
  const bool dielectric = lobe.fresnel == FresnelKind::Dielectric;
  wide->lowest = dielectric ? f0_of_ior(lobe.ior) : lobe.lowest;
  wide->preserving = plan.preserving;
  wide->averaged =
      schlick || lobe.fresnel == FresnelKind::F82 || (dielectric && lobe.ior > 1.0f && lobe.rules == Rules::Blender45);
  wide->single = plan.rows->single;
  wide->mix = plan.rows->mix;
  material.bends = 1;
  material.smooth |= !lobe.delta;
  material.transmits |= glass;
  return true;
}

bool add_lambert(WideMaterial &material, WideMode mode) {
  WideLobe *wide = next(material);
  if (!wide)
    return false;
  wide->shape = WideShape::Lambert;
  wide->mode = mode;
  material.smooth = 1;
  return true;
}

// The layers of add_layers(), as far as kernels know them.
bool add_principled(WideMaterial &material, const LobeInputs &inputs, const PrincipledInputs &in,
                    const std::optional<LayerPlan> &layers, bool inside) {
  if (!layers || in.rules == Rules::Blender3 || inputs.normal != glm::vec3(0.0f) || in.coat_normal != glm::vec3(0.0f) ||
      in.sheen > kLeastLayer || in.emission != glm::vec3(0.0f) || in.diffuse_roughness >= kLambertRoughness)
    return false;
  if (grain_of(inputs, in.roughness, unit(in.anisotropic)).stretched)
    return false;
  const float metallic = unit(in.metallic), transmission = unit(in.transmission);
  copy(inputs.weight, material.weight);
  copy(glm::max(in.base_color, 0.0f), material.base);
  const auto add = [&](const std::optional<MicrofacetPlan> &plan, WideMode mode, float share) {
    return plan && add_facets(material, *plan, mode, share);
  };
  if (in.coat > kLeastLayer && (in.coat_tint != glm::vec3(1.0f) || !add(layers->coat, WideMode::Layer, in.coat)))
    return false;
  if (metallic > kLeastLayer && !add(layers->metal, WideMode::Share, metallic))
    return false;
  if (metallic < 1.0f && transmission > kLeastLayer && !add(layers->glass[inside], WideMode::Share, transmission))
    return false;
  if (metallic >= 1.0f || transmission >= 1.0f)
    return true;
  if (layers->gloss && !add(layers->gloss, WideMode::Layer, 1.0f))
    return false;
  return add_lambert(material, WideMode::Base);
}

// Whether nodes have a say in nothing of a Principled but its weight and base colour.
bool only_colors_vary(const LobeDescription &lobe) {
  const PrincipledDescription &p = *lobe.principled;
  for (const Parameter *parameter :
       {&p.metallic,    &p.roughness,    &p.ior,   &p.diffuse_roughness,    &p.specular,       &p.specular_tint,
        &p.anisotropic, &p.transmission, &p.coat,  &p.anisotropic_rotation, &p.coat_roughness, &p.coat_ior,
        &p.coat_tint,   &p.coat_normal,  &p.sheen, &p.sheen_roughness,      &p.sheen_tint,     &p.emission,
        &lobe.normal,   &lobe.tangent})
    if (parameter->varies())
      return false;
  return true;
}

bool fill_by_nodes(const Material &material, bool inside, WideMaterial &wide) {
  const LobeDescription &lobe = material.lobes.front();
  const std::vector<glm::vec4> nothing(material.program.nodes.size(), glm::vec4(0.0f));
  const LobeInputs inputs = evaluate(lobe, nothing);
  wide.nodes = 1;
  if (lobe.principled) {
    // Metal and glass are made of the base colour.
    const PrincipledInputs in = evaluate(*lobe.principled, nothing);
    const bool made = in.metallic > kLeastLayer || in.transmission > kLeastLayer;
    if (!only_colors_vary(lobe) || (made && lobe.principled->base_color.varies()))
      return false;
    return add_principled(wide, inputs, in, material.ready.front().layers, inside);
  }
  const bool matte = lobe.kind == LobeKind::Lambert || lobe.kind == LobeKind::Diffuse;
  return matte && lobe.rules != Rules::Blender3 && !lobe.normal.varies() && inputs.normal == glm::vec3(0.0f) &&
         !lobe.roughness.varies() && inputs.roughness < kLambertRoughness && add_lambert(wide, WideMode::Own);
}

// A lobe that owes nothing to others.
bool add_alone(WideMaterial &material, const ReadyLobe &ready, bool inside) {
  const MicrofacetPlan *facets = ready.facets ? &ready.facets->side[inside] : nullptr;
  const bool matte = ready.whole && !ready.flat_only && ready.lobe.shape == LobeShape::Lambert;
  const glm::vec3 color = facets ? facets->lobe.color : ready.lobe.color;
  if (!facets && !matte)
    return false;
  if (color == glm::vec3(0.0f))
    return true;
  if (!(facets ? add_facets(material, *facets, WideMode::Given, 1.0f) : add_lambert(material, WideMode::Given)))
    return false;
  copy(color, material.lobes[material.count - 1].color);
  return true;
}

bool fill(const Material &material, bool inside, WideMaterial &wide) {
  if (material.layered_emission || material.lobes.empty() || material.normal.varies() || material.holdout.varies() ||
      material.holdout.value != glm::vec3(0.0f))
    return false;
  if (!material.fixed())
    return material.lobes.size() == 1 && fill_by_nodes(material, inside, wide);
  const ReadyLobe &first = material.ready.front();
  if (material.ready.size() == 1 && first.inputs.kind == LobeKind::Principled)
    return add_principled(wide, first.inputs, first.principled, first.layers, inside);
  // Nodes side by side, each with a weight of its own.
  for (const ReadyLobe &ready : material.ready)
    if (!add_alone(wide, ready, inside))
      return false;
  return true;
}

WideMaterial record(const Material &material, bool inside) {
  WideMaterial wide;
  if (!fill(material, inside, wide))
    return {};
  if (material.flags & LANCER_MATERIAL_NO_BUMP_CORRECTION)
    wide.bends = 0;
  return wide;
}

} // namespace

std::vector<WideMaterial> make_wide_materials(const std::vector<Material> &materials) {
  std::vector<WideMaterial> all;
  for (const Material &material : materials)
    all.push_back(record(material, false));
  // Glass bends light by another index on its way out.
  for (size_t i = 0; i < materials.size(); ++i)
    if (all[i].transmits) {
      all[i].inside = uint32_t(all.size() - i);
      all.push_back(record(materials[i], true));
    }
  return all;
}

} // namespace lancer
