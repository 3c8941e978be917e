// Albedo, normal and depth for denoisers: of the first surface that is not mostly a mirror, seen through those before it; or,
// as Blender 5.2 has it, of all surfaces, each by how much of it is matt.
#pragma once

#include "integrator/lobe_means.h"
#include "integrator/sample.h"
#include "integrator/shading.h"

namespace lancer {

// What is left of a camera path's features after the mirrors so far.
struct DenoisingFeatures {
  bool open = false; // the surface that counts is still to come
  bool first = true; // nothing has been met yet
  bool blended = false;
  float share = 1.0f; // of the pixel's sample, where a path has split
  glm::vec3 beta{1.0f};
};

// Of a camera path that begins.
DenoisingFeatures begin_features(const IntegratorSettings &settings, bool wanted);

// Takes in the surface at hand, which lies `distance` (normalised units) behind the last one.
void add_denoising_features(const Scene &scene, const Camera &camera, const Mixture<float> &mixture, const glm::vec3 &wo,
                            const glm::vec3 &transmittance, double distance, DenoisingFeatures &features, SampleResult &result);
// The camera sees the sky behind what let it pass.
void add_sky_features(const DenoisingFeatures &features, SampleResult &result);

} // namespace lancer
