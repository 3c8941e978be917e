// Directional albedos of rough surfaces, precomputed. The grids and their interpolation are those of Cycles, so that derived
// quantities (energy of further bounces, weights of layers, colour passes) agree; the values are our own integrals
// (core/tables).
#pragma once

#include "simd/scalar.h"

#include <cstdint>

namespace lancer {

// Positions on the axes of a table.

// Clamps to low ... 1. NaN becomes low, so that no lookup is outside a table.
template <class F> LANCER_LANE F on_axis(F x, float low = 0.0f) { return min(max(F(low), x), F(1.0f)); }

namespace tables {

inline constexpr int kFine = 32, kCoarse = 16;
// Values in 0 ... 1 as sixteen bits; first index slowest.
LANCER_TABLE uint16_t kGgx[kFine * kFine];                         // [cosine][roughness]
LANCER_TABLE uint16_t kGgxMean[kFine];                             // [roughness]
LANCER_TABLE uint16_t kGlass[2][kCoarse * kCoarse * kCoarse];      // from outside, inside: [index][cosine][roughness]
LANCER_TABLE uint16_t kGlassMean[2][kCoarse * kCoarse];            // [index][roughness]
LANCER_TABLE uint16_t kDielectricMix[kCoarse * kCoarse * kCoarse]; // [index][cosine][roughness]
LANCER_TABLE uint16_t kFifthPowerMix[kCoarse * kCoarse];           // [cosine][roughness]

// Position of x between the nodes of an axis: the node before it, and the fraction of the way to the next.
template <class F> struct AxisPlace { F node, rest; };
template <class F> LANCER_LANE AxisPlace<F> place_on_axis(F x, int n) {
  x = on_axis(x) * static_cast<float>(n - 1);
  const F node = min(to_float(truncate(x)), F(static_cast<float>(n - 2)));
  return {node, x - node};
}
template <class F> LANCER_LANE F between(const AxisPlace<F> &at, F a, F b) { return a + (b - a) * at.rest; }

// Interpolates along the last index; first: index of the row's first value.
template <class F> LANCER_LANE F read_line(const uint16_t *table, F first, const AxisPlace<F> &x) {
  // One word holds both neighbours.
  const WordOf<F> at = truncate(first + x.node), pair = gather_bytes(table, at + at);
  return between(x, to_float(pair & WordOf<F>(0xffffu)), to_float(pair >> 16)) * (1.0f / 65535.0f);
}
template <class F>
LANCER_LANE F read_plane(const uint16_t *table, int n, F first, const AxisPlace<F> &y, const AxisPlace<F> &x) {
  const F low = first + y.node * static_cast<float>(n);
  return between(y, read_line(table, low, x), read_line(table, low + static_cast<float>(n), x));
}
template <class F> LANCER_LANE F read1(const uint16_t *table, int n, F x) {
  return read_line(table, F(0.0f), place_on_axis(x, n));
}
template <class F> LANCER_LANE F read2(const uint16_t *table, int n, F y, F x) {
  return read_plane(table, n, F(0.0f), place_on_axis(y, n), place_on_axis(x, n));
}
// sheet: number of the n^3 table that each lane reads.
template <class F> LANCER_LANE F read3(const uint16_t *table, int n, F sheet, F z, F y, F x) {
  const AxisPlace<F> at_z = place_on_axis(z, n), at_y = place_on_axis(y, n), at_x = place_on_axis(x, n);
  const F low = (sheet * static_cast<float>(n) + at_z.node) * static_cast<float>(n * n);
  return between(at_z, read_plane(table, n, low, at_y, at_x),
                 read_plane(table, n, low + static_cast<float>(n * n), at_y, at_x));
}

// Returns the position of an index above or below 1 on the axis 0 ... 1: the fourth root of the reflectance at normal
// incidence.
template <class F> LANCER_LANE F index_axis(F ior) {
  return select(abs(ior) < __builtin_inff(), sqrt(abs((ior - 1.0f) / (ior + 1.0f))), F(1.0f));
}

} // namespace tables

// The tables of one lobe along the cosine of wo, for a roughness and an index that are used repeatedly.
struct AlbedoRows {
  float single[tables::kFine]; // ggx_albedo, or the first kCoarse values of glass_albedo
  float mix[tables::kCoarse];  // dielectric_mix or fifth_power_mix
};

// roughness: the socket's, the square root of alpha. cos_o: of wo. ggx_albedo() returns the albedo of single scattering by
// perfectly reflecting facets, ggx_mean_albedo() its mean over a white sky.
template <class F> LANCER_LANE F ggx_albedo(F roughness, F cos_o) {
  return tables::read2(tables::kGgx, tables::kFine, cos_o, roughness);
}
template <class F> LANCER_LANE F ggx_mean_albedo(F roughness) {
  return tables::read1(tables::kGgxMean, tables::kFine, roughness);
}

// The same for clear glass; ior as seen from wo's side.
template <class F> LANCER_LANE F glass_albedo(F roughness, F cos_o, F ior) {
  const F inside = select(ior < 1.0f, F(1.0f), F(0.0f));
  return tables::read3(&tables::kGlass[0][0], tables::kCoarse, inside, tables::index_axis(ior), cos_o, roughness);
}
template <class F> LANCER_LANE F glass_mean_albedo(F roughness, F ior) {
  constexpr int n = tables::kCoarse;
  const F first = select(ior < 1.0f, F(static_cast<float>(n * n)), F(0.0f));
  return tables::read_plane(&tables::kGlassMean[0][0], n, first, tables::place_on_axis(tables::index_axis(ior), n),
                            tables::place_on_axis(roughness, n));
}

// Return the position of the mean reflectance of visible facets between f0 and f90: along the dielectric's curve (as seen from
// outside, for both sides), and along (1 - cos)^5.
template <class F> LANCER_LANE F dielectric_mix(F roughness, F cos_o, F ior) {
  return tables::read3(tables::kDielectricMix, tables::kCoarse, F(0.0f), tables::index_axis(ior), cos_o, roughness);
}
template <class F> LANCER_LANE F fifth_power_mix(F roughness, F cos_o) {
  return tables::read2(tables::kFifthPowerMix, tables::kCoarse, cos_o, roughness);
}

} // namespace lancer
