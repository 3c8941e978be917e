#include "integrator/denoising_features.h"

#include "sampling/color.h"
#include "sampling/nearest_float.h"

#include <cmath>
#include <limits>

namespace lancer {

namespace {

// How far away the picture begins in the unit direction d: on a plane, or of a panorama on a sphere.
double near_distance(const Camera &camera, const glm::dvec3 &d) {
  if (camera.is_panorama())
    return camera.clip_start;
  return camera.clip_start / -glm::dot(d, camera.to_world.linear[2]);
}

} // namespace

DenoisingFeatures begin_features(const IntegratorSettings &settings, bool wanted) {
  DenoisingFeatures features;
  features.open = wanted;
  features.blended = settings.blended_features;
  return features;
}

void add_denoising_features(const Scene &scene, const Camera &camera, const Mixture<float> &mixture, const glm::vec3 &wo,
                            const glm::vec3 &transmittance, double distance, DenoisingFeatures &features,
                            SampleResult &result) {
  // Count from where the camera begins to see.
  if (features.first)
    distance -= near_distance(camera, glm::dvec3(-wo));
  features.first = false;
  result.denoising_depth += features.share * mean(features.beta) * nearest_float(distance / scene.normalisation.scale);
  const glm::vec3 normal = camera.direction_to_camera(glm::dvec3(mixture.normal));
  if (features.blended) {
    // Give what is matt, and all where that is half of it; the rest and what passes straight on wait for the next surface.
    const float here = mixture.all > 0.0f ? smooth_step(mixture.matt / (0.5f * mixture.all)) : 0.0f;
    const float passing = mean(transmittance);
    const float solid = mixture.all > 0.0f ? mixture.all / (mixture.all + passing) : 0.0f;
    result.albedo += features.share * here * features.beta * mixture.diffuse;
    result.denoising_normal += features.share * here * solid * mean(features.beta) * normal;
    features.beta *= mixture.specular * (1.0f - here) + transmittance;
    features.open = largest(features.beta) > 0.0f;
    return;
  }
  // Three quarters of mirror: look at what it shows.
  if (mixture.all > 0.0f && mixture.matt * 4.0f <= mixture.all) {
    features.beta *= mixture.specular;
    return;
  }
  features.open = false;
  result.albedo += features.share * features.beta * mixture.diffuse;
  result.denoising_normal += features.share * normal;
}

void add_sky_features(const DenoisingFeatures &features, SampleResult &result) {
  if (features.open && features.blended)
    result.denoising_depth = std::numeric_limits<float>::max();
}

} // namespace lancer
