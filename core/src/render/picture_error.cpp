#include "render/picture_error.h"

#include "sampling/elementary.h"
#include "simd/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

namespace lancer {

namespace {

// Bound of luminances, in units of the mean absolute luminance. No pixel exceeds that mean by more than the number of pixels.
// With this bound, sums of squares over a neighbourhood, divided by a hundredth squared, fit into floats.
constexpr double kMost = 1e15;

} // namespace

LuminanceMap::LuminanceMap(const Film &film, uint32_t threads) : width(film.width()), height(film.height()) {
  const size_t pixels = size_t(width) * height;
  for (std::vector<float> *values : {&mean, &variance, &brightest, &count})
    values->assign(pixels, 0.0f);
  const BuildContext context{threads};
  // Find the unit. The sum has the order of pixels, so that it is the same for tiles of any size.
  std::vector<double> means(pixels);
  std::atomic<bool> all{true};
  parallel_for(context, film.tile_count(), [&](size_t i) {
    const Film::Tile &tile = film.tile(i);
    if (tile.pixels() == 0)
      return;
    std::vector<Film::Luminance> luminances(tile.pixels());
    if (film.luminances(tile, luminances) == 0) {
      all = false;
      return;
    }
    for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
      const glm::uvec2 at = tile.place(pixel);
      means[size_t(at.y) * width + at.x] = std::abs(luminances[pixel].mean);
    }
  });
  known = all;
  const double sum = std::accumulate(means.begin(), means.end(), 0.0);
  dark = !(sum > 0.0);
  unit = dark ? 1.0 : sum / double(pixels);
  // Lay out the tiles' statistics as a picture.
  parallel_for(context, film.tile_count(), [&](size_t i) {
    const Film::Tile &tile = film.tile(i);
    std::vector<Film::Luminance> luminances(tile.pixels());
    const uint32_t samples = film.luminances(tile, luminances);
    if (samples == 0)
      return;
    for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
      const glm::uvec2 at = tile.place(pixel);
      const size_t to = size_t(at.y) * width + at.x;
      mean[to] = float(std::clamp(luminances[pixel].mean / unit, -kMost, kMost));
      variance[to] = float(std::min(luminances[pixel].variance / (unit * unit) * samples, kMost * kMost));
      brightest[to] = float(luminances[pixel].brightest / unit);
      count[to] = float(samples);
    }
  });
}

namespace {

constexpr int kRadius = 3;
// Largest accepted ratio of the mean squared difference to its expected value from noise. For nine pairs of equal pixels, whose
// noise is estimated from eighteen differences, the ratio exceeds this limit by chance in less than 1 % of cases (F
// distribution, 9 and 18 degrees of freedom).
constexpr float kNoise = 4.0f;
// Rows of a band, which fit into a processor's cache, and the rows around it: its sums depend on four of them. With multiples
// of three, Pairs adds the sums of three rows in the order of the whole picture.
constexpr size_t kBand = 33, kAround = 6;
static_assert(kAround > kRadius && kAround % 3 == 0 && kBand % 3 == 0);

// Rows of a band of a picture, and the sums over their similar neighbours.
struct Band {
  size_t width, height;
  const float *mean, *variance, *of_mean; // of_mean: variance of the mean
  std::vector<float> counts, means, variances;
};

// Processes the pairs of pixels of a band with one offset: p, and q = p + (dx, dy).
class Pairs {
public:
  explicit Pairs(Band &band) : band_(band), excess_(band.width + 2) {
    for (std::vector<float> &row : rows_)
      row.resize(band.width);
  }

  void add(int dx, int dy) {
    const int height = int(band_.height) - dy;
    if (height <= 0)
      return;
    // Keep three rows of sums at a time; rows beyond the picture are 0.
    std::fill(rows_[2].begin(), rows_[2].end(), 0.0f);
    sum_row(0, dx, dy, rows_[0]);
    for (int y = 0; y < height; ++y) {
      std::vector<float> &next = rows_[size_t(y + 1) % 3];
      if (y + 1 < height)
        sum_row(y + 1, dx, dy, next);
      else
        std::fill(next.begin(), next.end(), 0.0f);
      join(y, dx, dy);
    }
  }

private:
  int begin(int dx) const { return std::max(0, -dx); }
  int end(int dx) const { return int(band_.width) - std::max(0, dx); }

  // Sums, over three pairs in a row, the excess of squared differences over the bound for noise.
  void sum_row(int y, int dx, int dy, std::vector<float> &row) {
    const size_t p = size_t(y) * band_.width, q = size_t(y + dy) * band_.width;
    const float *mean_p = band_.mean + p, *mean_q = band_.mean + q;
    const float *noise_p = band_.of_mean + p, *noise_q = band_.of_mean + q;
    float *excess = excess_.data() + 1;
    std::fill(excess_.begin(), excess_.end(), 0.0f);
    for (int x = begin(dx); x < end(dx); ++x) {
      const float apart = mean_p[x] - mean_q[x + dx];
      excess[x] = apart * apart - kNoise * (noise_p[x] + noise_q[x + dx]);
    }
    for (int x = begin(dx); x < end(dx); ++x)
      row[size_t(x)] = excess[x - 1] + excess[x] + excess[x + 1];
  }

