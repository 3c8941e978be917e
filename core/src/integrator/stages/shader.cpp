#include "integrator/stages/shader.h"

#include "bsdf/material_lobes.h"

#include <algorithm>

namespace lancer {

void Shader::shade(const Surface &surface, const View &view, Shaded &result, bool seen_by_camera) {
  result.transmittance = glm::vec3(0.0f);
  result.material = surface.material == kNone ? nullptr : &scene_.materials[surface.material];
  static const MaterialView nothing;
  const MaterialView *const material = result.material ? result.material : &nothing;
  // Evaluate the nodes, then build the lobes as seen from wo.
  nodes_.run(material->program, material->surface_nodes, surface, view);
  find_lobes<float>(&material, PlaceValues{nodes_.values()}, false, view.wo, surface.ns, surface.ng, result.bsdf,
                    {.seen_by_camera = seen_by_camera});
  result.emission = nodes_.value(material->emission) + result.bsdf.emission;
  if (material->is_transparent())
    result.transmittance = glm::max(nodes_.value(material->transmittance), 0.0f);
  result.transmittance += result.bsdf.straight;
}

glm::vec3 Shader::transmittance(const Ray &ray, const Hit &hit, const LightPath<float> &path) {
  const uint32_t number = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (number == kNone)
    return glm::vec3(0.0f);
  const MaterialView &material = scene_.materials[number];
  if (!material.is_transparent() || (material.flags & MaterialFlag::OpaqueShadows))
    return glm::vec3(0.0f);
  if (material.has_sheets || !material.portals.empty())
    return transmittance_by_lobes(ray, hit, material, path);
  // Use the cheapest evaluation that suffices.
  if (!material.transmittance.varies())
    return glm::max(material.transmittance.value, 0.0f);
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const Cutout &cutout = scene_.cutouts[number];
  const bool on_mesh = instance.kind == ShapeKind::Mesh;
  if (on_mesh && cutout.alpha.known())
    return glm::vec3(
        glm::max(1.0f - alpha_at(cutout.alpha, scene_.geometry.meshes[instance.mesh], hit.primitive, {hit.u, hit.v}), 0.0f));
  if (on_mesh && cutout.painted) {
    nodes_.run_painted(material.program, material.transmittance_nodes, hit);
  } else {
    const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
    nodes_.run(material.program, material.transmittance_nodes, surface,
               {.wo = glm::vec3(-glm::normalize(ray.d)), .path = path});
  }
  return glm::max(nodes_.value(material.transmittance), 0.0f);
}

// Returns the transmittance of a surface with sheets or portals. As in Cycles, a shadow ray ends at a portal, but beside a
// transparent part it passes the portals' shares straight, too.
glm::vec3 Shader::transmittance_by_lobes(const Ray &ray, const Hit &hit, const MaterialView &material,
                                         const LightPath<float> &path) {
  const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
  shade(surface, {.wo = glm::vec3(-glm::normalize(ray.d)), .path = path}, shaded_, false);
  glm::vec3 straight = shaded_.transmittance;
  for (const Portal &portal : material.portals)
    straight -= counted_portal(glm::max(nodes_.value(portal.weight), 0.0f));
  return material.portals.empty() || mean(straight) >= kLeastPortal ? shaded_.transmittance : glm::vec3(0.0f);
}

bool Shader::is_there(uint32_t number, const Hit &hit) {
  const MaterialView &material = scene_.materials[number];
  const Cutout &cutout = scene_.cutouts[number];
  if (cutout.ends_with_alpha) {
    const MeshView &mesh = scene_.geometry.meshes[scene_.geometry.instances[hit.instance].mesh];
    return alpha_at(cutout.alpha, mesh, hit.primitive, {hit.u, hit.v}) != 0.0f;
  }
  nodes_.run_painted(material.program, cutout.nodes, hit);
  const auto none = [&](const LobeDescription &lobe) { return evaluate(lobe.weight, nodes_.values()) == glm::vec3(0.0f); };
  return nodes_.value(material.transmittance) != glm::vec3(1.0f) || !std::ranges::all_of(material.lobes, none);
}

glm::vec4 Shader::node_value(const Surface &surface, uint32_t node, const glm::vec3 &wo) {
  const MaterialView &material = scene_.materials[surface.material];
  Parameter parameter;
  parameter.node = int32_t(node);
  nodes_.run(material.program, material.program.schedule(std::span(&parameter, 1)), surface, {.wo = wo});
  return nodes_.values()[node];
}

} // namespace lancer
