// Lambert: the same radiance in every direction on the side of the normal.
#pragma once

#include "bsdf/lobe_value.h"
#include "sampling/warp.h"

namespace lancer {

// f cos, which is also the density of lambert_sample.
inline float lambert_eval(const glm::vec3 &wi) { return warp_cosine_hemisphere_pdf(wi.z); }

inline glm::vec3 lambert_sample(glm::vec2 u) { return warp_cosine_hemisphere(u); }

} // namespace lancer
