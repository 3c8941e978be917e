#include "nodes/sky_table.h"

#include "nodes/air.h"
#include "scene/enums.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace lancer {

const SkyKernel &sky_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(sky_kernel); }

namespace {

constexpr double kPi = glm::pi<double>();

// Cosines of the azimuths of the columns, the sun at azimuth 0. offset: of a column, in columns.
AzimuthCosines azimuth_cosines(double offset) {
  AzimuthCosines cosines;
  for (uint32_t x = 0; x < kSkyHalf; ++x)
    cosines.of[x] = float(-cos(2.0 * kPi * (x + offset) / kSkyWidth));
  return cosines;
}

SkyRay sky_ray(double elevation, double sun, double radius, const AzimuthCosines &cosines) {
  return {float(sin(elevation) * sin(sun)), float(cos(elevation) * cos(sun)), float(radius * sin(sun)), &cosines};
}

// Returns the distance to the end of the atmosphere of a place whose squared radius is `rest` less than that of the end.
double distance_to_end(double along, double rest) { return std::sqrt(along * along + rest) - along; }

void mirror(float *row) {
  for (uint32_t x = 0; x < kSkyHalf; ++x)
    std::memcpy(row + 3 * (kSkyWidth - 1 - x), row + 3 * x, 3 * sizeof(float));
}

// The solid angle of the sun in single precision, as in Cycles, whose cosine loses digits for a small sun: a sun of half a
// degree gets a third of a percent brighter, and the smallest half as bright.
double solid_angle(double diameter) {
  const auto half = float(diameter) / 2.0f;
  return double(2.0f * float(kPi) * (1.0f - cos(half)));
}

// ---- single scattering ----

class SingleScattering {
public:
  explicit SingleScattering(const Atmosphere &atmosphere)
      : air_(atmosphere), cosines_(azimuth_cosines(0.0)), altitude_(std::clamp(atmosphere.altitude, 1.0, single::kHighest)) {}

  void compute(const BuildContext &context, float *xyz) const {
    const bool nishita = air_.model == SkyModel::Nishita;
    const uint32_t rows = sky_rows(air_.model), first = nishita ? 0 : rows / 2;
    parallel_for(context, rows - first, [&](size_t i) {
      const double up = double(i) / (rows - first);
      // Nishita's rows lie half a row apart at the zenith.
      const double elevation = up * up * (nishita ? 0.5 * kPi * (1.0 + 0.5 / rows) : 0.5 * kPi);
      float *row = xyz + 3 * size_t(kSkyWidth) * (first + i);
      sky_kernel().single_row(row_of(elevation), row);
      mirror(row);
    });
    // Below the horizon, its light fades within 24 degrees.
    const float *horizon = xyz + 3 * size_t(kSkyWidth) * first;
    for (uint32_t y = 0; y < first; ++y) {
      const double up = double(y) / first - 1.0, rest = std::max(1.0 - 2.5 * sin(0.5 * kPi * up * up), 0.0);
      for (uint32_t i = 0; i < 3 * kSkyWidth; ++i)
        xyz[3 * size_t(kSkyWidth) * y + i] = float(rest * rest * rest) * horizon[i];
    }
  }

  void rim(double elevation, float *xyz) const {
    const double rise = (single::kGround + altitude_) * sin(elevation), length = distance_to_end(rise, rest(squared_height()));
    double air = 0.0, aerosols = 0.0;
    for (int i = 0; i < single::kNodes; ++i) {
      const double s = double(single::kNode[i]) * length;
      const auto at = single::densities_at(height_of(float(squared_height() + (2.0 * rise + s) * s), single::kGround));
      air += double(single::kWeight[i]) * double(at.air) * length * air_.densities[0];
      aerosols += double(single::kWeight[i]) * double(at.aerosols) * length * air_.densities[1];
    }
    double sums[3] = {};
    for (int wave = 0; wave < single::kWaves; ++wave) {
      const double lost = double(single::kAir[wave]) * air + double(single::kAerosolExtinction) * aerosols;
      for (int k = 0; k < 3; ++k)
        sums[k] += double(single::kXyz[wave][k]) * double(single::kSun[wave]) * exp(-lost);
    }
    for (int k = 0; k < 3; ++k)
      xyz[k] = float(sums[k] * double(single::kWaveStep) / solid_angle(air_.diameter));
  }

private:
  double squared_height() const { return altitude_ * (2.0 * single::kGround + altitude_); }
  static double rest(double q) { return (single::kTop - single::kGround) * (single::kTop + single::kGround) - q; }

