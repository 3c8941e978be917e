#include "render/denoised.h"

#include "render/picture_error.h"
#include "render/residual.h"
#include "sampling/elementary.h"
#include "simd/vectors.h"

#include <algorithm>
#include <array>
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

// Returns the squared error at each place, from means over neighbourhoods that reach so far.
Numbers squared_errors(const Differences &of, int reach) {
  const std::vector<float> kernel = tent(reach);
  const auto mean_of = [&](const Numbers &a, const Numbers &b) {
    Numbers product(a.width, a.height);
    for (size_t i = 0; i < product.values.size(); ++i)
      product.values[i] = a.values[i] * b.values[i];
    return convolved<float>(product, kernel);
  };
  const Numbers apart = mean_of(of.apart, of.apart), noise = mean_of(of.noise, of.noise);
  const Numbers common = mean_of(of.kept, of.noise), kept = mean_of(of.kept, of.kept);
  Numbers result(apart.width, apart.height);
  for (size_t i = 0; i < result.values.size(); ++i) {
    // The product of kept noise and noise is the variance that is left: squares of the kept noise would include the difference
    // of two results that no noise causes.
    const float left = std::max(common.values[i], 0.0f);
    // The noise of Y - Z.
    const float taken = std::max(noise.values[i] - 2.0f * left + std::min(kept.values[i], left), 0.0f);
    // Noise is told too large where the variance falls faster than 1 / N: Y - Z shows by how much at least.
    const float told = apart.values[i] < taken ? apart.values[i] / taken : 1.0f;
    result.values[i] = std::max(apart.values[i] - taken, 0.0f) + told * left;
  }
  return result;
}

// Reaches of the neighbourhoods for the error's middle and the two ends of its interval.
constexpr int kReach = 9, kFarReach = 33, kNearReach = 5;

constexpr int kBlockReach = 3; // in blocks

double root_mean(const Numbers &squares) {
  double sum = 0.0;
  for (const float square : squares.values)
    sum += double(square);
  return std::sqrt(sum / double(squares.values.size()));
}

// A neighbourhood that is small tells noise as error, since no squared error is negative; one that is large hides errors of few
// pixels in the noise of the others. These are the two ends of the interval, widened by the spread of sums over pixels.
DenoisedError error_of(const Differences &of, double confidence) {
  const Numbers squares = squared_errors(of, kReach);
  const double middle = root_mean(squares), far = root_mean(squared_errors(of, kFarReach)),
               near = root_mean(squared_errors(of, kNearReach));
  double sum = 0.0, fourth = 0.0;
  for (const float square : squares.values) {
    sum += double(square);
    fourth += double(square) * double(square);
  }
  // As for the error of a picture, with the pixels of a neighbourhood as one.
  const double spread = sum > 0.0 ? 0.5 * std::sqrt(2.0 * fourth * kReach * kReach) / sum : 0.0;
  const double reach = exp(gaussian_reach(confidence) * spread);
  return {.error = middle, .low = std::min(far, middle) / reach, .high = std::max(near, middle) * reach};
}

// Standard errors of the picture within which the luminance of a pixel may change. Fewer would keep noise: of Gaussian errors,
// 0.3 % exceed this number.
constexpr double kMostErrors = 3.0;

// Returns the share of the way from a pixel's luminance back to that of the picture, until they are close enough. All in one
// unit.
double way_back(double apart, double noise, double error) {
  const double allowed = kMostErrors * std::max(std::abs(noise), error);
  return std::abs(apart) > allowed ? 1.0 - allowed / std::abs(apart) : 0.0;
}

// Returns the lower one of each number and the median of the 3 x 3 numbers around it: without single bright pixels, whose own
// luminance would hide that they are wrong.
std::vector<double> without_peaks(const std::vector<double> &values, uint32_t width, uint32_t height) {
  std::vector<double> result(values.size());
  std::array<double, 9> near;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      size_t count = 0;
      for (int64_t dy = -1; dy <= 1; ++dy)
        for (int64_t dx = -1; dx <= 1; ++dx)
          near[count++] = values[size_t(mirrored(y + dy, height)) * width + mirrored(x + dx, width)];
      std::nth_element(near.begin(), near.begin() + 4, near.end());
      result[size_t(y) * width + x] = std::min(values[size_t(y) * width + x], near[4]);
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
  std::vector<double> results(pixels); // luminances
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
    sum += results[i] = std::abs(luminance(result));
  }
  // Relate differences to the result: a wrong denoised pixel is no measure of its own error.
  results = without_peaks(results, width, height);
  for (size_t i = 0; i < pixels && sum > 0.0; ++i) {
    const double factor = scale.of(i) / (results[i] + 0.01 * sum / double(pixels));
    for (Numbers *values : {&of.apart, &of.noise, &of.kept})
      values->values[i] = std::clamp(float(double(values->values[i]) * factor), -kMost, kMost);
  }
  const auto absolute = [&](size_t i) {
    return (sum > 0.0 ? results[i] + 0.01 * sum / double(pixels) : scale.of(i)) / scale.unit;
  };
  // Estimate the error of the result.
  DenoisedError error = error_of(of, confidence);
  error.moved = moved;
  for (size_t i = 0; i < pixels; ++i)
    for (Numbers *values : {&of.apart, &of.noise, &of.kept})
      values->values[i] = std::clamp(float(double(values->values[i]) * absolute(i)), -kMost, kMost);
  const Numbers squares = block > 1 ? squared_errors(of.blocks(block), kBlockReach) : squared_errors(of, kReach);
  bars.resize(squares.values.size());
  for (size_t i = 0; i < bars.size(); ++i)
    bars[i] = nearest_float(scale.unit * std::sqrt(double(squares.values[i])));
  return error;
}

} // namespace lancer
