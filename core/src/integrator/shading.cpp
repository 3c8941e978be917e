#include "integrator/shading.h"

#include "bsdf/microfacet.h"
#include "integrator/terminator.h"

#include <algorithm>

namespace lancer {

namespace {

size_t most_nodes(const Scene &scene) {
  size_t most = scene.world.program.nodes.size();
  for (const Material &material : scene.materials)
    most = std::max(most, material.program.nodes.size());
  return most;
}

// Makes a lobe once where neither wo nor the place changes it.
ReadyLobe make_ready(const LobeInputs &inputs, const PrincipledInputs *principled) {
  ReadyLobe ready;
  bool matte = inputs.kind == LobeKind::Lambert || (inputs.kind == LobeKind::Diffuse && inputs.roughness == 0.0f);
  const bool course = inputs.kind == LobeKind::Mirror || inputs.kind == LobeKind::Phong || inputs.kind == LobeKind::BlinnPhong;
  if (principled && principled->rules != Rules::Blender3) {
    LayerPlan &plan = ready.layers.emplace(plan_layers(inputs, *principled, Sides::Both));
    keep_rows(plan);
    matte = plan.only_diffuse(*principled) && principled->diffuse_roughness == 0.0f;
  }
  if ((!matte && !course) || inputs.normal != glm::vec3(0.0f))
    return ready;
  const auto bsdf = std::make_unique<Bsdf>();
  const glm::vec3 up(0.0f, 0.0f, 1.0f);
  bsdf->begin(up, up, up, false, true);
  if (principled)
    add_principled(*bsdf, inputs, *principled);
  else
    add_lobe(*bsdf, inputs);
  if (bsdf->count != 1)
    return ready;
  ready.lobe = bsdf->lobes[0];
  ready.usable = true;
  // About an interpolated normal reflecting lobes, and in Blender 3.x all, may be bent.
  ready.flat_only = course || inputs.rules == Rules::Blender3;
  return ready;
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

Shader::Shader(const Scene &scene, const Camera *camera) : scene_(scene), values_(most_nodes(scene)) {
  context_.geometry = &scene.geometry;
  context_.images = &scene.images;
  context_.normalisation = &scene.normalisation;
  context_.camera = camera;
  for (const Material &material : scene.materials) {
    std::vector<ReadyLobe> &ready = ready_.emplace_back();
    for (size_t i = 0; i < material.fixed.size(); ++i)
      ready.push_back(make_ready(material.fixed[i], material.lobes[i].principled ? &material.fixed_principled[i] : nullptr));
    if (!material.fixed.empty())
      continue;
    for (const LobeDescription &lobe : material.lobes)
      if (ready.emplace_back(); lobe.principled && lobe.principled->constants.rules != Rules::Blender3)
        ready.back().layers = unvarying_layers(lobe, values_);
  }
}

void Shader::shade(const Surface &surface, const View &view, Shaded &result) {
  result.emission = result.transmittance = glm::vec3(0.0f);
  result.holdout = 0.0f;
  result.material = surface.material == kNone ? nullptr : &scene_.materials[surface.material];
  if (!result.material) {
    static const Material nothing;
    begin(nothing, surface, view.wo, result.bsdf);
    result.bsdf.complete();
    return;
  }
  const Material &material = *result.material;
  // Compute what the nodes say here, then what becomes of the lobes seen from wo.
  run_nodes(material, material.surface_nodes, surface, view);
  begin(material, surface, view.wo, result.bsdf);
  add_lobes(material, result.bsdf);
  result.bsdf.complete();
  result.emission = value_of(material.emission, values_) + result.bsdf.emission;
  if (material.transmits())
    result.transmittance = glm::max(value_of(material.transmittance, values_), 0.0f);
  result.holdout = std::clamp(value_of(material.holdout, values_).x, 0.0f, 1.0f);
}

glm::vec3 Shader::transmittance(const Surface &surface, const glm::vec3 &wo) {
  if (surface.material == kNone)
    return glm::vec3(0.0f);
  const Material &material = scene_.materials[surface.material];
  if (!material.transmits() || (material.flags & LANCER_MATERIAL_OPAQUE_SHADOWS))
    return glm::vec3(0.0f);
  run_nodes(material, material.transmittance_nodes, surface, {.wo = wo});
  return glm::max(value_of(material.transmittance, values_), 0.0f);
}

glm::vec3 Shader::emission(const Surface &surface, const glm::vec3 &wo) {
  if (surface.material == kNone)
    return glm::vec3(0.0f);
  const Material &material = scene_.materials[surface.material];
  if (material.layered_emission) {
    // What lies above the emitting layer depends on the direction: ask the whole material.
    shade(surface, {.wo = wo}, layered_);
    return layered_.emission;
  }
  run_nodes(material, material.emission_nodes, surface, {.wo = wo});
  return value_of(material.emission, values_);
}

glm::vec4 Shader::node_value(const Surface &surface, uint32_t node, const glm::vec3 &wo) {
  const Material &material = scene_.materials[surface.material];
  Parameter parameter;
  parameter.node = int32_t(node);
  run_nodes(material, material.program.schedule(std::span(&parameter, 1)), surface, {.wo = wo});
  return values_[node];
}

void Shader::run_nodes(const Material &material, const Schedule &schedule, const Surface &surface, const View &view) {
  if (schedule.empty())
    return;
  context_.surface = &surface;
  context_.wo = view.wo;
  context_.footprint = view.footprint;
  run(material.program, schedule, context_, values_);
}

void Shader::begin(const Material &material, const Surface &surface, const glm::vec3 &wo, Bsdf &bsdf) const {
  // Turn both normals to the viewer's side.
  const bool inside = glm::dot(wo, surface.ng) < 0.0f;
  const glm::vec3 ng = inside ? -surface.ng : surface.ng;
  glm::vec3 ns = inside ? -surface.ns : surface.ns;
  // A bump of the whole surface stands in for its normal; nodes give it on the viewer's side.
  if (material.normal.varies()) {
    const glm::vec3 bumped = value_of(material.normal, values_);
    const float length2 = glm::dot(bumped, bumped);
    if (length2 > 0.0f && std::isfinite(length2))
      ns = bumped / std::sqrt(length2);
  }
  bsdf.begin(wo, ns, ng, inside, !(material.flags & LANCER_MATERIAL_NO_BUMP_CORRECTION));
}

void Shader::add_lobes(const Material &material, Bsdf &bsdf) {
  const std::vector<ReadyLobe> &ready = ready_[size_t(&material - scene_.materials.data())];
  if (!material.fixed.empty()) {
    for (size_t i = 0; i < material.fixed.size(); ++i) {
      if (ready[i].usable && (bsdf.flat || !ready[i].flat_only))
        add(bsdf, ready[i].lobe);
      else if (ready[i].layers)
        add_layers(bsdf, material.fixed[i], material.fixed_principled[i], *ready[i].layers);
      else if (material.lobes[i].principled)
        add_principled(bsdf, material.fixed[i], material.fixed_principled[i]);
      else
        add_lobe(bsdf, material.fixed[i]);
    }
    return;
  }
  for (size_t i = 0; i < material.lobes.size(); ++i) {
    const LobeDescription &lobe = material.lobes[i];
    const LobeInputs inputs = evaluate(lobe, values_);
    if (inputs.weight == glm::vec3(0.0f))
      continue;
    if (ready[i].layers)
      add_layers(bsdf, inputs, evaluate(*lobe.principled, values_), *ready[i].layers);
    else if (lobe.principled)
      add_principled(bsdf, inputs, evaluate(*lobe.principled, values_));
    else
      add_lobe(bsdf, inputs);
  }
}

Ray shadow_ray(const Geometry &geometry, const Surface &surface, const Bsdf &bsdf, const LightSample &sample) {
  const bool far = std::isinf(sample.distance);
  const glm::vec3 wi(sample.wi);
  Ray ray = leave(surface, sample.wi, far ? std::numeric_limits<double>::infinity() : 1.0);
  const glm::dvec3 lift = terminator_offset(geometry, surface, bsdf.ns, bsdf.ng, wi);
  if (lift != glm::dvec3(0.0)) {
    // From below the triangle's own plane it may be met; from above it cannot.
    ray.o = surface.p + lift;
    if (!((glm::dot(wi, bsdf.ng) > 0.0f) == (glm::dot(wi, bsdf.ns) > 0.0f)))
      ray.skip_instance = ray.skip_primitive = kNone;
  }
  if (!far)
    ray.d = sample.target - ray.o;
  ray.kinds = LANCER_RAY_SHADOW;
  return ray;
}

PixelCone::PixelCone(const Camera &camera) {
  // Compare the rays through the middle of the picture and one pixel beside it.
  const glm::dvec2 middle(0.5 * camera.width, 0.5 * camera.height);
  const Ray here = camera.ray(middle, glm::dvec2(0.0));
  const Ray right = camera.ray(middle + glm::dvec2(1.0, 0.0), glm::dvec2(0.0));
  const Ray above = camera.ray(middle + glm::dvec2(0.0, 1.0), glm::dvec2(0.0));
  const glm::dvec3 d = glm::normalize(here.d);
  base = 0.5 * (glm::length(right.o - here.o) + glm::length(above.o - here.o));
  spread = 0.5 * (glm::length(glm::normalize(right.d) - d) + glm::length(glm::normalize(above.d) - d));
}

} // namespace lancer
