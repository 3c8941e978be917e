#include "integrator/aov/first_surface.h"

#include "sampling/elementary.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lancer {

void record_place(const Scene &scene, const Surface &surface, const MaterialView &material, double t, SampleResult &result) {
  result.depth = nearest_float(t / scene.normalisation.scale);
  result.position = nearest_float(scene.normalisation.to_world(surface.p));
  result.object_index = float(scene.geometry.instances[surface.instance].object_index);
  result.material_index = float(material.index);
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
  if (!(settings.passes & bit(Pass::Uv)))
    return;
  // A mesh without a UV map shows nothing, not even the third channel.
  const Instance &instance = scene.geometry.instances[surface.instance];
  if (instance.kind != ShapeKind::Mesh || !scene.geometry.meshes[instance.mesh].uvs.empty())
    result.uv = glm::vec3(attributes_at(scene.geometry, surface).uv, 1.0f);
}

void record_seen(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const LightPasses &passes,
                 const Surface &surface, const SurfaceStage &stage, uint32_t lane, const glm::vec3 &weight,
                 SampleResult &result) {
  if (passes.mist())
    result.mist += (1.0f - mist_at(scene, camera, settings, surface)) * mean(weight * stage.opacity(lane));
  for (uint32_t component = 0; component < 3 && passes.components(); ++component)
    result.light[kLightComponents + 3 * component + 2] += weight * get(stage.means().shown[component], lane);
}

float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface) {
  // An orthographic camera measures along its axis.
  const bool parallel = camera.kind == CameraKind::Orthographic;
  const double way = parallel ? std::abs(camera.depth(surface.p)) : glm::length(surface.p - camera.to_world.translation);
  const double distance = way / scene.normalisation.scale;
  // A depth of 0 gives no mist, as in Cycles.
  if (!(settings.mist_depth > 0.0f))
    return 0.0f;
  const double ratio = std::clamp((distance - double(settings.mist_start)) / double(settings.mist_depth), 0.0, 1.0);
  // The falloffs that Blender offers.
  const float x = float(ratio), falloff = settings.mist_falloff;
  return falloff == 1.0f ? x : falloff == 2.0f ? x * x : falloff == 0.5f ? std::sqrt(x) : pow(x, falloff);
}

namespace {

// Returns the distance of the near clipping surface in the unit direction d: a plane, or a sphere for a panorama.
double near_distance(const Camera &camera, const glm::dvec3 &d) {
  if (camera.is_panorama())
    return camera.clip_start;
  return camera.clip_start / -glm::dot(d, camera.to_world.linear[2]);
}

} // namespace

DenoisingGuides begin_guides(const IntegratorSettings &settings, bool wanted) {
  DenoisingGuides guides;
  guides.open = wanted;
  guides.blended = settings.blended_features;
  return guides;
}

void add_guide_distance(const Scene &scene, const Camera &camera, const glm::vec3 &wo, double distance, DenoisingGuides &guides,
                        SampleResult &result) {
  // Subtract the distance of the near clipping surface, or the counted part.
  distance -= guides.first ? near_distance(camera, glm::dvec3(-wo)) : std::exchange(guides.counted, 0.0);
  guides.first = false;
  result.denoising_depth += guides.share * mean(guides.beta) * nearest_float(distance / scene.normalisation.scale);
}

void add_denoising_guides(const Scene &scene, const Camera &camera, const Mixture<float> &mixture, const glm::vec3 &wo,
                          const glm::vec3 &transmittance, double distance, DenoisingGuides &guides, SampleResult &result) {
  add_guide_distance(scene, camera, wo, distance, guides, result);
  const glm::vec3 normal = camera.direction_to_camera(glm::dvec3(mixture.normal));
  if (guides.blended) {
    // Add the matt share, or all lobes where half of them is matt; the rest and the transmitted light continue to the next
    // surface.
    const float here = mixture.all > 0.0f ? smooth_step(mixture.matt / (0.5f * mixture.all)) : 0.0f;
    const float passing = mean(transmittance);
    if (!guides.scattered) {
      result.specular_albedo += guides.share * guides.beta * mixture.specular;
      result.roughness += guides.share * mean(guides.beta) * mixture.roughness;
    }
    const float solid = mixture.all > 0.0f ? mixture.all / (mixture.all + passing) : 0.0f;
    result.albedo += guides.share * here * guides.beta * mixture.diffuse;
    result.denoising_normal += guides.share * here * solid * mean(guides.beta) * normal;
    guides.beta *= mixture.specular * (1.0f - here) + transmittance;
    guides.open = largest(guides.beta) > 0.0f;
    return;
  }
  // At least three quarters are mirror-like: use the surface in the reflection.
  if (mixture.all > 0.0f && mixture.matt * 4.0f <= mixture.all) {
    guides.beta *= mixture.specular;
    return;
  }
  guides.open = false;
  result.albedo += guides.share * guides.beta * mixture.diffuse;
  result.denoising_normal += guides.share * normal;
}

void add_sky_guides(const DenoisingGuides &guides, SampleResult &result) {
  if (guides.open && guides.blended)
    result.denoising_depth = std::numeric_limits<float>::max();
}

} // namespace lancer
