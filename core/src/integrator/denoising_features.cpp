#include "integrator/denoising_features.h"

namespace lancer {

namespace {

float mean(const glm::vec3 &v) { return (v.x + v.y + v.z) / 3.0f; }

// Lobes up to this alpha show what they mirror more than themselves.
constexpr float kMirrorLike = 0.075f;

bool mirror_like(const Lobe &lobe) {
  switch (lobe.shape) {
  case LobeShape::Mirror:
  case LobeShape::Dielectric:
    return true;
  case LobeShape::Beckmann:
  case LobeShape::Microfacet:
  case LobeShape::Ashikhmin:
    return lobe.alpha_x * lobe.alpha_y <= kMirrorLike * kMirrorLike;
  default:
    return false;
  }
}

} // namespace

void add_denoising_features(const Scene &scene, const Camera &camera, const Shaded &shaded, double distance,
                            DenoisingFeatures &features, SampleResult &result) {
  result.denoising_depth += mean(features.beta) * float(distance / scene.normalisation.scale);
  // Weigh mirrors against the rest; what passes straight on is like a mirror.
  glm::vec3 normal(0.0f), diffuse(0.0f), specular = shaded.transmittance;
  float all = mean(shaded.transmittance), matte = 0.0f;
  normal += all * shaded.bsdf.ns;
  for (int i = 0; i < shaded.bsdf.count; ++i) {
    const Lobe &lobe = shaded.bsdf.lobes[i];
    const float weight = mean(lobe.albedo);
    normal += weight * shaded.bsdf.frames[lobe.frame].n;
    all += weight;
    if (mirror_like(lobe)) {
      specular += lobe.albedo;
    } else {
      diffuse += lobe.albedo;
      matte += weight;
    }
  }
  // Three quarters of mirror: look at what it shows.
  if (all > 0.0f && matte * 4.0f <= all) {
    features.beta *= specular;
    return;
  }
  features.open = false;
  result.albedo += features.beta * diffuse;
  if (all > 0.0f)
    normal /= all;
  // Camera space with z into the picture; of an orthonormal frame the transpose is the inverse.
  const glm::dvec3 local = glm::transpose(camera.to_world.linear) * glm::dvec3(normal);
  result.denoising_normal += glm::vec3(float(local.x), float(local.y), float(-local.z));
}

} // namespace lancer
