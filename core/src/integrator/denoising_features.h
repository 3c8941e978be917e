// Albedo, normal and depth for denoisers: of the first surface that is not mostly a mirror, seen through those before it.
#pragma once

#include "integrator/sample.h"
#include "integrator/shading.h"

namespace lancer {

// What is left of a camera path's features after the mirrors so far.
struct DenoisingFeatures {
  bool open = false; // the surface that counts is still to come
  glm::vec3 beta{1.0f};
};

// Takes in the surface at hand, which lies `distance` (normalised units) behind the last one.
void add_denoising_features(const Scene &scene, const Camera &camera, const Shaded &shaded, double distance,
                            DenoisingFeatures &features, SampleResult &result);

} // namespace lancer
