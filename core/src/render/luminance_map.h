// What the film knows of the light of its pixels, laid out as a picture.
#pragma once

#include "render/film.h"

#include <vector>

namespace lancer {

// Luminances are in units of the picture's mean, and bounded, so that no square of them leaves the range of floats.
struct LuminanceMap {
  uint32_t width = 0, height = 0;
  bool known = true; // false: some pixel has too few samples to tell an error from
  double unit = 1.0; // mean luminance of the picture, what is negative counted as dark; 1 where all is dark
  // [height][width]; variance: of one sample, such that that of the mean is variance / count.
  std::vector<float> mean, variance, brightest, count;

  explicit LuminanceMap(const Film &film);

  size_t size() const { return mean.size(); }
  // What is added wherever something is divided by luminance, so that black pixels do not decide alone: 1 % of the mean.
  float floor() const { return dark ? 0.0f : 0.01f; }
  bool dark = false;
};

} // namespace lancer
