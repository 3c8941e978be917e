// Looking up one place of a picture.
#pragma once

#include "scene/image.h"

namespace lancer {

// The colour at (u, v), (0, 0) the lower left corner and (1, 1) the upper right, in the working space; w is alpha. straight:
// the colour divided by alpha where the picture's mode keeps it multiplied.
glm::vec4 lookup(const Image &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight);

// The alpha alone.
float lookup_alpha(const Image &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation);

// Asks memory for the texels that a look-up there will want.
void prefetch(const Image &image, const glm::vec2 &uv, Extension extension);

} // namespace lancer