  SingleRow row_of(double elevation) const {
    const double radius = single::kGround + altitude_, rise = radius * sin(elevation);
    const double step = distance_to_end(rise, rest(squared_height())) / SingleRow::kSteps;
    SingleRow row;
    row.ray = sky_ray(elevation, air_.elevation, radius, cosines_);
    row.step = float(step);
    row.sun_is_low = air_.elevation < 0.0;
    double depth[3] = {};
    for (int i = 0; i < SingleRow::kSteps; ++i) {
      const double t = (i + 0.5) * step, q = squared_height() + (2.0 * rise + t) * t;
      row.at[i] = {float(t), float(q)};
      const auto found = single::densities_at(height_of(float(q), single::kGround));
      const double density[3] = {double(found.air), double(found.aerosols), double(found.ozone)};
      for (int k = 0; k < 3; ++k) {
        row.density[i][k] = float(density[k] * air_.densities[k]);
        depth[k] += step * density[k] * air_.densities[k];
        row.depth[i][k] = float(depth[k]);
      }
    }
    std::copy_n(air_.densities, 3, row.densities);
    return row;
  }

  const Atmosphere &air_;
  const AzimuthCosines cosines_;
  const double altitude_;
};

// ---- multiple scattering ----

class MultipleScattering {
public:
  MultipleScattering(const Atmosphere &atmosphere, const BuildContext &context)
      : air_(atmosphere), cosines_(azimuth_cosines(0.5)), clear_(kClearHeights),
        altitude_(std::clamp(atmosphere.altitude / 1000.0, 0.001, multiple::kHighest)) {
    std::copy_n(air_.densities, 3, densities_);
    parallel_for(context, kClearHeights, [&](size_t i) {
      sky_kernel().clear_row(densities_, float(multiple::kThickness * double(i) / (kClearHeights - 1)), clear_[i]);
    });
  }

  void compute(const BuildContext &context, float *xyz) const {
    const uint32_t rows = sky_rows(air_.model);
    parallel_for(context, rows, [&](size_t y) {
      const double up = 2.0 * (double(y) + 0.5) / rows - 1.0;
      float *row = xyz + 3 * size_t(kSkyWidth) * y;
      sky_kernel().multiple_row(row_of(0.5 * kPi * up * std::abs(up)), row);
      mirror(row);
    });
  }

  void rim(double elevation, float *xyz) const {
    constexpr int steps = 64;
    const double rise = (multiple::kGround + altitude_) * sin(elevation), step = distance_to_end(rise, rest()) / steps;
    double depth[4] = {}, sums[3] = {};
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * step, q = squared_height() + (2.0 * rise + t) * t;
      const auto at = multiple::coefficients_at(std::max(height_of(float(q), multiple::kGround), 0.0f), densities_);
      for (int k = 0; k < 4; ++k)
        depth[k] += double(at.extinction[k]) * step;
    }
    for (int wave = 0; wave < 4; ++wave)
      for (int k = 0; k < 3; ++k)
        sums[k] += double(multiple::kXyz[wave][k]) * double(multiple::kSun[wave]) * exp(-depth[wave]);
    for (int k = 0; k < 3; ++k)
      xyz[k] = float(sums[k] / solid_angle(air_.diameter));
  }

private:
  double squared_height() const { return altitude_ * (2.0 * multiple::kGround + altitude_); }
  double rest() const { return multiple::kThickness * (2.0 * multiple::kGround + multiple::kThickness) - squared_height(); }