  void join(int y, int dx, int dy) {
    const size_t p = size_t(y) * band_.width, q = size_t(y + dy) * band_.width;
    float *similar = excess_.data();
    for (int x = begin(dx); x < end(dx); ++x)
      similar[x] = rows_[0][size_t(x)] + rows_[1][size_t(x)] + rows_[2][size_t(x)] <= 0.0f ? 1.0f : 0.0f;
    const auto add = [&](std::vector<float> &sums, const float *values) {
      float *to_p = sums.data() + p, *to_q = sums.data() + q;
      // Two loops, because p and q overlap within a row.
      for (int x = begin(dx); x < end(dx); ++x)
        to_p[x] += similar[x] * (values ? values[q + size_t(x + dx)] : 1.0f);
      for (int x = begin(dx); x < end(dx); ++x)
        to_q[x + dx] += similar[x] * (values ? values[p + size_t(x)] : 1.0f);
    };
    add(band_.counts, nullptr);
    add(band_.means, band_.mean);
    add(band_.variances, band_.variance);
  }

  Band &band_;
  std::array<std::vector<float>, 3> rows_;
  std::vector<float> excess_; // of a row, with a pair beyond each end
};

} // namespace

SimilarNeighbours::SimilarNeighbours(const LuminanceMap &map, uint32_t threads)
    : count(map.size()), mean(map.size()), variance(map.size()) {
  std::vector<float> of_mean(map.size());
  for (size_t i = 0; i < map.size(); ++i)
    of_mean[i] = map.count[i] > 0.0f ? map.variance[i] / map.count[i] : 0.0f;
  // The rows around a band give its sums their other halves, in the same order as those of a whole picture.
  parallel_for(BuildContext{threads}, (map.height + kBand - 1) / kBand, [&](size_t number) {
    const size_t from = number * kBand, to = std::min(from + kBand, size_t(map.height));
    const size_t first = from - std::min(from, kAround), last = std::min(to + kAround, size_t(map.height));
    const size_t start = first * map.width, end = last * map.width;
    Band band{map.width, last - first, map.mean.data() + start, map.variance.data() + start, of_mean.data() + start, {}, {},
              {}};
    band.counts.assign(end - start, 1.0f);
    band.means.assign(map.mean.begin() + ptrdiff_t(start), map.mean.begin() + ptrdiff_t(end));
    band.variances.assign(map.variance.begin() + ptrdiff_t(start), map.variance.begin() + ptrdiff_t(end));
    Pairs pairs(band);
    // Visit each pair once, from its upper or left pixel.
    for (int dy = 0; dy <= kRadius; ++dy)
      for (int dx = dy == 0 ? 1 : -kRadius; dx <= kRadius; ++dx)
        pairs.add(dx, dy);
    const size_t own = (from - first) * map.width, size = (to - from) * map.width;
    for (const auto &[sums, result] : {std::pair{&band.counts, &count}, {&band.means, &mean}, {&band.variances, &variance}})
      std::copy_n(sums->begin() + ptrdiff_t(own), size, result->begin() + ptrdiff_t(from * map.width));
  });
}

namespace {

// Undiscovered light is bounded within squares of kSquare pixels by the rule of three: an event that has not occurred in m
// samples has, at 95 % confidence, a probability below 3 / m.
constexpr uint32_t kSquare = 16;
constexpr double kThree = 3.0;

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
          mean += double(std::abs(map.mean[i]));
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

double gaussian_reach(double confidence) {
  double low = 0.0, high = 40.0;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (erf(middle / std::sqrt(2.0)) < confidence ? low : high) = middle;
  }
  return low;
}

RelativeVariance::RelativeVariance(const LuminanceMap &map, uint32_t threads) : own(map.size()), shared(map.size()) {
  const SimilarNeighbours similar(map, threads);
  const float floor = map.floor();
  for (size_t pixel = 0; pixel < map.size(); ++pixel) {
    const float level = std::abs(similar.mean[pixel] / similar.count[pixel]) + floor;
    const float scale = level > 0.0f ? 1.0f / (level * level) : 0.0f;
    own[pixel] = map.variance[pixel] * scale;
    shared[pixel] = similar.variance[pixel] / similar.count[pixel] * scale;
  }
}

PictureError picture_error(const LuminanceMap &map, const RelativeVariance &relative, double confidence) {
  PictureError result;
  if (!map.known)
    return result;
  const double low = std::sqrt(mean_over(map, relative.own)), high = std::sqrt(mean_over(map, relative.shared));
  // The sum of squared true errors and the sum of squared measured errors are each distributed as chi-square. For Gaussian
  // errors, the variance of their difference is 4/3 of the sum of squares of the measured values; for other distributions it is
  // larger.
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < map.size(); ++i) {
    const double value = double(relative.own[i]) / map.count[i];
    sum += value;
    squares += value * value;
  }
  constexpr double kSpread = 2.0;
  const double spread = sum > 0.0 ? 0.5 * std::sqrt(kSpread * squares) / sum : 0.0;
  const double reach = exp(gaussian_reach(confidence) * spread);
  // The difference of halves estimates V(N / 2) - V(N): 2^p - 1 times V(N) where variance falls as N^-p. Allow for p = 2.
  constexpr double kMostOvertold = 3.0;
  result.low = std::min(low, high) / (reach * std::sqrt(kMostOvertold));
  result.high = std::max(low, high) * reach;
  result.error = std::sqrt(low * high);
  result.cannot_exclude = unmet(map);
  return result;
}

} // namespace lancer
