#include "render/denoised.h"

#include "render/residual.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lancer {

namespace {

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
    return glm::clamp(glm::vec3(value / levels_[i]), glm::vec3(-kMostRelative), glm::vec3(kMostRelative));
  }

  double unit = 1.0; // mean luminance

private:
  std::vector<double> levels_;
};

// Standard errors of the picture by which the luminance of a pixel may be too bright: of Gaussian errors, 0.3 % exceed this
// number.
constexpr double kMostErrors = 3.0;

float median(float a, float b, float c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

// Returns the median of the 3 x 3 numbers around each one.
Numbers medians(const Numbers &values) {
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
      to[x] = median(std::max(std::max(least[x], least[x + 1]), least[x + 2]), median(middle[x], middle[x + 1], middle[x + 2]),
                     std::min(std::min(most[x], most[x + 1]), most[x + 2]));
  }
  return result;
}

// Share of the median residual by which a change may go beyond the pixel's residual. With 1, rings are seen; with 0, half of
// the moved light does not come back.
constexpr float kBeyond = 0.25f;

// Returns for each pixel the share of its change that stays. Where bands keep different shares of a bright pixel, rings around
// the pixel would remain: the luminance changes from that of D towards that of Y, and beyond both by a small part of the median
// residual around the pixel, which includes light that D has moved.
Numbers shares_without_rings(const Colors &residual, const Colors &change) {
  Numbers of(residual.width, residual.height), result = of;
  for (size_t i = 0; i < of.values.size(); ++i)
    of.values[i] = std::abs(luminance(residual.values[i]));
  const Numbers around = medians(of);
  for (size_t i = 0; i < of.values.size(); ++i) {
    const float own = luminance(residual.values[i]), changed = luminance(change.values[i]);
    const float most = (own * changed > 0.0f ? std::abs(own) : 0.0f) + kBeyond * around.values[i];
    result.values[i] = std::abs(changed) > most ? most / std::abs(changed) : 1.0f;
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
  Numbers stays(width, height);
  if (input.combines) {
    const Colors residual = level.residual;
    keep_shares(level);
    stays = shares_without_rings(residual, level.residual);
  }
  double sum = 0.0;
  Numbers results(width, height); // luminances
  for (size_t i = 0; i < pixels; ++i) {
    const glm::vec3 kept = input.combines ? stays.values[i] * level.residual.values[i] : glm::vec3(0.0f);
    const glm::dvec3 result = denoised(i) + glm::dvec3(kept) * scale.of(i);
    if (input.combines) {
      of.apart.values[i] += luminance(kept);
      of.kept.values[i] += stays.values[i] * luminance(level.taken.values[i]);
    }
    for (int c = 0; c < 3; ++c)
      picture[3 * i + size_t(c)] = nearest_float(result)[c];
    results.values[i] = std::abs(luminance(nearest_float(result)));
    sum += double(results.values[i]);
  }
  // Express differences in mean luminances, and find the luminances without single bright pixels that the picture does not
  // know: their own luminance would hide that they are wrong.
  Numbers known = medians(results);
  for (size_t i = 0; i < pixels; ++i) {
    known.values[i] = std::min(known.values[i], results.values[i]);
    if (input.errors) {
      const double error = std::max(std::abs(luminance(Scale::color(input.noise, i))), double(input.errors[i]));
      known.values[i] = std::max(known.values[i], float(double(results.values[i]) - kMostErrors * error));
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
  DenoisedError error = denoised_error(relative_to(results), relative_to(known), confidence);
  error.moved = moved;
  bars = denoised_bars(of, block, confidence);
  for (float &bar : bars)
    bar = nearest_float(scale.unit * double(bar));
  return error;
}

} // namespace lancer
