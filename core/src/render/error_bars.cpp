#include "render/picture_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <queue>

namespace lancer {

namespace {

// For edges the window is one size larger, because few pixels of a window are edges.
constexpr std::array<int, 7> kRadii = {1, 2, 3, 5, 8, 12, 20};
constexpr size_t kPlainRadii = 6;
// (sum v)^2 / sum v^2 is the effective number of pixels that carry the variance. For n pixels of equal noise it is n / 3,
// because each v is the square of one difference (chi-square with one degree of freedom). 20 effective pixels estimate their
// common standard error to an eighth.
constexpr double kBearers = 20.0;

// Sums over the variances in a window.
struct Sums {
  double pixels = 0.0, sum = 0.0, squares = 0.0;

  void add(double variance) {
    pixels += 1.0;
    sum += variance;
    squares += variance * variance;
  }
  bool enough() const { return pixels > 0.0 && sum * sum >= kBearers * squares; }
  double mean() const { return sum / pixels; }
  double degrees_of_freedom() const { return squares > 0.0 ? std::min(3.0 * sum * sum / squares, pixels) : pixels; }
};

// Returns Student's 95 % quantile over the Gaussian one: the factor by which an interval widens when its variance is estimated
// with this many degrees of freedom. The value is the first terms of the series in 1 / freedom (Fisher, Cornish, "The
// percentile points of distributions having known cumulants", 1960).
double student_over_gaussian(double freedom) {
  constexpr double z2 = 1.96 * 1.96, z4 = z2 * z2, z6 = z4 * z2;
  const double a = (z2 + 1.0) / 4.0, b = (5.0 * z4 + 16.0 * z2 + 3.0) / 96.0;
  const double c = (3.0 * z6 + 19.0 * z4 + 17.0 * z2 - 15.0) / 384.0;
  return 1.0 + (a + (b + c / freedom) / freedom) / freedom;
}

struct Window {
  uint32_t x0, y0, x1, y1;

  Window(const LuminanceMap &map, uint32_t x, uint32_t y, int radius)
      : x0(uint32_t(std::max(int(x) - radius, 0))), y0(uint32_t(std::max(int(y) - radius, 0))),
        x1(std::min(x + uint32_t(radius) + 1, map.width)), y1(std::min(y + uint32_t(radius) + 1, map.height)) {}
};

// Returns the sums of the smallest window with enough variances, or of the largest window. sums_of: returns the sums of a
// window.
template <class SumsOf> Sums smallest_window(const LuminanceMap &map, uint32_t x, uint32_t y, size_t radii, SumsOf &&sums_of) {
  Sums sums;
  for (size_t i = 0; i < radii && !sums.enough(); ++i)
    sums = sums_of(Window(map, x, y, kRadii[i]));
  return sums;
}

// Summed-area tables: sums over any window by four look-ups in each table.
class Tables {
public:
  // counts: whether a pixel is included.
  template <class Counts> Tables(const LuminanceMap &map, Counts &&counts) : stride_(map.width + 1) {
    sums_.resize(size_t(stride_) * (map.height + 1));
    for (uint32_t y = 0; y < map.height; ++y) {
      Sums row;
      for (uint32_t x = 0; x < map.width; ++x) {
        const size_t pixel = size_t(y) * map.width + x;
        if (counts(pixel))
          row.add(map.variance[pixel]);
        const Sums &above = at(x + 1, y);
        at(x + 1, y + 1) = {above.pixels + row.pixels, above.sum + row.sum, above.squares + row.squares};
      }
    }
  }
  Sums of(const Window &window) const {
    const auto over = [&](double Sums::*value) {
      const double high = at(window.x1, window.y1).*value - at(window.x0, window.y1).*value;
      return std::max(0.0, high - (at(window.x1, window.y0).*value - at(window.x0, window.y0).*value));
    };
    return {over(&Sums::pixels), over(&Sums::sum), over(&Sums::squares)};
  }

private:
  Sums &at(uint32_t x, uint32_t y) { return sums_[size_t(y) * stride_ + x]; }
  const Sums &at(uint32_t x, uint32_t y) const { return sums_[size_t(y) * stride_ + x]; }

