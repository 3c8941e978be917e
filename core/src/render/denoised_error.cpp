#include "render/denoised_error.h"

#include "render/picture_error.h"
#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Products of differences, whose means over neighbourhoods tell squared errors.
struct Products {
  Numbers apart, noise, common, kept;

  explicit Products(const Differences &of)
      : apart(times(of.apart, of.apart)), noise(times(of.noise, of.noise)), common(times(of.kept, of.noise)),
        kept(times(of.kept, of.kept)) {}
};

// Returns the squared error at each place, from means over neighbourhoods that reach so far. step: of the kept places.
template <uint32_t step = 1> Numbers squared_errors(const Products &of, int reach) {
  const std::vector<float> kernel = tent(reach);
  const Numbers apart = convolved<step>(of.apart, kernel), noise = convolved<step>(of.noise, kernel);
  const Numbers common = convolved<step>(of.common, kernel), kept = convolved<step>(of.kept, kernel);
  Numbers result(apart.width, apart.height);
  for (size_t i = 0; i < result.values.size(); ++i) {
    // The product of kept noise and noise is the variance that is left: squares of the kept noise would include the difference
    // of two results that no noise causes.
    const float left = std::max(common.values[i], 0.0f);
    // The noise of Y - Z.
    const float taken = std::max(noise.values[i] - 2.0f * left + std::min(kept.values[i], left), 0.0f);
    // Noise is told too large where the variance falls faster than 1 / N: Y - Z shows by how much at least, as far as noise is
    // taken.
    const float told = apart.values[i] < taken ? (apart.values[i] + left) / (taken + left) : 1.0f;
    result.values[i] = std::max(apart.values[i] - taken, 0.0f) + told * left;
  }
  return result;
}

// Reaches of the neighbourhoods for the error's middle and the two ends of its interval.
constexpr int kReach = 9, kFarReach = 33, kNearReach = 5;

constexpr int kBlockReach = 3; // in blocks

// Returns the factor by which Student's t exceeds the Gaussian number of a confidence, where a variance is the mean of squares
// with the weights of a neighbourhood: the first terms of its series (Abramowitz, Stegun, 26.7.5).
double few_squares(int reach, double confidence) {
  double weights = 0.0;
  const std::vector<float> kernel = tent(reach);
  for (size_t i = 0; i < kernel.size(); ++i)
    weights += (i > 0 ? 2.0 : 1.0) * double(kernel[i]) * double(kernel[i]);
  const double squares = 1.0 / (weights * weights), z = gaussian_reach(confidence);
  return 1.0 + (z * z + 1.0) / (4.0 * squares);
}

double root_mean(const Numbers &squares) {
  double sum = 0.0;
  for (const float square : squares.values)
    sum += double(square);
  return std::sqrt(sum / double(squares.values.size()));
}

// Returns the factor by which a root mean square over pixels may be wrong: its spread as for the error of a picture, with the
// pixels of a neighbourhood as one.
double uncertainty(const Numbers &squares, double pixels_of_one, double confidence) {
  double sum = 0.0, fourth = 0.0;
  for (const float square : squares.values) {
    sum += double(square);
    fourth += double(square) * double(square);
  }
  const double spread = sum > 0.0 ? 0.5 * std::sqrt(2.0 * fourth * pixels_of_one) / sum : 0.0;
  return exp(gaussian_reach(confidence) * spread);
}

} // namespace

void Differences::multiply(size_t pixel, double factor) {
  for (Numbers *numbers : {&apart, &noise, &kept}) {
    float &value = numbers->values[pixel];
    value = std::clamp(float(double(value) * factor), -kMostRelative, kMostRelative);
  }
}

Differences Differences::blocks(uint32_t side) const {
  Differences result((apart.width + side - 1) / side, (apart.height + side - 1) / side);
  Numbers counts = result.apart;
  for (uint32_t y = 0; y < apart.height; ++y)
    for (uint32_t x = 0; x < apart.width; ++x) {
      result.apart.row(y / side)[x / side] += apart.row(y)[x];
      result.noise.row(y / side)[x / side] += noise.row(y)[x];
      result.kept.row(y / side)[x / side] += kept.row(y)[x];
      counts.row(y / side)[x / side] += 1.0f;
    }
  for (Numbers *sums : {&result.apart, &result.noise, &result.kept})
    for (size_t i = 0; i < sums->values.size(); ++i)
      sums->values[i] /= counts.values[i];
  return result;
}

// A neighbourhood that is small tells noise as error, since no squared error is negative;
// one that is large hides errors of few pixels in the noise of the others: the one serves the upper end, the other the lower
// end. Means over neighbourhoods differ little from pixel to pixel, so that some of them suffice.
DenoisedError denoised_error(const Differences &to_result, const Differences &to_known, double confidence) {
  constexpr uint32_t kStep = 2;
  constexpr double kPixelsOfOne = double(kReach * kReach) / (kStep * kStep);
  const Products low(to_result), high(to_known);
  const Numbers low_squares = squared_errors<kStep>(low, kReach), high_squares = squared_errors<kStep>(high, kReach);
  const double least = root_mean(low_squares), most = root_mean(high_squares);
  const double far = root_mean(squared_errors<4 * kStep>(low, kFarReach)),
               near = root_mean(squared_errors<kStep>(high, kNearReach));
  return {.error = std::sqrt(least * most),
          .low = std::min({far, least, most}) / uncertainty(low_squares, kPixelsOfOne, confidence),
          .high = std::max({near, least, most}) * uncertainty(high_squares, kPixelsOfOne, confidence)};
}

std::vector<float> denoised_bars(const Differences &of, uint32_t block, double confidence) {
  const int reach = block > 1 ? kBlockReach : kReach;
  const double widened = few_squares(reach, confidence);
  std::vector<float> bars = squared_errors(Products(block > 1 ? of.blocks(block) : of), reach).values;
  for (float &bar : bars)
    bar = float(widened * std::sqrt(double(bar)));
  return bars;
}

} // namespace lancer
