#include "render/denoised.h"

#include "render/picture_error.h"
#include "render/residual.h"
#include "sampling/elementary.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lancer {

namespace {

// Bound of relative colours, so that fourth powers fit into floats.
constexpr float kMost = 1e8f;

// Values are divided by the luminance of the denoised picture plus 1 % of its mean, as in the error of a picture.
class Scale {
public:
  Scale(const DenoisedInput &input) {
    const size_t pixels = size_t(input.width) * input.height;
    levels_.resize(pixels);
    double sum = 0.0;
    for (size_t i = 0; i < pixels; ++i) {
      const glm::dvec3 mean = 0.5 * (color(input.first, i) + color(input.second, i));
      sum += levels_[i] = std::abs(luminance(mean));
    }
    const bool dark = !(sum > 0.0);
    for (double &level : levels_)
      level = dark ? 1.0 : level + 0.01 * sum / double(pixels);
    unit = dark ? 1.0 : sum / double(pixels);
  }
  static glm::dvec3 color(const float *picture, size_t i) { return {picture[3 * i], picture[3 * i + 1], picture[3 * i + 2]}; }
  double of(size_t i) const { return levels_[i]; }
  glm::vec3 relative(const glm::dvec3 &value, size_t i) const {
    return glm::clamp(glm::vec3(value / levels_[i]), glm::vec3(-kMost), glm::vec3(kMost));
  }

  double unit = 1.0; // mean luminance

private:
  std::vector<double> levels_;
};

// Luminances from which errors follow: the difference Z - Y, the noise H, and the noise Hz that Z keeps.
struct Differences {
  Numbers apart, noise, kept;

  Differences(uint32_t width, uint32_t height) : apart(width, height), noise(width, height), kept(width, height) {}

  void multiply(size_t pixel, double factor) {
    for (Numbers *numbers : {&apart, &noise, &kept})
      numbers->values[pixel] = std::clamp(float(double(numbers->values[pixel]) * factor), -kMost, kMost);
  }