  uint32_t stride_;
  std::vector<Sums> sums_;
};

// Returns the largest variance of samples whose mean is the pixel's and whose values lie between the darkest and the brightest
// mean of the 3 x 3 neighbourhood.
float mixture_variance(const LuminanceMap &map, uint32_t x, uint32_t y) {
  const Window window(map, x, y, 1);
  const float own = map.mean[size_t(y) * map.width + x];
  float dark = own, bright = own;
  for (uint32_t v = window.y0; v < window.y1; ++v)
    for (uint32_t u = window.x0; u < window.x1; ++u) {
      dark = std::min(dark, map.mean[size_t(v) * map.width + u]);
      bright = std::max(bright, map.mean[size_t(v) * map.width + u]);
    }
  return (own - dark) * (bright - own);
}

// [height][width]: kPlain, or, for an edge, the exponent of its mixture variance as a power of four. Edges share variances with
// edges of the same exponent and of the two beside it.
constexpr int16_t kPlain = std::numeric_limits<int16_t>::min();

std::vector<int16_t> kinds_of(const LuminanceMap &map) {
  const Tables all(map, [](size_t) { return true; });
  std::vector<int16_t> kinds(map.size(), kPlain);
  for (uint32_t y = 0; y < map.height; ++y)
    for (uint32_t x = 0; x < map.width; ++x) {
      const float mixture = mixture_variance(map, x, y);
      if (mixture > 0.0f &&
          mixture > smallest_window(map, x, y, kPlainRadii, [&](const Window &w) { return all.of(w); }).mean())
        kinds[size_t(y) * map.width + x] = int16_t(std::ilogb(mixture) >> 1);
    }
  return kinds;
}

} // namespace

std::vector<float> error_bars(const LuminanceMap &map) {
  const std::vector<int16_t> kinds = kinds_of(map);
  const Tables plain(map, [&](size_t pixel) { return kinds[pixel] == kPlain; });
  const auto of_edges = [&](const Window &window, int kind) {
    Sums sums;
    for (uint32_t y = window.y0; y < window.y1; ++y)
      for (size_t pixel = size_t(y) * map.width + window.x0, end = pixel + window.x1 - window.x0; pixel < end; ++pixel)
        if (kinds[pixel] != kPlain && std::abs(kinds[pixel] - kind) <= 1)
          sums.add(map.variance[pixel]);
    return sums;
  };
  std::vector<float> bars(map.size());
  for (uint32_t y = 0; y < map.height; ++y) {
    for (uint32_t x = 0; x < map.width; ++x) {
      const size_t pixel = size_t(y) * map.width + x;
      if (map.count[pixel] == 0.0f) {
        bars[pixel] = std::numeric_limits<float>::infinity();
        continue;
      }
      if (const int16_t kind = kinds[pixel]; kind == kPlain) {
        const Sums sums = smallest_window(map, x, y, kPlainRadii, [&](const Window &window) { return plain.of(window); });
        bars[pixel] = float(map.unit * std::sqrt(sums.mean() / map.count[pixel]));
      } else {
        const Sums sums =
            smallest_window(map, x, y, kRadii.size(), [&](const Window &window) { return of_edges(window, kind); });
        const double reach = sums.enough() ? 1.0 : student_over_gaussian(sums.degrees_of_freedom());
        bars[pixel] = float(map.unit * reach * std::sqrt(sums.mean() / map.count[pixel]));
      }
    }
  }
  return bars;
}

namespace {

struct Half {
  double pixels = 0.0;
  double own = 0.0, other = 0.0; // sum over pixels of the relative variance of a sample: measured in the half, and predicted by
                                 // the other half
  double count = 0.0, planned = 0.0;

  // Returns the decrease of the sum of squared errors by doubling the samples, per added sample.
  double gain() const { return other / (2.0 * planned * planned * pixels); }
};

} // namespace

Refinement plan_refinement(const Film &film, const LuminanceMap &map, const RelativeVariance &relative, double target,
                           uint32_t most) {
  std::vector<Half> halves(film.tile_count());
  for (size_t i = 0; i < halves.size(); ++i) {
    const Film::Tile &tile = film.tile(i);
    Half &half = halves[i];
    half.pixels = tile.pixels();
    half.count = half.planned = tile.count;
    for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
      const glm::uvec2 at = tile.place(pixel);
      const size_t place = size_t(at.y) * map.width + at.x;
      half.own += 0.5 * (double(relative.own[place]) + relative.shared[place]);
    }
  }
  // A half without pixels predicts nothing for its other half, which then uses its own variance.
  for (size_t i = 0; i < halves.size(); ++i) {
    const Half &other = halves[i ^ 1];
    halves[i].other = other.pixels > 0.0 ? other.own * halves[i].pixels / other.pixels : halves[i].own;
  }
  double error = 0.0;
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < halves.size(); ++i) {
    const Half &half = halves[i];
    if (half.pixels == 0.0)
      continue;
    error += half.own / half.count;
    if (2.0 * half.count <= most)
      order.push_back(i);
  }
  // Simulate doubling the half of the largest gain until the target is met.
  const auto gains_less = [&](uint32_t a, uint32_t b) {
    return halves[a].gain() != halves[b].gain() ? halves[a].gain() < halves[b].gain() : a > b;
  };
  std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(gains_less)> queue(gains_less, order);
  const double goal = target * target * double(map.size());
  Refinement result;
  while (!queue.empty() && (target > 0.0 ? error > goal || result.tiles.empty() : result.tiles.size() < order.size())) {
    const uint32_t i = queue.top();
    queue.pop();
    Half &half = halves[i];
    if (half.planned == half.count)
      result.tiles.push_back(i);
    error -= half.other / (2.0 * half.planned);
    result.samples += half.planned * half.pixels;
    half.planned *= 2.0;
    if (target > 0.0 && 2.0 * half.planned <= most)
      queue.push(i);
  }
  return result;
}

} // namespace lancer
