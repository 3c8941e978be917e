// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "nodes/air.h"
#include "nodes/sky_table.h"
#include "simd/kernel_lanes.h"
#include "simd/processor.h"

namespace lancer {
namespace {

constexpr float kPerPi = 0.31830989f;

LANCER_LANE F cosine_to_sun(const SkyRay &ray, int column) {
  return F(ray.level) + F(ray.swing) * load(ray.cosines->of + column);
}

// Writes the colours of some columns.
LANCER_LANE void put(float *xyz, int column, const F (&color)[3]) {
  alignas(64) float of[3][kLanes];
  for (int k = 0; k < 3; ++k)
    store(of[k], color[k]);
  for (int i = 0; i < kLanes; ++i)
    for (int k = 0; k < 3; ++k)
      xyz[3 * (column + i) + k] = of[k][i];
}

// Light that is scattered once: a sum over the segments of the ray.
[[gnu::flatten]] void single_row(const SingleRow &row, float *xyz) {
  constexpr double squares = (single::kTop - single::kGround) * (single::kTop + single::kGround);
  constexpr float g = single::kForward;
  const F zero(0.0f), one(1.0f), top(static_cast<float>(squares));
  for (int column = 0; column < static_cast<int>(kSkyHalf); column += kLanes) {
    const F mu = cosine_to_sun(row.ray, column), spread = F(1.0f + g * g) - F(2.0f * g) * mu;
    const F air_phase = F(0.1875f * kPerPi) * (one + mu * mu);
    const F aerosol_phase = F(0.375f * kPerPi * (1.0f - g * g) / (2.0f + g * g)) * (one + mu * mu) / (spread * sqrt(spread));
    F spectrum[single::kWaves];
    for (F &wave : spectrum)
      wave = zero;
    for (int i = 0; i < SingleRow::kSteps; ++i) {
      const F q(row.at[i].q), b = F(row.ray.rise) + F(row.at[i].t) * mu;
      // The ground hides the sun where the line meets it, in front or behind.
      const M lit = row.sun_is_low ? !(b * b >= q) : uniform<F>(true);
      if (!any(lit))
        continue;
      // Find the optical depth up to the end of the atmosphere.
      const F length = sqrt(max(b * b + (top - q), zero)) - b;
      F depth[3] = {zero, zero, zero};
      for (int k = 0; k < single::kNodes; ++k) {
        const F s = F(single::kNode[k]) * length;
        const auto at = single::densities_at(height_of(F(q + (b + b + s) * s), single::kGround));
        depth[0] += F(single::kWeight[k]) * at.air;
        depth[1] += F(single::kWeight[k]) * at.aerosols;
        depth[2] += F(single::kWeight[k]) * at.ozone;
      }
      for (int k = 0; k < 3; ++k)
        depth[k] = F(row.depth[i][k]) + F(row.densities[k]) * length * depth[k];
      // Scatter what arrives.
      const F from_air = air_phase * F(row.density[i][0]), of_aerosols = F(single::kAerosolExtinction) * depth[1];
      const F from_aerosols = aerosol_phase * F(row.density[i][1] * single::kAerosols);
      for (int wave = 0; wave < single::kWaves; ++wave) {
        const F lost = depth[0] * F(single::kAir[wave]) + of_aerosols + depth[2] * F(single::kOzone[wave]);
        const F found = exp(-lost) * (from_air * F(single::kAir[wave]) + from_aerosols);
        spectrum[wave] += select(lit, found, zero);
      }
    }
    F color[3] = {zero, zero, zero};
    for (int wave = 0; wave < single::kWaves; ++wave)
      for (int k = 0; k < 3; ++k)
        color[k] += F(single::kXyz[wave][k] * single::kSun[wave] * single::kWaveStep * row.step) * spectrum[wave];
    put(xyz, column, color);
  }
}

[[gnu::flatten]] void clear_row(const float (&densities)[3], float height, ClearRow &row) {
  constexpr int steps = 64;
  constexpr auto ground = static_cast<float>(multiple::kGround), thick = static_cast<float>(multiple::kThickness);
  const F zero(0.0f), radius(ground + height), q(height * (2.0f * ground + height));
  const F rest((thick - height) * (2.0f * ground + thick + height));
  for (int column = 0; column < kClearCosines; column += kLanes) {
    const F cosine =
        from_lanes<F>([&](int i) { return static_cast<float>(column + i); }) * F(2.0f / (kClearCosines - 1)) - F(1.0f);
    const F b = radius * cosine, step = (sqrt(b * b + rest) - b) * F(1.0f / steps);
    F depth[4] = {zero, zero, zero, zero};
    for (int i = 0; i < steps; ++i) {
      const F t = F(static_cast<float>(i) + 0.5f) * step;
      const F there = max(height_of(F(q + (b + b + t) * t), multiple::kGround), zero);
      const auto at = multiple::coefficients_at(there, densities);
      for (int k = 0; k < 4; ++k)
        depth[k] += at.extinction[k];
    }
    for (int k = 0; k < 4; ++k)
      store(row.of[k] + column, exp(-(depth[k] * step)));
  }
}

// Light that is scattered once, and an estimate of the light that is scattered more often.
[[gnu::flatten]] void multiple_row(const MultipleRow &row, float *xyz) {
  constexpr float g = multiple::kForward;
  // The light from the rest of the atmosphere, relative to the sun's.
  constexpr float more[4] = {0.02f * 0.217f, 0.02f * 0.347f, 0.02f * 0.594f, 0.02f};
  const F zero(0.0f), half(0.5f), one(1.0f), last(static_cast<float>(kClearCosines - 1));
  alignas(64) float sums[4][kSkyHalf] = {};
  ClearRow clear;
  for (int i = 0; i < MultipleRow::kSteps; ++i) {
    // Interpolate the transmittances at this height.
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < kClearCosines; c += kLanes)
        store(clear.of[k] + c, (one - F(row.part[i])) * load(row.clear[row.low[i]].of[k] + c) +
                                   F(row.part[i]) * load(row.clear[row.high[i]].of[k] + c));
    for (int column = 0; column < static_cast<int>(kSkyHalf); column += kLanes) {
      const F mu = cosine_to_sun(row.ray, column), spread = F(1.0f + g * g) - F(2.0f * g) * mu;
      const F air_phase = F(0.1875f * kPerPi) * (one + mu * mu);
      const F aerosol_phase = F(0.25f * kPerPi * (1.0f - g * g)) / (spread * sqrt(spread));
      const F cosine = (F(row.ray.rise) + F(row.t[i]) * mu) * F(row.per_radius[i]);
      const F x = last * clamp01(F(cosine * half + half)), whole = floor(x), part = x - whole;
      const U from = truncate(whole), to = truncate(min(whole + one, last));
      const F scattered = one / (one + F(5.0f) * exp(F(-17.92f) * cosine));
      for (int k = 0; k < 4; ++k) {
        const auto at = [&](const float *table) __attribute__((always_inline)) {
          return (one - part) * gather(table, from) + part * gather(table, to);
        };
        const F direct = at(clear.of[k]);
        const F often = F(more[k]) * scattered + F(row.of_ground[i][k]) * at(row.clear[0].of[k]) * cosine;
        const F light =
            F(row.air[i][k]) * (air_phase * direct + often) + F(row.aerosols[i][k]) * (aerosol_phase * direct + often);
        store(sums[k] + column, load(sums[k] + column) + light);
      }
    }
  }
  for (int column = 0; column < static_cast<int>(kSkyHalf); column += kLanes) {
    F color[3] = {zero, zero, zero};
    for (int wave = 0; wave < 4; ++wave)
      for (int k = 0; k < 3; ++k)
        color[k] += F(multiple::kXyz[wave][k]) * load(sums[wave] + column);
    put(xyz, column, color);
  }
}

} // namespace

namespace LANCER_ISA {
const SkyKernel sky_kernel = {LANCER_ISA_NAME, single_row, multiple_row, clear_row};
}

} // namespace lancer
