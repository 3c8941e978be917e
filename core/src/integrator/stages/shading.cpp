// Shading of surfaces, and samples of the lights of a scene.
#include "integrator/stages/shading.h"

#include "compile/material_lobes.h"
#include "integrator/stages/terminator.h"
#include "integrator/stages/vertex_kernel.h"
#include "scene/attribute.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

size_t most_nodes(const Scene &scene) {
  size_t most = scene.world.program.nodes.size();
  for (const Material &material : scene.materials)
    most = std::max(most, material.program.nodes.size());
  return most;
}

} // namespace

Shader::Shader(const Scene &scene, const Camera *camera) : scene_(scene), values_(most_nodes(scene)) {
  context_.geometry = &scene.geometry;
  context_.images = &scene.images;
  context_.normalisation = &scene.normalisation;
  context_.camera = camera;
}

void Shader::shade(const Surface &surface, const View &view, Shaded &result) {
  result.emission = result.transmittance = glm::vec3(0.0f);
  result.holdout = 0.0f;
  result.material = surface.material == kNone ? nullptr : &scene_.materials[surface.material];
  static const Material nothing;
  const Material *const material = result.material ? result.material : &nothing;
  // Evaluate the nodes, then build the lobes as seen from wo.
  run_nodes(*material, material->surface_nodes, surface, view);
  find_lobes<float>(&material, PlaceValues{values_}, false, view.wo, surface.ns, surface.ng, result.bsdf);
  result.emission = value_of(material->emission, values_) + result.bsdf.emission;
  if (material->transmits())
    result.transmittance = glm::max(value_of(material->transmittance, values_), 0.0f);
  result.holdout = std::clamp(value_of(material->holdout, values_).x, 0.0f, 1.0f);
}

glm::vec3 Shader::transmittance(const Ray &ray, const Hit &hit, const LightPath<float> &path) {
  const uint32_t number = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (number == kNone)
    return glm::vec3(0.0f);
  const Material &material = scene_.materials[number];
  if (!material.transmits() || (material.flags & LANCER_MATERIAL_OPAQUE_SHADOWS))
    return glm::vec3(0.0f);
  // Use the cheapest evaluation that suffices.
  if (!material.transmittance.varies())
    return glm::max(material.transmittance.value, 0.0f);
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const Cutout &cutout = scene_.cutouts[number];
  const bool on_mesh = instance.kind == ShapeKind::Mesh;
  if (on_mesh && cutout.alpha.known())
    return glm::vec3(glm::max(
        1.0f - alpha_at(cutout.alpha, scene_.images, scene_.geometry.meshes[instance.mesh], hit.primitive, {hit.u, hit.v}),
        0.0f));
  if (on_mesh && cutout.painted) {
    run_painted(material, material.transmittance_nodes, hit);
  } else {
    const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
    run_nodes(material, material.transmittance_nodes, surface, {.wo = glm::vec3(-glm::normalize(ray.d)), .path = path});
  }
  return glm::max(value_of(material.transmittance, values_), 0.0f);
}

bool Shader::is_there(uint32_t number, const Hit &hit) {
  const Material &material = scene_.materials[number];
  const Cutout &cutout = scene_.cutouts[number];
  if (cutout.ends_with_alpha) {
    const Mesh &mesh = scene_.geometry.meshes[scene_.geometry.instances[hit.instance].mesh];
    return alpha_at(cutout.alpha, scene_.images, mesh, hit.primitive, {hit.u, hit.v}) != 0.0f;
  }
  run_painted(material, cutout.nodes, hit);
  const auto none = [&](const LobeDescription &lobe) { return evaluate(lobe.weight, values_) == glm::vec3(0.0f); };
  return value_of(material.transmittance, values_) != glm::vec3(1.0f) || !std::ranges::all_of(material.lobes, none);
}

glm::vec3 Shader::emission(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path) {
  if (surface.material == kNone)
    return glm::vec3(0.0f);
  const Material &material = scene_.materials[surface.material];
  if (material.layered_emission) {
    // The layers above the emitting one depend on the direction: shade the whole material.
    shade(surface, {.wo = wo, .path = path}, layered_);
    return layered_.emission;
  }
  run_nodes(material, material.emission_nodes, surface, {.wo = wo, .path = path});
  return value_of(material.emission, values_);
}

