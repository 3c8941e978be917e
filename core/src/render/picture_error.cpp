#include "render/picture_error.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Pixels share the variance of 7 x 7 around them, next to each other, or two or four apart ...
constexpr int kRadius = 3;
constexpr int kWider[] = {2, 4};
// ... whose luminances are within three standard deviations of theirs ...
constexpr float kSame = 9.0f;
// ... wider until enough of them bear it: see error_bars.cpp.
constexpr float kBearers = 20.0f;
// Squares of pixels within which unmet light is bounded, and the rule of three: what has not come up in m samples has, at 95 %,
// a probability below 3 / m.
constexpr uint32_t kSquare = 16;
constexpr double kThree = 3.0;

// z such that a Gaussian number lies within +- z with this probability.
double gaussian_reach(double confidence) {
  double low = 0.0, high = 40.0;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (std::erf(middle / std::sqrt(2.0)) < confidence ? low : high) = middle;
  }
  return low;
}

// Sums over the neighbours of pixels whose luminance may be the same as theirs, for a row of pixels at a time.
class Neighbours {
public:
  explicit Neighbours(const LuminanceMap &map) : map_(map), of_mean_(map.size()), sums_(map.width) {
    for (size_t i = 0; i < map.size(); ++i)
      of_mean_[i] = map.count[i] > 0.0f ? map.variance[i] / map.count[i] : 0.0f;
  }

  struct Sums {
    float variance = 0.0f, squares = 0.0f, mean = 0.0f, count = 0.0f;

    bool bear() const { return variance > 0.0f && variance * variance >= kBearers * squares; }
  };
  const std::vector<Sums> &row(int y) {
    // Go through neighbours next to each other one offset at a time: the inner loop then runs along the row.
    std::fill(sums_.begin(), sums_.end(), Sums());
    for (int dy = -kRadius; dy <= kRadius; ++dy)
      for (int dx = -kRadius; dx <= kRadius; ++dx)
        if (uint32_t(y + dy) < map_.height)
          for (int x = std::max(0, -dx); x < int(map_.width) - std::max(0, dx); ++x)
            add(place(x, y), place(x + dx, y + dy), sums_[size_t(x)]);
    // Look wider where few of them bear the variance.
    for (int x = 0; x < int(map_.width); ++x)
      for (size_t i = 0; i < std::size(kWider) && !sums_[size_t(x)].bear(); ++i)
        sums_[size_t(x)] = around(x, y, kWider[i]);
    return sums_;
  }

private:
  Sums around(int x, int y, int step) const {
    Sums sums;
    for (int dy = -kRadius * step; dy <= kRadius * step; dy += step)
      for (int dx = -kRadius * step; dx <= kRadius * step; dx += step)
        if (uint32_t(y + dy) < map_.height && uint32_t(x + dx) < map_.width)
          add(place(x, y), place(x + dx, y + dy), sums);
    return sums;
  }
  size_t place(int x, int y) const { return size_t(y) * map_.width + size_t(x); }
  void add(size_t p, size_t q, Sums &sums) const {
    const float apart = map_.mean[p] - map_.mean[q];
    const float same = apart * apart <= kSame * (of_mean_[p] + of_mean_[q]) ? 1.0f : 0.0f;
    const float variance = same * map_.variance[q];
    sums.variance += variance;
    sums.squares += variance * variance;
    sums.mean += same * map_.mean[q];
    sums.count += same;
  }

  const LuminanceMap &map_;
  std::vector<float> of_mean_; // variance
  std::vector<Sums> sums_;
};

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
  Neighbours neighbours(map);
  const float floor = map.floor();
  for (uint32_t y = 0; y < map.height; ++y) {
    const std::vector<Neighbours::Sums> &row = neighbours.row(int(y));
    for (uint32_t x = 0; x < map.width; ++x) {
      const size_t pixel = size_t(y) * map.width + x;
      const Neighbours::Sums &sums = row[x];
      const float level = std::max(sums.mean / sums.count, 0.0f) + floor;
      const float scale = level > 0.0f ? 1.0f / (level * level) : 0.0f;
      own[pixel] = map.variance[pixel] * scale;
      shared[pixel] = sums.variance / sums.count * scale;
    }
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
  const double reach = std::exp(gaussian_reach(confidence) * spread);
  result.low = std::min(low, high) / reach;
  result.high = std::max(low, high) * reach;
  result.error = std::sqrt(low * high);
  result.cannot_exclude = unmet(map);
  return result;
}

} // namespace lancer
