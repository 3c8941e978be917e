// Directional albedos of rough surfaces, precomputed. The grids are those of Cycles and are read between their nodes as there,
// so that what is made of them (energy of further bounces, weights of layers, colour passes) agrees; the values are integrals
// of our own (core/tables).
#pragma once

#include "sampling/on_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lancer {

namespace tables {

inline constexpr int kFine = 32, kCoarse = 16;
// Values in 0 ... 1 as sixteen bits; first index slowest.
extern const uint16_t kGgx[kFine * kFine];                         // [cosine][roughness]
extern const uint16_t kGgxMean[kFine];                             // [roughness]
extern const uint16_t kGlass[2][kCoarse * kCoarse * kCoarse];      // from outside, inside: [index][cosine][roughness]
extern const uint16_t kGlassMean[2][kCoarse * kCoarse];            // [index][roughness]
extern const uint16_t kDielectricMix[kCoarse * kCoarse * kCoarse]; // [index][cosine][roughness]
extern const uint16_t kFifthPowerMix[kCoarse * kCoarse];           // [cosine][roughness]

inline float read1(const uint16_t *table, int n, float x) {
  x = on_axis(x) * static_cast<float>(n - 1);
  const int i = std::min(static_cast<int>(x), n - 2);
  const float t = x - static_cast<float>(i), a = table[i], b = table[i + 1];
  return (a + (b - a) * t) * (1.0f / 65535.0f);
}
// The same of a row of floats.
inline float read_row(const float *row, int n, float x) {
  x = on_axis(x) * static_cast<float>(n - 1);
  const int i = std::min(static_cast<int>(x), n - 2);
  return row[i] + (row[i + 1] - row[i]) * (x - static_cast<float>(i));
}
inline float read2(const uint16_t *table, int n, float y, float x) {
  y = on_axis(y) * static_cast<float>(n - 1);
  const int i = std::min(static_cast<int>(y), n - 2);
  const float t = y - static_cast<float>(i), a = read1(table + n * i, n, x), b = read1(table + n * (i + 1), n, x);
  return a + (b - a) * t;
}
inline float read3(const uint16_t *table, int n, float z, float y, float x) {
  z = on_axis(z) * static_cast<float>(n - 1);
  const int i = std::min(static_cast<int>(z), n - 2);
  const float t = z - static_cast<float>(i), a = read2(table + n * n * i, n, y, x), b = read2(table + n * n * (i + 1), n, y, x);
  return a + (b - a) * t;
}

// Where an index above or below 1 lies on the axis 0 ... 1: fourth root of the reflectance at the normal.
inline float index_axis(float ior) { return std::isinf(ior) ? 1.0f : std::sqrt(std::abs((ior - 1.0f) / (ior + 1.0f))); }

} // namespace tables

// The tables of one lobe along the cosine of wo, for a roughness and an index that are read again and again.
struct AlbedoRows {
  float single[tables::kFine]; // ggx_albedo, or the first kCoarse of glass_albedo
  float mix[tables::kCoarse];  // dielectric_mix or fifth_power_mix
};

// roughness: of the socket, the root of alpha. cos_o: of wo.
// What facets that reflect all send out at once, and its mean over a white sky.
inline float ggx_albedo(float roughness, float cos_o) { return tables::read2(tables::kGgx, tables::kFine, cos_o, roughness); }
inline float ggx_mean_albedo(float roughness) { return tables::read1(tables::kGgxMean, tables::kFine, roughness); }

// The same for clear glass; ior as seen from wo's side.
inline float glass_albedo(float roughness, float cos_o, float ior) {
  return tables::read3(tables::kGlass[ior < 1.0f], tables::kCoarse, tables::index_axis(ior), cos_o, roughness);
}
inline float glass_mean_albedo(float roughness, float ior) {
  return tables::read2(tables::kGlassMean[ior < 1.0f], tables::kCoarse, tables::index_axis(ior), roughness);
}

// How far between f0 and f90 the facets reflect that are seen and send light out: along the dielectric's curve (the one seen
// from outside, for both sides), and along (1 - cos)^5.
inline float dielectric_mix(float roughness, float cos_o, float ior) {
  return tables::read3(tables::kDielectricMix, tables::kCoarse, tables::index_axis(ior), cos_o, roughness);
}
inline float fifth_power_mix(float roughness, float cos_o) {
  return tables::read2(tables::kFifthPowerMix, tables::kCoarse, cos_o, roughness);
}

} // namespace lancer