glm::vec4 Shader::node_value(const Surface &surface, uint32_t node, const glm::vec3 &wo) {
  const Material &material = scene_.materials[surface.material];
  Parameter parameter;
  parameter.node = int32_t(node);
  run_nodes(material, material.program.schedule(std::span(&parameter, 1)), surface, {.wo = wo});
  return values_[node];
}

// Runs nodes that read only the triangle and the place within it.
void Shader::run_painted(const Material &material, const Schedule &schedule, const Hit &hit) {
  Surface surface;
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.bary = {hit.u, hit.v};
  run_nodes(material, schedule, surface, {});
}

void Shader::run_nodes(const Material &material, const Schedule &schedule, const Surface &surface, const View &view) {
  if (schedule.empty())
    return;
  context_.surface = &surface;
  context_.wo = view.wo;
  context_.footprint = view.footprint;
  context_.path = view.path;
  run(material.program, schedule, context_, values_);
}

Ray shadow_ray(const Geometry &geometry, const Surface &surface, const glm::vec3 &ns, const glm::vec3 &ng,
               const LightSample &sample) {
  const bool far = std::isinf(sample.distance);
  const glm::vec3 wi(sample.wi);
  Ray ray = leave(surface, sample.wi, far ? std::numeric_limits<double>::infinity() : 1.0);
  const glm::dvec3 lift = terminator_offset(geometry, surface, ns, ng, wi);
  if (lift != glm::dvec3(0.0)) {
    // A ray from below the triangle's own plane may hit the triangle; one from above cannot.
    ray.o = surface.p + lift;
    if (!((glm::dot(wi, ng) > 0.0f) == (glm::dot(wi, ns) > 0.0f)))
      ray.skip_instance = ray.skip_primitive = kNone;
  }
  if (!far)
    ray.d = sample.target - ray.o;
  ray.kinds = LANCER_RAY_SHADOW;
  return ray;
}

PixelCone::PixelCone(const Camera &camera) {
  // Compare the rays through the middle of the picture and through the neighbouring pixels.
  const glm::dvec2 middle(0.5 * camera.width, 0.5 * camera.height);
  const Ray here = camera.ray(middle, glm::dvec2(0.0));
  const Ray right = camera.ray(middle + glm::dvec2(1.0, 0.0), glm::dvec2(0.0));
  const Ray above = camera.ray(middle + glm::dvec2(0.0, 1.0), glm::dvec2(0.0));
  const glm::dvec3 d = glm::normalize(here.d);
  base = 0.5 * (glm::length(right.o - here.o) + glm::length(above.o - here.o));
  spread = 0.5 * (glm::length(glm::normalize(right.d) - d) + glm::length(glm::normalize(above.d) - d));
}

namespace {

// face: null to choose one by power.
LightSample sample_any(const Scene &scene, uint32_t light, const uint32_t *face, const glm::dvec3 &p, const glm::vec2 &u,
                       Shader &shader, LightPath<float> path) {
  const size_t described = scene.lights.lights().size();
  if (light < described)
    return sample(scene.lights.lights()[light], p, u);
  if (light - described >= scene.lights.emitters().size())
    return scene.lights.environment().sample(u, shader.values(), shader.camera(), false);
  // Evaluate the emitter's material towards p.
  const Emitter &emitter = scene.lights.emitters()[light - described];
  Surface surface;
  LightSample result = face ? emitter.sample_face(scene.geometry, scene.slots, *face, p, u, surface)
                            : emitter.sample(scene.geometry, scene.slots, p, u, surface);
  if (result.pdf > 0.0) {
    path.length = float(glm::length(surface.p - p) / scene.normalisation.scale);
    result.radiance = shader.emission(surface, glm::vec3(-result.wi), path);
  }
  return result;
}

} // namespace

LightSample sample_scene_light(const Scene &scene, const LightSet::Choice &choice, const glm::dvec3 &p, const glm::vec2 &u,
                               Shader &shader, const LightPath<float> &path) {
  return sample_any(scene, choice.light, &choice.face, p, u, shader, path);
}

LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader) {
  return sample_any(scene, light, nullptr, p, u, shader, {});
}

EmissionAt surface_emission(const Scene &scene) {
  const auto shader = std::make_shared<Shader>(scene, nullptr);
  // Evaluate with the depth of a first surface's light sample.
  return [shader](const Surface &surface, const glm::vec3 &wo) { return shader->emission(surface, wo, {.depth = 1.0f}); };
}

const VertexKernel &vertex_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(vertex_kernel); }

namespace {

struct SmoothTriangle {
  glm::dvec3 v[3], n[3]; // object space
};

// Returns false where the triangle has no smooth normals.
bool read_triangle(const Mesh &mesh, const Instance &instance, uint32_t triangle, SmoothTriangle &smooth) {
  glm::vec3 n[3];
  if (!corner_normals(mesh, instance.shading, triangle, n))
    return false;
  for (int i = 0; i < 3; ++i) {
    smooth.v[i] = glm::dvec3(mesh.vertex(triangle, i));
    smooth.n[i] = glm::dvec3(n[i]);
  }
  // A flat face among smooth faces has the same normal at all corners.
  return smooth.n[0] != smooth.n[1] || smooth.n[1] != smooth.n[2];
}

// Returns the height of the tangent plane at corner i above p, times sign, at least 0. The plane is raised until it is above
// the other corners.
double plane_above(const SmoothTriangle &t, int i, const glm::dvec3 &p, double sign) {
  double raised = 0.0;
  for (int k = 0; k < 3; ++k)
    raised = std::max(raised, sign * glm::dot(t.v[k] - t.v[i], t.n[i]));
  return std::max(0.0, sign * glm::dot(t.v[i] - p, t.n[i]) + raised);
}

// Returns the height of the curved surface over the triangle at barycentrics b, along the interpolated normal.
double height(const SmoothTriangle &t, const glm::dvec3 &b, const glm::dvec3 &p, bool outwards) {
  // A paraboloid whose slope changes between the corners as the normals do.
  const double e02 = glm::dot(t.n[2] - t.n[0], t.v[0] - t.v[2]), e12 = glm::dot(t.n[2] - t.n[1], t.v[1] - t.v[2]);
  const double e01 = glm::dot(t.n[1] - t.n[0], t.v[1] - t.v[0]);
  const double bulge = e02 * b.x * (b.x - 1.0) + (e02 + e12 + e01) * b.x * b.y + e12 * b.y * (b.y - 1.0);
  // At least the lowest of the corners' tangent planes.
  const double sign = outwards ? 1.0 : -1.0;
  const double planes = std::min({plane_above(t, 0, p, sign), plane_above(t, 1, p, sign), plane_above(t, 2, p, sign)});
  return sign * std::max(planes, sign * 0.5 * bulge);
}

} // namespace

glm::dvec3 terminator_offset(const Geometry &geometry, const Surface &surface, const glm::vec3 &n, const glm::vec3 &ng,
                             const glm::vec3 &wi) {
  const Instance &instance = geometry.instances[surface.instance];
  if (instance.kind != ShapeKind::Mesh)
    return glm::dvec3(0.0);
  const float amount = terminator_amount(instance.terminator, n, ng, wi);
  SmoothTriangle triangle;
  if (!(amount > 0.0f) || !read_triangle(geometry.meshes[instance.mesh], instance, surface.primitive, triangle))
    return glm::dvec3(0.0);
  const glm::dvec3 b(1.0 - surface.bary.x - surface.bary.y, surface.bary.x, surface.bary.y);
  const glm::dvec3 p = b.x * triangle.v[0] + b.y * triangle.v[1] + b.z * triangle.v[2];
  const glm::dvec3 lift = b.x * triangle.n[0] + b.y * triangle.n[1] + b.z * triangle.n[2];
  const bool outwards = glm::dot(instance.to_world.vector(lift), glm::dvec3(glm::dot(n, wi) < 0.0f ? -ng : ng)) > 0.0;
  return double(amount) * instance.to_world.vector(lift * height(triangle, b, p, outwards));
}

} // namespace lancer
