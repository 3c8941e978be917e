// Tables of the light that an atmosphere scatters, by Nishita's single scattering and by a fit of multiple scattering, computed
// before a render for the node SKY.
#pragma once

#include "simd/parallel.h"
#include "simd/processor.h"

#include <cstdint>

namespace lancer {

// The input of a table. model: SkyModel; angles in radians, the altitude in metres; densities of air, aerosols and ozone, 1 for
// those of the Earth.
struct Atmosphere {
  uint32_t model = 0;
  double elevation = 0.0, diameter = 0.0, altitude = 0.0;
  double densities[3] = {1.0, 1.0, 1.0};
};

inline constexpr uint32_t kSkyWidth = 512, kSkyHalf = kSkyWidth / 2;
// Returns the rows of the table of a model.
uint32_t sky_rows(uint32_t model);

// Computes the table and the radiance at both rims of the sun, as lancer_compute_sky describes them.
void compute_sky(const Atmosphere &atmosphere, const BuildContext &context, float *xyz, float *rims);

// One row of a table to its middle; the other half mirrors it. The numbers that all directions of a row share are computed once
// for each segment of their rays: all are at the same height. Lengths are in the unit of the model. Colours of multiple
// scattering are four wavelengths.

// A ray from an observer at the radius r crosses a place at the distance t: its squared radius is that of the ground plus q,
// its product with the direction of the sun is rise + t mu, mu the cosine between ray and sun.
struct SkyPlace {
  float t, q;
};

// Cosines of the columns' azimuths, counted from the sun's.
struct alignas(64) AzimuthCosines {
  float of[kSkyHalf];
};

// The direction of the ray, as the cosine to the sun: level + swing cos(azimuth from the sun).
struct SkyRay {
  float level, swing, rise;
  const AzimuthCosines *cosines;
};

struct SingleRow {
  static constexpr int kSteps = 32;

  SkyRay ray;
  float step;
  bool sun_is_low; // below the horizontal plane: the ground may hide it
  SkyPlace at[kSteps];
  float density[kSteps][3], depth[kSteps][3]; // of air, aerosols, ozone; depth: from the observer to there
  float densities[3];
};

// Transmittances from a height in the air to the end of the atmosphere: [height][wavelength][cosine of the angle from the
// zenith].
inline constexpr int kClearCosines = 256, kClearHeights = 64;
struct alignas(64) ClearRow {
  float of[4][kClearCosines];
};

struct MultipleRow {
  static constexpr int kSteps = 64;

  SkyRay ray;
  const ClearRow *clear;
  float t[kSteps], per_radius[kSteps];
  int low[kSteps], high[kSteps];             // rows of the transmittances around the height
  float part[kSteps];                        // of the way between them
  float of_ground[kSteps][4];                // light from the ground there, for a sun in the zenith and clear air below
  float air[kSteps][4], aerosols[kSteps][4]; // scattered share that arrives, times the light of the sun
};

// One copy per instruction set; all copies give the same bits.
struct SkyKernel {
  const char *name;
  // xyz: float[kSkyHalf][3].
  void (*single_row)(const SingleRow &row, float *xyz);
  void (*multiple_row)(const MultipleRow &row, float *xyz);
  // Transmittances at a height above the ground.
  void (*clear_row)(const float (&densities)[3], float height, ClearRow &row);
};

LANCER_DECLARE_KERNEL(SkyKernel, sky_kernel)

} // namespace lancer
