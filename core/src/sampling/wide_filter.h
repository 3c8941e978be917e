// PixelFilter::sample() for many lanes at once. For kernels only, like simd/lanes.h.
#pragma once

#include "sampling/pixel_filter.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE F sample_filter(const FilterTable &table, F u) {
  if (table.kind == FilterKind::Box)
    return (u - F(0.5f)) * F(table.width);
  // Find each lane's cell.
  constexpr uint32_t cells = FilterTable::kCells;
  const double *cdf = reinterpret_cast<const double *>(&table.cdf), *weight = reinterpret_cast<const double *>(&table.weight);
  const D target = widen(u) * D(cdf[cells]);
  U cell = gather(reinterpret_cast<const uint32_t *>(&table.guide), truncate(u * F(float(cells))));
  for (;;) {
    const M further = !((gather(cdf, cell + U(1)) > target) | equal(cell, U(cells - 1)));
    if (!any(further))
      break;
    cell = cell + select(further, U(1), U(0));
  }
  // Invert the line inside it.
  const D rest = max(D(0.0), target - gather(cdf, cell));
  const D w0 = gather(weight, cell), w1 = gather(weight, cell + U(1));
  const D s = D(2.0) * rest / (w0 + sqrt(max(D(0.0), w0 * w0 + D(2.0) * (w1 - w0) * rest)));
  return narrow((widen(to_float(cell)) + min(s, D(1.0))) / D(double(cells)) - D(0.5)) * F(table.width);
}

} // namespace
} // namespace lancer
