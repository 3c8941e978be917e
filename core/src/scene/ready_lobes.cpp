#include "scene/ready_lobes.h"

#include "bsdf/build.h"
#include "scene/material.h"

#include <algorithm>
#include <memory>
#include <span>

namespace lancer {

namespace {

// Makes all of a lobe where neither wo nor the place changes it.
void make_whole(const PrincipledInputs *principled, ReadyLobe &ready) {
  const LobeInputs &inputs = ready.inputs;
  bool matte = inputs.kind == LobeKind::Lambert || (inputs.kind == LobeKind::Diffuse && inputs.roughness == 0.0f);
  const bool course = inputs.kind == LobeKind::Mirror || inputs.kind == LobeKind::Phong || inputs.kind == LobeKind::BlinnPhong;
  if (principled && principled->rules != Rules::Blender3) {
    LayerPlan &plan = ready.layers.emplace(plan_layers(inputs, *principled, Sides::Both));
    keep_rows(plan);
    matte = plan.only_diffuse(*principled) && principled->diffuse_roughness == 0.0f;
  }
  if ((!matte && !course) || inputs.normal != glm::vec3(0.0f))
    return;
  const auto bsdf = std::make_unique<Bsdf>();
  const glm::vec3 up(0.0f, 0.0f, 1.0f);
  bsdf->begin(up, up, up, false, true);
  if (principled)
    add_principled(*bsdf, inputs, *principled);
  else
    add_lobe(*bsdf, inputs);
  if (bsdf->count != 1)
    return;
  ready.lobe = bsdf->lobes[0];
  ready.whole = true;
  // About an interpolated normal reflecting lobes, and in Blender 3.x all, may be bent.
  ready.flat_only = course || inputs.rules == Rules::Blender3;
}

bool vary(std::initializer_list<const Parameter *> parameters) {
  return std::any_of(parameters.begin(), parameters.end(), [](const Parameter *parameter) { return parameter->varies(); });
}

// The layers of a Principled that its nodes leave as they are.
LayerPlan unvarying_layers(const LobeDescription &lobe, std::span<const glm::vec4> values) {
  const PrincipledDescription &p = *lobe.principled;
  // Where a share varies plan what it may be the share of.
  PrincipledInputs in = evaluate(p, values);
  for (const auto &[share, value] :
       {std::pair(&p.coat, &in.coat), {&p.metallic, &in.metallic}, {&p.transmission, &in.transmission}})
    if (share->varies())
      *value = 0.5f;
  LayerPlan plan = plan_layers(evaluate(lobe, values), in, Sides::Both);
  const bool grain = vary({&p.roughness, &p.anisotropic, &lobe.tangent});
  if (vary({&p.coat_roughness, &p.coat_ior}))
    plan.coat.reset();
  if (grain || vary({&p.base_color, &p.specular_tint}))
    plan.metal.reset();
  if (vary({&p.roughness, &p.ior, &p.specular_tint, &p.base_color}))
    plan.glass[0].reset(), plan.glass[1].reset();
  if (grain || vary({&p.ior, &p.specular, &p.specular_tint}))
    plan.gloss.reset();
  keep_rows(plan);
  return plan;
}

} // namespace

std::vector<ReadyLobe> make_ready_lobes(const Material &material) {
  // Stands for what the nodes say in parts that no node has a say in.
  const std::vector<glm::vec4> nothing(material.program.nodes.size(), glm::vec4(0.0f));
  std::vector<ReadyLobe> all;
  for (const LobeDescription &lobe : material.lobes) {
    ReadyLobe &ready = all.emplace_back();
    if (material.fixed()) {
      ready.inputs = evaluate(lobe, nothing);
      if (lobe.principled)
        ready.principled = evaluate(*lobe.principled, nothing);
      make_whole(lobe.principled ? &ready.principled : nullptr, ready);
      ready.facets = plan_facets(ready.inputs);
    } else if (lobe.principled && lobe.principled->constants.rules != Rules::Blender3)
      ready.layers = unvarying_layers(lobe, nothing);
  }
  return all;
}

} // namespace lancer
