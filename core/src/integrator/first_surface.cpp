#include "integrator/first_surface.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

float mean(const glm::vec3 &v) { return (v.x + v.y + v.z) / 3.0f; }

// The lobes' normals, each with its weight.
glm::vec3 mean_normal(const Bsdf &bsdf) {
  glm::vec3 sum(0.0f);
  for (int i = 0; i < bsdf.count; ++i)
    sum += bsdf.frames[bsdf.lobes[i].frame].n * mean(bsdf.lobes[i].color);
  return sum == glm::vec3(0.0f) ? bsdf.ns : glm::normalize(sum);
}

} // namespace

void record_place(const Scene &scene, const Surface &surface, const Shaded &shaded, double t, SampleResult &result) {
  result.depth = float(t / scene.normalisation.scale);
  result.position = glm::vec3(scene.normalisation.to_world(surface.p));
  result.object_index = float(scene.geometry.instances[surface.instance].object_index);
  result.material_index = shaded.material ? float(shaded.material->index) : 0.0f;
}

void forget_place(SampleResult &result) {
  const SampleResult nothing;
  result.depth = nothing.depth;
  result.position = nothing.position;
  result.object_index = result.material_index = 0.0f;
}

void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface, const Shaded &shaded,
                          double t, SampleResult &result) {
  record_place(scene, surface, shaded, t, result);
  result.normal = mean_normal(shaded.bsdf);
  if (settings.passes & 1u << LANCER_PASS_UV)
    result.uv = glm::vec3(attributes_at(scene.geometry, surface).uv, 1.0f);
}

float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface) {
  const double distance = glm::length(surface.p - camera.to_world.translation) / scene.normalisation.scale;
  // Without a depth there is none, as in Cycles.
  if (!(settings.mist_depth > 0.0f))
    return 0.0f;
  const double ratio = std::clamp((distance - double(settings.mist_start)) / double(settings.mist_depth), 0.0, 1.0);
  return float(std::pow(ratio, double(settings.mist_falloff)));
}

} // namespace lancer
