// The passes of the film: their channels, their place in a sample, and the step from a sum to a picture.
#pragma once

#include "integrator/sample.h"
#include "lancer.h"

namespace lancer {

inline constexpr uint32_t kPassCount = LANCER_PASS_COUNT;

uint32_t channels(Pass pass);
// Whether the pass stores the value of sample 0 alone: a mean of depths or indices would belong to no object.
bool of_first_sample(Pass pass);
// Returns the colour that a direct or indirect pass is divided by, or the pass itself if there is none.
Pass divisor(Pass pass);
// Returns the requested passes, together with Combined and all divisors.
uint32_t kept_passes(uint32_t passes);

// Returns the index of a pass's first channel among the floats of a sample.
uint32_t place_in_sample(Pass pass);

// Divides light by its colour. A channel without colour gets the mean of the other channels that have colour; without any
// colour, the quotient is 0.
glm::dvec3 divide_by_color(const glm::dvec3 &light, const glm::dvec3 &color);

} // namespace lancer
