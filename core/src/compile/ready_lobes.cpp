#include "compile/steps.h"

#include "scene/material.h"

#include <span>

namespace lancer {

namespace {

bool vary(std::initializer_list<const Parameter *> parameters) {
  return std::any_of(parameters.begin(), parameters.end(), [](const Parameter *parameter) { return parameter->varies(); });
}

// Whether nodes change the plan of a layer.
bool varies(PrincipledLayer layer, const LobeDescription &lobe) {
  const PrincipledDescription &p = *lobe.principled;
  const bool grain = vary({&p.roughness, &p.anisotropic, &lobe.tangent});
  switch (layer) {
  case PrincipledLayer::Coat:
    return vary({&p.coat_roughness, &p.coat_ior});
  case PrincipledLayer::Metal:
    return grain || vary({&p.base_color, &p.specular_tint});
  case PrincipledLayer::Glass:
    return vary({&p.roughness, &p.ior, &p.specular_tint, &p.base_color});
  default:
    return grain || vary({&p.ior, &p.specular, &p.specular_tint});
  }
}

const Parameter *share_parameter(PrincipledLayer layer, const PrincipledDescription &p) {
  switch (layer) {
  case PrincipledLayer::Coat:
    return &p.coat;
  case PrincipledLayer::Metal:
    return &p.metallic;
  case PrincipledLayer::Glass:
    return &p.transmission;
  default:
    return nullptr;
  }
}

void cache_layers(const LobeDescription &lobe, ReadyLobe &ready) {
  for (const LayerRow &row : kLayers) {
    const Parameter *share = share_parameter(row.layer, *lobe.principled);
    const bool may_be_there = share_of(row.layer, ready.principled) > kLeastLayer || (share && share->varies());
    if (!row.facets || !may_be_there || varies(row.layer, lobe))
      continue;
    // A plastic layer with an index of refraction of 1 is absent.
    float f0;
    if (row.layer == PrincipledLayer::Gloss && plastic_ior(ready.principled, f0) == 1.0f)
      continue;
    for (const bool inside : {false, true})
      ready.plans[inside][static_cast<int>(row.layer)] = cached(plan_layer(row.layer, ready.inputs, ready.principled, inside));
  }
}

// Plans the facets of a lobe whose inputs are constant and which has no direction along the surface.
void cache_facets(ReadyLobe &ready) {
  const LobeInputs<float> &inputs = ready.inputs;
  const bool glass = inputs.kind == LobeKind::Glass, conductor = inputs.kind == LobeKind::Conductor;
  const bool glossy = inputs.kind == LobeKind::Glossy && inputs.distribution != Facets::AshikhminShirley;
  if (inputs.rules == Rules::Blender3 || (!glass && (inputs.anisotropy != 0.0f || !(conductor || glossy))))
    return;
  for (const bool inside : {false, true})
    ready.plans[inside][static_cast<int>(PrincipledLayer::Gloss)] = cached(plan_facets(inputs, inside));
}

} // namespace

LobeParts::LobeParts(const LobeInputs<float> &inputs, const PrincipledInputs<float> &in) {
  const glm::vec3 none(0.0f);
  const bool is_principled = inputs.kind == LobeKind::Principled;
  normal = inputs.normal != none;
  tangent = inputs.tangent != none && (!is_principled || in.anisotropic > 0.0f);
  if (!is_principled)
    return;
  coat_normal = in.coat_normal != none;
  coat_tint = in.coat_tint != glm::vec3(1.0f);
  diffuse_roughness = in.diffuse_roughness != 0.0f;
  emission = in.emission != none;
  sheen = in.sheen > kLeastLayer;
  coat = in.coat > kLeastLayer;
  metal = in.metallic > (in.rules == Rules::Blender3 ? 0.0f : kLeastLayer);
  glass = in.transmission > (in.rules == Rules::Blender3 ? 0.0f : kLeastLayer);
}

std::string ReadyLobe::code() const {
  std::string code;
  const auto add = [&](auto number) { code += char('0' + int(number)); };
  const bool is_principled = inputs.kind == LobeKind::Principled;
  add(inputs.kind);
  add(is_principled ? principled.rules : inputs.rules);
  add(is_principled ? principled.distribution : inputs.distribution);
  add(is_principled ? principled.option : inputs.option);
  for (const auto &plan : plans[0])
    add(plan != nullptr);
  for (const bool part : {parts.normal, parts.tangent, parts.coat_normal, parts.coat_tint, parts.diffuse_roughness,
                          parts.emission, parts.sheen, parts.coat, parts.metal, parts.glass})
    add(part);
  return code;
}

std::shared_ptr<const ReadyLobe[]> make_ready_lobes(const Material &material) {
  // Placeholders for the results of nodes. Values derived from a placeholder are not used.
  const std::vector<glm::vec4> nothing(material.program.nodes.size(), glm::vec4(0.0f));
  const std::shared_ptr<ReadyLobe[]> all(new ReadyLobe[material.lobes.size()]);
  for (size_t i = 0; i < material.lobes.size(); ++i) {
    const LobeDescription &lobe = material.lobes[i];
    ReadyLobe &ready = all[i];
    ready.inputs = evaluate(lobe, nothing);
    if (lobe.principled)
      ready.principled = evaluate(*lobe.principled, nothing);
    ready.parts = LobeParts(ready.inputs, ready.principled);
    if (lobe.principled && lobe.principled->rules != Rules::Blender3)
      cache_layers(lobe, ready);
    else if (!lobe.principled && material.fixed())
      cache_facets(ready);
  }
  return all;
}

} // namespace lancer
