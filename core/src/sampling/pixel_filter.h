// The pixel filter by importance sampling: samples are distributed as the filter and have weight 1.
#pragma once

#include "simd/scalar.h"

namespace lancer {

enum class FilterKind : unsigned { Box = 0, BlackmanHarris = 1 };

// The table from which a filter is sampled; a box uses none.
struct FilterTable {
  static constexpr uint32_t kCells = 512;

  FilterKind kind;
  float width;
  float place[kCells + 1] = {};
};

// Returns the offset from the pixel's centre in pixels, in [-width / 2, width / 2], monotonic in u.
template <class F> LANCER_LANE F sample_filter(const FilterTable &table, F u) {
  using U = WordOf<F>;
  constexpr float cells = FilterTable::kCells;
  const F half(0.5f);
  if (table.kind == FilterKind::Box)
    return (u - half) * F(table.width);
  // Interpolate the half of the window on the nearer side: the window is symmetric.
  const F from_end = min(u, F(1.0f) - u), at = sqrt(from_end + from_end) * F(cells);
  const U cell = truncate(min(at, F(cells - 1.0f)));
  const F begin = gather(table.place, cell), end = gather(table.place, cell + U(1u));
  const F place = begin + (at - to_float(cell)) * (end - begin);
  return select(u < half, place - half, half - place) * F(table.width);
}

// A filter that is separable, symmetric and zero outside its full width (in pixels).
class PixelFilter {
public:
  PixelFilter(FilterKind kind, float width);

  float sample(float u) const { return sample_filter(table_, u); }
  const FilterTable &table() const { return table_; }

private:
  FilterTable table_;
};

} // namespace lancer
