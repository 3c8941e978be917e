// The error of a picture Z that depends on a noisy picture Y, from its response to noise like that of Y.
#pragma once

#include "render/neighbourhood.h"

namespace lancer {

// The error of the result Z, in the unit of lancer_error.
struct DenoisedError {
  double error = 0.0, low = 0.0, high = 0.0; // with the interval at the requested confidence
  // Relative root mean square of the light by which the means of blocks of D differ from those of Y beyond noise.
  double moved = 0.0;
};

// Bound of relative numbers, so that fourth powers fit into floats.
inline constexpr float kMostRelative = 1e8f;

// Luminances from which errors follow: the difference Z - Y, the noise H, and the noise Hz that Z keeps.
struct Differences {
  Numbers apart, noise, kept;

  Differences(uint32_t width, uint32_t height) : apart(width, height), noise(width, height), kept(width, height) {}

  void multiply(size_t pixel, double factor);

  // Returns the means over blocks; blocks at the right and upper edge may be smaller.
  Differences blocks(uint32_t side) const;
};

// The squared error of a Z that depends on Y is the square of its bias plus its variance. Where Hz is the change of Z by the
// change H of Y, the variance is the mean of Hz H and the squared bias that of (Z - Y)^2 - (H - Hz)^2 (Stein, "Estimation of
// the mean of a multivariate normal distribution", 1981; Ramani, Blu, Unser, "Monte-Carlo SURE", 2008, take random H; Firmino,
// Frisvad, Jensen, "Progressive denoising of Monte Carlo rendered images", 2022, combine pictures by it). Means over
// neighbourhoods make both certain; neither is negative.
//
// Returns the error without moved. to_result: differences relative to the luminance of the result; to_known: to that without
// bright pixels that Y does not know. A bright pixel is a small light or an error, which is no measure of itself: the first
// ones tell the lower end of the interval, the others the upper end, and the error lies between both.
DenoisedError denoised_error(const Differences &to_result, const Differences &to_known, double confidence);

// Returns the standard error of each pixel, in the unit of the differences, or of the mean of each block with this side.
// confidence: at which the bars are to hold, widened since few squares tell them.
std::vector<float> denoised_bars(const Differences &of, uint32_t block, double confidence);

} // namespace lancer