  // Returns the means over blocks.
  Differences blocks(uint32_t side) const {
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
};

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

// Relates differences to the luminances of the result, for the lower end of the error's interval, and to those without bright
// pixels that the picture does not know, for its upper end: a bright pixel is a small light or an error, which is no measure of
// itself. The error is between both. A neighbourhood that is small tells noise as error, since no squared error is negative;
// one that is large hides errors of few pixels in the noise of the others: the one serves the upper end, the other the lower
// end. Means over neighbourhoods differ little from pixel to pixel, so that some of them suffice.
DenoisedError error_of(const Differences &to_result, const Differences &to_known, double confidence) {
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

// Standard errors of the picture within which the luminance of a pixel may change. Fewer would keep noise: of Gaussian errors,
// 0.3 % exceed this number.
constexpr double kMostErrors = 3.0;

// Returns the largest difference of a pixel's luminance from that of the picture. All in one unit.
double most_apart(double noise, double error) { return kMostErrors * std::max(std::abs(noise), error); }

// Returns the share of the way from a pixel's luminance back to that of the picture, until they are close enough.
double way_back(double apart, double noise, double error) {
  const double allowed = most_apart(noise, error);
  return std::abs(apart) > allowed ? 1.0 - allowed / std::abs(apart) : 0.0;
}

float median(float a, float b, float c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

// Returns the lower one of each number and the median of the 3 x 3 numbers around it: without single bright pixels, whose own
// luminance would hide that they are wrong.
Numbers without_peaks(const Numbers &values) {
  const uint32_t width = values.width;
  Numbers result(width, values.height);
  // The three numbers of each column in order, with a column beyond each end of the row.
  std::vector<float> least(width + 2), middle(width + 2), most(width + 2);
  for (uint32_t y = 0; y < values.height; ++y) {
    const float *here = values.row(y), *below = values.row(mirrored(int64_t(y) - 1, values.height)),
                *above = values.row(mirrored(int64_t(y) + 1, values.height));
    for (uint32_t x = 0; x < width; ++x) {
      least[x + 1] = std::min(std::min(below[x], here[x]), above[x]);
      middle[x + 1] = median(below[x], here[x], above[x]);
      most[x + 1] = std::max(std::max(below[x], here[x]), above[x]);
    }
    for (std::vector<float> *line : {&least, &middle, &most}) {
      line->front() = (*line)[1];
      line->back() = (*line)[width];
    }
    float *to = result.row(y);
    for (uint32_t x = 0; x < width; ++x)
      to[x] = std::min(here[x], median(std::max(std::max(least[x], least[x + 1]), least[x + 2]),
                                       median(middle[x], middle[x + 1], middle[x + 2]),
                                       std::min(std::min(most[x], most[x + 1]), most[x + 2])));
  }
  return result;
}

// Side of the blocks in which moved light is looked for.
constexpr uint32_t kBlock = 16;

// Returns the root mean square of block means of the residual beyond noise.
double moved_light(const Level &level) {
  Differences of(level.residual.width, level.residual.height);
  for (size_t i = 0; i < of.apart.values.size(); ++i) {
    of.apart.values[i] = luminance(level.residual.values[i]);
    of.noise.values[i] = luminance(level.taken.values[i]);
  }
  const Differences blocks = of.blocks(kBlock);
  double sum = 0.0;
  for (size_t i = 0; i < blocks.apart.values.size(); ++i)
    sum += double(blocks.apart.values[i]) * blocks.apart.values[i] - double(blocks.noise.values[i]) * blocks.noise.values[i];
  return std::sqrt(std::max(0.0, sum / double(blocks.apart.values.size())));
}

} // namespace

DenoisedError combine_denoised(const DenoisedInput &input, double confidence, uint32_t block, float *picture,
                               std::vector<float> &bars) {
  const uint32_t width = input.width, height = input.height;
  const size_t pixels = size_t(width) * height;
  const Scale scale(input);
  // Find the residual, the noise and the part of it that the denoiser takes, all relative to the picture.
  Level level{Colors(width, height), Colors(width, height), Colors(width, height)};
  const auto denoised = [&](size_t i) { return 0.5 * (Scale::color(input.first, i) + Scale::color(input.second, i)); };
  for (size_t i = 0; i < pixels; ++i) {
    const glm::dvec3 noise = Scale::color(input.noise, i);
    const glm::dvec3 left = (Scale::color(input.first, i) - Scale::color(input.second, i)) / (2.0 * input.step);
    level.residual.values[i] = scale.relative(Scale::color(input.noisy, i) - denoised(i), i);
    level.noise.values[i] = scale.relative(noise, i);
    level.taken.values[i] = scale.relative(noise - left, i);
  }
  const double moved = moved_light(level);
  Differences of(width, height);
  for (size_t i = 0; i < pixels; ++i) {
    of.apart.values[i] = -luminance(level.residual.values[i]);
    of.noise.values[i] = luminance(level.noise.values[i]);
    of.kept.values[i] = luminance(level.noise.values[i] - level.taken.values[i]);
  }
  // Add the share of the residual that is not noise, and the noise that comes with it.
  if (input.combines)
    keep_shares(level);
  double sum = 0.0;
  Numbers results(width, height); // luminances
  for (size_t i = 0; i < pixels; ++i) {
    const glm::vec3 kept = input.combines ? level.residual.values[i] : glm::vec3(0.0f);
    glm::dvec3 result = denoised(i) + glm::dvec3(kept) * scale.of(i);
    if (input.combines) {
      of.apart.values[i] += luminance(kept);
      of.kept.values[i] += luminance(level.taken.values[i]);
    }
    // Return pixels that the picture knows better.
    if (input.combines && input.errors) {
      const glm::dvec3 noisy = Scale::color(input.noisy, i);
      const double back = way_back(luminance(result - noisy), luminance(Scale::color(input.noise, i)), double(input.errors[i]));
      result += (noisy - result) * back;
      of.apart.values[i] *= float(1.0 - back);
      of.kept.values[i] += float(back) * (of.noise.values[i] - of.kept.values[i]);
    }
    for (int c = 0; c < 3; ++c)
      picture[3 * i + size_t(c)] = nearest_float(result)[c];
    results.values[i] = std::abs(luminance(nearest_float(result)));
    sum += double(results.values[i]);
  }
  // Express differences in mean luminances, and find the luminances that the picture knows.
  Numbers known = without_peaks(results);
  for (size_t i = 0; i < pixels; ++i) {
    if (input.errors) {
      const double allowed = most_apart(luminance(Scale::color(input.noise, i)), double(input.errors[i]));
      known.values[i] = std::max(known.values[i], float(double(results.values[i]) - allowed));
    }
    of.multiply(i, scale.of(i) / scale.unit);
  }
  const auto relative_to = [&](const Numbers &luminances) {
    Differences result = of;
    for (size_t i = 0; i < pixels && sum > 0.0; ++i)
      result.multiply(i, scale.unit / (double(luminances.values[i]) + 0.01 * sum / double(pixels)));
    return result;
  };
  // Estimate the error of the result.
  DenoisedError error = error_of(relative_to(results), relative_to(known), confidence);
  error.moved = moved;
  const int reach = block > 1 ? kBlockReach : kReach;
  const Numbers squares = squared_errors(Products(block > 1 ? of.blocks(block) : of), reach);
  const double widened = scale.unit * few_squares(reach, confidence);
  bars.resize(squares.values.size());
  for (size_t i = 0; i < bars.size(); ++i)
    bars[i] = nearest_float(widened * std::sqrt(double(squares.values[i])));
  return error;
}

} // namespace lancer
