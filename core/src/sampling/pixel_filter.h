// The pixel's filter by importance sampling: a sample lands where the filter weighs it, and counts 1.
#pragma once

#include <numbers>

#include "sampling/elementary.h"
#include "simd/scalar.h"

namespace lancer {

enum class FilterKind : unsigned { Box = 0, BlackmanHarris = 1 };

// The table that a filter is drawn from; of a box there is none.
struct FilterTable {
  static constexpr uint32_t kCells = 512;

  FilterKind kind;
  float width;
  double weight[kCells + 1] = {};
  double cdf[kCells + 1] = {};
  uint32_t guide[kCells] = {};
};

// Offset from the pixel's middle in pixels, in [-width / 2, width / 2], never falling as u rises.
template <class F> LANCER_LANE F sample_filter(const FilterTable &table, F u) {
  using D = DoubleOf<F>;
  using U = WordOf<F>;
  constexpr uint32_t cells = FilterTable::kCells;
  if (table.kind == FilterKind::Box)
    return (u - F(0.5f)) * F(table.width);
  // Find the cell that holds this share of the window.
  const D target = widen(u) * D(table.cdf[cells]);
  U cell = gather(table.guide, truncate(u * F(static_cast<float>(cells))));
  for (;;) {
    const MaskOf<F> here = gather(table.cdf, cell + U(1u)) > target, last = equal(cell, U(cells - 1u)),
                    further = !(here | last);
    if (!any(further))
      break;
    cell = cell + select(further, U(1u), U(0u));
  }
  // Solve w0 s + (w1 - w0) s^2 / 2 = rest for the place s inside it, in the form that no slope makes cancel.
  const D rest = max(D(0.0), target - gather(table.cdf, cell));
  const D w0 = gather(table.weight, cell), w1 = gather(table.weight, cell + U(1u));
  const D s = D(2.0) * rest / (w0 + sqrt(max(D(0.0), w0 * w0 + D(2.0) * (w1 - w0) * rest)));
  return narrow((widen(to_float(cell)) + min(s, D(1.0))) / D(double(cells)) - D(0.5)) * F(table.width);
}

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

  float sample(float u) const { return sample_filter(table_, u); }
  const FilterTable &table() const { return table_; }

private:
  static constexpr uint32_t kCells = FilterTable::kCells;

  // Between two nodes the window is a straight line: with 512 cells it differs from the true one by less than 3e-5 of its top,
  // and the integral of a line inverts in closed form.
  void build() {
    double sum = 0.0;
    for (uint32_t i = 0; i <= kCells; ++i)
      table_.weight[i] = blackman_harris(static_cast<double>(i) / kCells);
    for (uint32_t i = 0; i < kCells; ++i) {
      table_.cdf[i] = sum;
      sum += 0.5 * (table_.weight[i] + table_.weight[i + 1]);
    }
    table_.cdf[kCells] = sum;
    // Where to begin looking for a share: the first cell that a number of each of as many equal steps can lie in.
    uint32_t cell = 0;
    for (uint32_t step = 0; step < kCells; ++step) {
      const double target = static_cast<double>(step) / kCells * sum;
      while (cell + 1 < kCells && !(table_.cdf[cell + 1] > target))
        ++cell;
      table_.guide[step] = cell;
    }
  }

  FilterTable table_;
};

} // namespace lancer
