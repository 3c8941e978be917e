#include "render/picture_error.h"

#include "render/alike.h"
#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Squares of pixels within which unmet light is bounded, and the rule of three: what has not come up in m samples has, at 95 %,
// a probability below 3 / m.
constexpr uint32_t kSquare = 16;
constexpr double kThree = 3.0;

// z such that a Gaussian number lies within +- z with this probability.
double gaussian_reach(double confidence) {
  double low = 0.0, high = 40.0;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (erf(middle / std::sqrt(2.0)) < confidence ? low : high) = middle;
  }
  return low;
}

double mean_over(const LuminanceMap &map, const std::vector<float> &variance) {
  double sum = 0.0;
  for (size_t i = 0; i < variance.size(); ++i)
    sum += double(variance[i]) / map.count[i];
  return sum / double(variance.size());
}

double unmet(const LuminanceMap &map) {
  const double floor = map.floor();
  double sum = 0.0;
  for (uint32_t y0 = 0; y0 < map.height; y0 += kSquare) {
    for (uint32_t x0 = 0; x0 < map.width; x0 += kSquare) {
      const uint32_t x1 = std::min(x0 + kSquare, map.width), y1 = std::min(y0 + kSquare, map.height);
      double samples = 0.0, mean = 0.0, brightest = 0.0;
      for (uint32_t y = y0; y < y1; ++y)
        for (uint32_t x = x0; x < x1; ++x) {
          const size_t i = size_t(y) * map.width + x;
          samples += map.count[i];
          mean += std::max(map.mean[i], 0.0f);
          brightest = std::max(brightest, double(map.brightest[i]));
        }
      const double pixels = double(x1 - x0) * (y1 - y0), level = mean / pixels + floor;
      if (level > 0.0) {
        const double missing = kThree * brightest / samples / level;
        sum += pixels * missing * missing;
      }
    }
  }
  return std::sqrt(sum / double(map.size()));
}

} // namespace

RelativeVariance::RelativeVariance(const LuminanceMap &map) : own(map.size()), shared(map.size()) {
  const AlikeNeighbours alike(map);
  const float floor = map.floor();
  for (size_t pixel = 0; pixel < map.size(); ++pixel) {
    const float level = std::max(alike.mean[pixel] / alike.count[pixel], 0.0f) + floor;
    const float scale = level > 0.0f ? 1.0f / (level * level) : 0.0f;
    own[pixel] = map.variance[pixel] * scale;
    shared[pixel] = alike.variance[pixel] / alike.count[pixel] * scale;
  }
}

PictureError picture_error(const LuminanceMap &map, const RelativeVariance &relative, double confidence) {
  PictureError result;
  if (!map.known)
    return result;
  const double low = std::sqrt(mean_over(map, relative.own)), high = std::sqrt(mean_over(map, relative.shared));
  // The sum of squares of real errors and that of the measured ones each spread as chi-square: of Gaussian errors by 4/3 of the
  // sum of squares of what was measured, of others by more.
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < map.size(); ++i) {
    const double value = double(relative.own[i]) / map.count[i];
    sum += value;
    squares += value * value;
  }
  constexpr double kSpread = 2.0;
  const double spread = sum > 0.0 ? 0.5 * std::sqrt(kSpread * squares) / sum : 0.0;
  const double reach = exp(gaussian_reach(confidence) * spread);
  result.low = std::min(low, high) / reach;
  result.high = std::max(low, high) * reach;
  result.error = std::sqrt(low * high);
  result.cannot_exclude = unmet(map);
  return result;
}

} // namespace lancer
