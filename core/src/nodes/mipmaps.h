// The levels of an image with mipmaps, as Cycles makes them for its texture cache.
#pragma once

#include "scene/image.h"

namespace lancer {

// Computes the levels above the first of an image of rows; its colour is already multiplied by alpha. A level averages the
// decoded colours of the one before, two texels along each side; along an odd side it interpolates linearly. Each level is
// rounded to the image's bit depth, but the next is made from the numbers before that rounding.
void make_mipmaps(Image &image);

} // namespace lancer
