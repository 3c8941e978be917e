// The pixel's filter by importance sampling: a sample lands where the filter weighs it, and counts 1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "sampling/elementary.h"

namespace lancer {

enum class FilterKind : unsigned { Box = 0, BlackmanHarris = 1 };

// The table that a filter is drawn from, for kernels; of a box there is none.
struct FilterTable {
  static constexpr std::size_t kCells = 512;

  FilterKind kind;
  float width;
  std::array<double, kCells + 1> weight{};
  std::array<double, kCells + 1> cdf{};
  std::array<uint32_t, kCells> guide{};
};

// Both filters are separable, symmetric and zero outside their full width (in pixels).
class PixelFilter {
public:
  PixelFilter(FilterKind kind, float width) : table_{kind, width} {
    if (kind == FilterKind::BlackmanHarris)
      build();
  }

  // The four-term Blackman-Harris window over its full width, x in [0, 1].
  static double blackman_harris(double x) {
    const double t = 2.0 * std::numbers::pi * x;
    return 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2.0 * t) - 0.01168 * cos(3.0 * t);
  }

  // Offset from the pixel's middle in pixels, in [-width / 2, width / 2], never falling as u rises.
  float sample(float u) const { return (table_.kind == FilterKind::Box ? u - 0.5f : invert(u)) * table_.width; }
  const FilterTable &table() const { return table_; }

private:
  static constexpr std::size_t kCells = FilterTable::kCells;

  // Between two nodes the window is a straight line: with 512 cells it differs from the true one by less than 3e-5 of its top,
  // and the integral of a line inverts in closed form.
  void build() {
    double sum = 0.0;
    for (std::size_t i = 0; i <= kCells; ++i)
      table_.weight[i] = blackman_harris(static_cast<double>(i) / kCells);
    for (std::size_t i = 0; i < kCells; ++i) {
      table_.cdf[i] = sum;
      sum += 0.5 * (table_.weight[i] + table_.weight[i + 1]);
    }
    table_.cdf[kCells] = sum;
    // Where to begin looking for a share: the first cell that a number of each of as many equal steps can lie in.
    std::size_t cell = 0;
    for (std::size_t step = 0; step < kCells; ++step) {
      const double target = static_cast<double>(step) / kCells * sum;
      while (cell + 1 < kCells && !(table_.cdf[cell + 1] > target))
        ++cell;
      table_.guide[step] = static_cast<uint32_t>(cell);
    }
  }

  // Position in the window minus one half.
  float invert(float u) const {
    // Find the cell that holds this share of the window.
    const double target = static_cast<double>(u) * table_.cdf[kCells];
    std::size_t i = table_.guide[static_cast<std::size_t>(u * static_cast<float>(kCells))];
    while (i + 1 < kCells && !(table_.cdf[i + 1] > target))
      ++i;
    // Solve w0 s + (w1 - w0) s^2 / 2 = rest for the place s inside it, in the form that no slope makes cancel.
    const double rest = std::max(0.0, target - table_.cdf[i]);
    const double w0 = table_.weight[i], w1 = table_.weight[i + 1];
    const double s = 2.0 * rest / (w0 + std::sqrt(std::max(0.0, w0 * w0 + 2.0 * (w1 - w0) * rest)));
    return static_cast<float>((static_cast<double>(i) + std::min(s, 1.0)) / kCells - 0.5);
  }

  FilterTable table_;
};

} // namespace lancer
