// The combination of a picture with two denoised versions of it that has the least error, and the error of the combination.
#pragma once

#include <cstddef>
#include <cstdint>
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
  const float *errors; // [height][width]: standard error of the luminance of each pixel of Y; null: not known
  const float *first, *second;
  double step;
  bool combines; // false: the result is D
};

// The error of the result Z, in the unit of lancer_error.
struct DenoisedError {
  double error = 0.0, low = 0.0, high = 0.0; // with the interval at the requested confidence
  // Relative root mean square of the light by which the means of blocks of D differ from those of Y beyond noise.
  double moved = 0.0;
};

// Writes the result to picture, [height][width][3], and the standard error of the mean luminance of each block of the result to
// bars, [blocks in height][blocks in width]; block: its side in pixels; 1: each pixel. Blocks at the right and upper edge may
// be smaller.
//
// The squared error of a Z that depends on Y is the square of its bias plus its variance. Where Hz is the change of Z by the
// change H of Y, the variance is the mean of Hz H and the squared bias that of (Z - Y)^2 - (H - Hz)^2 (Stein, "Estimation of
// the mean of a multivariate normal distribution", 1981; Ramani, Blu, Unser, "Monte-Carlo SURE", 2008, take random H; Firmino,
// Frisvad, Jensen, "Progressive denoising of Monte Carlo rendered images", 2022, combine pictures by it). Means over
// neighbourhoods make both certain; neither is negative.
//
// Z is D plus the share of the residual Y - D that is not noise (residual.h).
//
// The luminance of a pixel of Z lies within three standard errors of Y, or three times the noise of the pixel where that is
// larger, as for a single bright sample. A pixel that Y knows, such as the black beside a lamp, keeps its value.
DenoisedError combine_denoised(const DenoisedInput &input, double confidence, uint32_t block, float *picture,
                               std::vector<float> &bars);

} // namespace lancer
