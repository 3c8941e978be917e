#include "integrator/denoising_features.h"

#include "sampling/color.h"
#include "sampling/nearest_float.h"

#include <cmath>
#include <limits>

namespace lancer {

namespace {

// Lobes up to this alpha show what they mirror more than themselves.
constexpr float kMirrorLike = 0.075f;

float smooth_step(float x) {
  const float t = std::clamp(x, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// How much of a lobe is matt rather than a mirror: 0 or 1, or blended over twice the limit.
float matt_share(const Lobe &lobe, bool blended) {
  float alpha = 0.0f;
  switch (lobe.shape) {
  case LobeShape::Mirror:
  case LobeShape::Dielectric:
    break;
  case LobeShape::Beckmann:
  case LobeShape::Microfacet:
  case LobeShape::Ashikhmin:
    alpha = std::sqrt(lobe.alpha_x * lobe.alpha_y);
    break;
  default:
    return 1.0f;
  }
  if (blended)
    return smooth_step(alpha / (2.0f * kMirrorLike));
  return alpha > kMirrorLike ? 1.0f : 0.0f;
}

// All that a surface scatters, by how matt it is.
struct Mixture {
  glm::vec3 normal{0.0f}, diffuse{0.0f}, specular{0.0f};
  float all = 0.0f, matt = 0.0f;
};

// Without blending what passes straight on is a mirror, too.
Mixture mix(const Shaded &shaded, bool blended) {
  Mixture mixture;
  if (!blended) {
    mixture.specular = shaded.transmittance;
    mixture.all = mean(shaded.transmittance);
    mixture.normal = mixture.all * shaded.bsdf.ns;
  }
  for (int i = 0; i < shaded.bsdf.count; ++i) {
    const Lobe &lobe = shaded.bsdf.lobes[i];
    const float weight = mean(lobe.albedo), share = matt_share(lobe, blended);
    mixture.normal += weight * shaded.bsdf.frames[lobe.frame].n;
    mixture.all += weight;
    mixture.matt += share * weight;
    mixture.diffuse += share * lobe.albedo;
    mixture.specular += (1.0f - share) * lobe.albedo;
  }
  if (mixture.all > 0.0f)
    mixture.normal /= mixture.all;
  return mixture;
}

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

void add_denoising_features(const Scene &scene, const Camera &camera, const Shaded &shaded, double distance,
                            DenoisingFeatures &features, SampleResult &result) {
  // Count from where the camera begins to see.
  if (features.first)
    distance -= near_distance(camera, glm::dvec3(-shaded.bsdf.wo));
  features.first = false;
  result.denoising_depth += features.share * mean(features.beta) * nearest_float(distance / scene.normalisation.scale);
  const Mixture mixture = mix(shaded, features.blended);
  const glm::vec3 normal = camera.direction_to_camera(glm::dvec3(mixture.normal));
  if (features.blended) {
    // Give what is matt, and all where that is half of it; the rest and what passes straight on wait for the next surface.
    const float here = mixture.all > 0.0f ? smooth_step(mixture.matt / (0.5f * mixture.all)) : 0.0f;
    const float passing = mean(shaded.transmittance);
    const float solid = mixture.all > 0.0f ? mixture.all / (mixture.all + passing) : 0.0f;
    result.albedo += features.share * here * features.beta * mixture.diffuse;
    result.denoising_normal += features.share * here * solid * mean(features.beta) * normal;
    features.beta *= mixture.specular * (1.0f - here) + shaded.transmittance;
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
