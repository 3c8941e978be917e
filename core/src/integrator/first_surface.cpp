#include "integrator/first_surface.h"

#include "sampling/color.h"
#include "sampling/elementary.h"
#include "sampling/nearest_float.h"

#include <algorithm>
#include <cmath>

namespace lancer {

void record_place(const Scene &scene, const Surface &surface, const Material *material, double t, SampleResult &result) {
  result.depth = nearest_float(t / scene.normalisation.scale);
  result.position = nearest_float(scene.normalisation.to_world(surface.p));
  result.object_index = float(scene.geometry.instances[surface.instance].object_index);
  result.material_index = material ? float(material->index) : 0.0f;
}

void forget_place(SampleResult &result) {
  const SampleResult nothing;
  result.depth = nothing.depth;
  result.position = nothing.position;
  result.object_index = result.material_index = 0.0f;
}

void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface,
                          const glm::vec3 &normal, SampleResult &result) {
  result.normal = normal;
  if (settings.passes & 1u << LANCER_PASS_UV)
    result.uv = glm::vec3(attributes_at(scene.geometry, surface).uv, 1.0f);
}

void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface, const Shaded &shaded,
                          double t, SampleResult &result) {
  record_place(scene, surface, shaded.material, t, result);
  record_first_surface(scene, settings, surface, mean_normal(shaded.bsdf), result);
}

bool cut_hole(const Scene &scene, const Surface &surface, const glm::vec3 &weight, Shaded &shaded, SampleResult &result) {
  if (scene.geometry.instances[surface.instance].holdout) {
    // All that the object would show becomes the hole.
    result.alpha -= mean(weight * shaded.opacity());
    shaded.bsdf.count = 0;
    shaded.bsdf.complete();
    shaded.emission = glm::vec3(0.0f);
    return shaded.passes();
  }
  result.alpha -= shaded.holdout * mean(weight);
  return shaded.holdout < 1.0f;
}

void record_seen(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const LightPasses &passes,
                 const Surface &surface, const Shaded &shaded, const glm::vec3 &weight, SampleResult &result) {
  if (passes.mist())
    result.mist += (1.0f - mist_at(scene, camera, settings, surface)) * mean(weight * shaded.opacity());
  for (uint32_t component = 0; component < 3 && passes.components(); ++component)
    result.light[kLightComponents + 3 * component + 2] += weight * shaded.bsdf.shown(Component(component));
}

float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface) {
  // Parallel rays count along the axis.
  const bool parallel = camera.kind == CameraKind::Orthographic;
  const double way = parallel ? std::abs(camera.depth(surface.p)) : glm::length(surface.p - camera.to_world.translation);
  const double distance = way / scene.normalisation.scale;
  // Without a depth there is none, as in Cycles.
  if (!(settings.mist_depth > 0.0f))
    return 0.0f;
  const double ratio = std::clamp((distance - double(settings.mist_start)) / double(settings.mist_depth), 0.0, 1.0);
  // The falloffs that Blender offers.
  const float x = float(ratio), falloff = settings.mist_falloff;
  return falloff == 1.0f ? x : falloff == 2.0f ? x * x : falloff == 0.5f ? std::sqrt(x) : pow(x, falloff);
}

} // namespace lancer
