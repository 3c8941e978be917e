// The combination of a picture with two denoised versions of it that has the least error, and the error of the combination.
#pragma once

#include "render/denoised_error.h"

#include <vector>

namespace lancer {

// Pictures are [height][width][3], linear colours.
//   noisy: the picture Y. noise: half the difference H of two halves of its samples (Pass::Halves), which has the variance of Y
//   and is independent of the noise of Y.
//   first, second: a denoiser's results for Y + step H and Y - step H. Their mean is the denoised picture D. Their difference
//   over 2 step, G, is the part of the noise that the denoiser leaves, since it is the response to noise like that of Y.
struct DenoisedInput {
  uint32_t width, height;
  const float *noisy, *noise;
  const float *errors; // [height][width]: standard error of the luminance of each pixel of Y, which tells small lights
                       // from errors; null: not known
  const float *first, *second;
  double step;
  bool combines; // false: the result is D
};

// Writes the result to picture, [height][width][3], and the standard error of the mean luminance of each block of the result to
// bars, [blocks in height][blocks in width]; block: its side in pixels; 1: each pixel. Blocks at the right and upper edge may
// be smaller.
//
// Z is D plus the share of the residual Y - D that is not noise (residual.h). Each luminance lies between those of D and Y, or
// a little beyond.
DenoisedError combine_denoised(const DenoisedInput &input, double confidence, uint32_t block, float *picture,
                               std::vector<float> &bars);

} // namespace lancer
