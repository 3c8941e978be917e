// Smooth glass: reflected with probability F, else refracted.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/mirror.h"

namespace lancer {

// wo.z > 0; the lobe's index is that of the far side over that of the near one. u in [0, 1).
// The radiance is not scaled with 1/eta^2 on the way through: a path that leaves the glass again would undo it, and Cycles,
// with which pictures agree, does without it for lights and cameras inside glass, too.
inline DeltaDirection dielectric_sample(const Lobe &lobe, const glm::vec3 &wo, float u) {
  const float eta = lobe.ior;
  if (eta == 1.0f)
    return {-wo, 1.0f, 1.0f};
  const Fresnel boundary = fresnel(wo.z, eta);
  // Both choices carry their share as probability, so that the weight stays 1.
  if (u < boundary.reflectance)
    return {reflect_local(wo), 1.0f, boundary.reflectance};
  return {refract_local(wo, eta, boundary.cos_t), 1.0f, 1.0f - boundary.reflectance};
}

} // namespace lancer
