// Lambert: the same radiance in every direction on the side of wo.
#pragma once

#include "bsdf/lobe_value.h"
#include "sampling/warp.h"

namespace lancer {

inline LobeValue lambert_eval_pdf(const glm::vec3 &wi) { return {kInvPi, warp_cosine_hemisphere_pdf(wi.z)}; }

inline LobeDirection lambert_sample(const glm::vec3 &wo, glm::vec2 u) {
  const glm::vec3 wi = warp_cosine_hemisphere(u);
  return {wi, half_vector(wo, wi)};
}

} // namespace lancer
