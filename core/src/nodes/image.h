// Lookup of one point of an image.
#pragma once

#include "scene/image.h"

namespace lancer {

// Returns the colour at (u, v), (0, 0) the lower left corner and (1, 1) the upper right, in the working space; w is alpha.
// straight: divide the colour by alpha if the image's mode keeps it multiplied.
glm::vec4 lookup(const Image &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight);

// Returns the alpha only.
float lookup_alpha(const Image &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation);

// Prefetches the texels that a lookup at uv reads.
void prefetch(const Image &image, const glm::vec2 &uv, Extension extension);

} // namespace lancer
