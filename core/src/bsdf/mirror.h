// Lobes that reflect into the mirrored direction alone.
#pragma once

#include "bsdf/frame.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

namespace lancer {

// A direction of a delta lobe: weight without the lobe's colour, and the probability of having taken it.
struct DeltaDirection {
  glm::vec3 wi{0.0f};
  float weight = 0.0f;
  float probability = 0.0f;
};

inline DeltaDirection mirror_sample(const glm::vec3 &wo) { return {reflect_local(wo), 1.0f, 1.0f}; }

// A coating too smooth to be sampled as rough: the mirror with Fresnel's weight.
inline DeltaDirection smooth_coating_sample(const Lobe &lobe, const glm::vec3 &wo) {
  return {reflect_local(wo), fresnel_dielectric(wo.z, lobe.ior), 1.0f};
}

} // namespace lancer
