#include "render/alike.h"

#include <algorithm>
#include <array>

namespace lancer {

namespace {

constexpr int kRadius = 3;
// The mean square of differences may be this many times what noise makes of it on average. Of nine pairs of equal pixels, whose
// noise eighteen differences tell, chance makes more of it less than once in a hundred times (F, 9 and 18 degrees of freedom).
constexpr float kNoise = 4.0f;

// Goes through the pairs of pixels that are one offset apart: p, and q = p + (dx, dy).
class Pairs {
public:
  Pairs(const LuminanceMap &map, const std::vector<float> &of_mean, AlikeNeighbours &sums)
      : map_(map), of_mean_(of_mean), sums_(sums), excess_(map.width + 2) {
    for (std::vector<float> &row : rows_)
      row.resize(map.width);
  }

  void add(int dx, int dy) {
    const int height = int(map_.height) - dy;
    if (height <= 0)
      return;
    // Three rows of sums at a time, those beyond the picture empty.
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
  int end(int dx) const { return int(map_.width) - std::max(0, dx); }

  // By how much squared differences exceed what noise may make of them, of three pairs in a row.
  void sum_row(int y, int dx, int dy, std::vector<float> &row) {
    const size_t p = size_t(y) * map_.width, q = size_t(y + dy) * map_.width;
    const float *mean_p = map_.mean.data() + p, *mean_q = map_.mean.data() + q;
    const float *noise_p = of_mean_.data() + p, *noise_q = of_mean_.data() + q;
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
    const size_t p = size_t(y) * map_.width, q = size_t(y + dy) * map_.width;
    float *alike = excess_.data();
    for (int x = begin(dx); x < end(dx); ++x)
      alike[x] = rows_[0][size_t(x)] + rows_[1][size_t(x)] + rows_[2][size_t(x)] <= 0.0f ? 1.0f : 0.0f;
    const auto add = [&](std::vector<float> &sums, const float *values) {
      float *to_p = sums.data() + p, *to_q = sums.data() + q;
      // One after the other: in one row the two overlap.
      for (int x = begin(dx); x < end(dx); ++x)
        to_p[x] += alike[x] * (values ? values[q + size_t(x + dx)] : 1.0f);
      for (int x = begin(dx); x < end(dx); ++x)
        to_q[x + dx] += alike[x] * (values ? values[p + size_t(x)] : 1.0f);
    };
    add(sums_.count, nullptr);
    add(sums_.mean, map_.mean.data());
    add(sums_.variance, map_.variance.data());
  }

  const LuminanceMap &map_;
  const std::vector<float> &of_mean_;
  AlikeNeighbours &sums_;
  std::array<std::vector<float>, 3> rows_;
  std::vector<float> excess_; // of a row, with a pair beyond each end
};

} // namespace

AlikeNeighbours::AlikeNeighbours(const LuminanceMap &map) : count(map.size(), 1.0f), mean(map.mean), variance(map.variance) {
  std::vector<float> of_mean(map.size());
  for (size_t i = 0; i < map.size(); ++i)
    of_mean[i] = map.count[i] > 0.0f ? map.variance[i] / map.count[i] : 0.0f;
  Pairs pairs(map, of_mean, *this);
  // Every pair once, from its upper or left pixel.
  for (int dy = 0; dy <= kRadius; ++dy)
    for (int dx = dy == 0 ? 1 : -kRadius; dx <= kRadius; ++dx)
      pairs.add(dx, dy);
}

} // namespace lancer
