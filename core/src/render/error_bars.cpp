#include "render/error_bars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lancer {

namespace {

constexpr std::array<int, 6> kRadii = {1, 2, 3, 5, 8, 12};
// (sum v)^2 / sum v^2 is how many pixels bear the variance; of n equal ones it is n / 3, since the square of one difference
// spreads as chi-square with one degree of freedom. 20 of them know their common standard error to an eighth.
constexpr double kBearers = 20.0;

// Sums over any rectangle by four look-ups.
class AreaSums {
public:
  template <class Value> AreaSums(uint32_t width, uint32_t height, Value &&value) : stride_(width + 1) {
    sums_.assign(size_t(stride_) * (height + 1), 0.0);
    for (uint32_t y = 0; y < height; ++y) {
      double row = 0.0;
      for (uint32_t x = 0; x < width; ++x) {
        row += value(size_t(y) * width + x);
        sums_[size_t(y + 1) * stride_ + x + 1] = sums_[size_t(y) * stride_ + x + 1] + row;
      }
    }
  }
  double of(uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) const {
    const double *low = sums_.data() + size_t(y0) * stride_, *high = sums_.data() + size_t(y1) * stride_;
    return std::max(0.0, (high[x1] - high[x0]) - (low[x1] - low[x0]));
  }

private:
  uint32_t stride_;
  std::vector<double> sums_;
};

} // namespace

std::vector<float> error_bars(const LuminanceMap &map) {
  const AreaSums sums(map.width, map.height, [&](size_t i) { return double(map.variance[i]); });
  const AreaSums squares(map.width, map.height, [&](size_t i) { return double(map.variance[i]) * map.variance[i]; });
  std::vector<float> bars(map.size());
  for (uint32_t y = 0; y < map.height; ++y) {
    for (uint32_t x = 0; x < map.width; ++x) {
      const size_t pixel = size_t(y) * map.width + x;
      if (map.count[pixel] == 0.0f) {
        bars[pixel] = std::numeric_limits<float>::infinity();
        continue;
      }
      // Widen the window until enough pixels in it have variance.
      double variance = 0.0;
      for (const int radius : kRadii) {
        const uint32_t x0 = uint32_t(std::max(int(x) - radius, 0)), x1 = std::min(x + uint32_t(radius) + 1, map.width);
        const uint32_t y0 = uint32_t(std::max(int(y) - radius, 0)), y1 = std::min(y + uint32_t(radius) + 1, map.height);
        const double sum = sums.of(x0, y0, x1, y1);
        variance = sum / (double(x1 - x0) * (y1 - y0));
        if (sum * sum >= kBearers * squares.of(x0, y0, x1, y1))
          break;
      }
      bars[pixel] = float(map.unit * std::sqrt(variance / map.count[pixel]));
    }
  }
  return bars;
}

} // namespace lancer