  MultipleRow row_of(double elevation) const {
    const double radius = multiple::kGround + altitude_, rise = radius * sin(elevation);
    // The ray ends on the ground or at the end of the atmosphere.
    const double to_ground = rise * rise - squared_height();
    const bool grounded = rise < 0.0 && to_ground >= 0.0;
    const double step = (grounded ? -rise - std::sqrt(to_ground) : distance_to_end(rise, rest())) / MultipleRow::kSteps;
    MultipleRow row;
    row.ray = sky_ray(elevation, air_.elevation, radius, cosines_);
    row.clear = clear_.data();
    double through[4] = {1.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < MultipleRow::kSteps; ++i) {
      const double t = (i + 0.5) * step;
      const double height = std::max(double(height_of(float(squared_height() + (2.0 * rise + t) * t), multiple::kGround)), 0.0);
      row.t[i] = float(t);
      row.per_radius[i] = float(1.0 / (multiple::kGround + height));
      set_height(row, i, height);
      // Integrate the light of the segment as if its air were even.
      const auto at = multiple::coefficients_at(float(height), densities_);
      for (int k = 0; k < 4; ++k) {
        const double passed = exp(-step * double(at.extinction[k]));
        const double share = through[k] * (1.0 - passed) / std::max(double(at.extinction[k]), 1e-7) * double(multiple::kSun[k]);
        row.air[i][k] = float(share * double(at.air[k]));
        row.aerosols[i][k] = float(share * double(at.aerosols[k]));
        through[k] *= passed;
      }
    }
    return row;
  }

  void set_height(MultipleRow &row, int i, double height) const {
    const double place = std::min(height / multiple::kThickness, 1.0) * (kClearHeights - 1);
    row.low[i] = int(place);
    row.high[i] = std::min(row.low[i] + 1, kClearHeights - 1);
    row.part[i] = float(place - row.low[i]);
    // The ground's light: a matt ground, the solid angle under which it is seen, and the air between, as the quotient of the
    // two transmittances to the zenith.
    const double sine = multiple::kGround / (multiple::kGround + height);
    const double turned = 0.5 * (1.0 - std::sqrt(std::max((1.0 - sine) * (1.0 + sine), 0.0)));
    for (int k = 0; k < 4; ++k) {
      const float *low = clear_[size_t(row.low[i])].of[k], *high = clear_[size_t(row.high[i])].of[k];
      const double up =
          double(low[kClearCosines - 1]) * (1.0 - double(row.part[i])) + double(high[kClearCosines - 1]) * double(row.part[i]);
      const double between = up > 0.0 ? double(clear_[0].of[k][kClearCosines - 1]) / up : 0.0;
      row.of_ground[i][k] = float(turned * double(multiple::kGroundAlbedo) / kPi * between);
    }
  }

  const Atmosphere &air_;
  const AzimuthCosines cosines_;
  std::vector<ClearRow> clear_;
  const double altitude_;
  float densities_[3];
};

} // namespace

uint32_t sky_rows(uint32_t model) { return model == SkyModel::Nishita ? 128 : 256; }

void compute_sky(const Atmosphere &atmosphere, const BuildContext &context, float *xyz, float *rims) {
  const double half = 0.5 * atmosphere.diameter, low = atmosphere.elevation - half, high = atmosphere.elevation + half;
  if (atmosphere.model == SkyModel::MultipleScattering) {
    const MultipleScattering sky(atmosphere, context);
    sky.compute(context, xyz);
    sky.rim(low, rims);
    sky.rim(high, rims + 3);
    return;
  }
  const SingleScattering sky(atmosphere);
  sky.compute(context, xyz);
  sky.rim(std::max(low, 0.0), rims);
  sky.rim(std::max(high, 0.0), rims + 3);
}

} // namespace lancer
