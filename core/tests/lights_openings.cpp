// Directions through openings: the density integrates to one, samples follow it, and a place behind all openings has the map.
#include "lights/openings.h"

#include "lights/round_light.h"
#include "sampling/direction_map.h"

#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "statistics.h"

namespace lancer {
namespace {

using testing::Random;

Light window(const glm::dvec3 &position, const glm::dvec3 &z, double half_x, double half_y, bool ellipse = false,
             double skew = 0.0) {
  Light light;
  light.kind = LightKind::Area;
  light.position = position;
  light.z = glm::normalize(z);
  const FrameAxes axes = complete_frame(Vector3<double>(light.z));
  light.x = axes.s;
  light.y = axes.t;
  light.half_x = half_x;
  light.half_y = half_y;
  light.ellipse = ellipse;
  light.skew = skew;
  light.area = (ellipse ? glm::pi<double>() : 4.0) * half_x * half_y;
  return light;
}

// Openings that overlap, one that faces away from some places, and a far one.
const std::vector<Light> kWindows = {
    window({0.0, 0.0, 2.0}, {0.0, 0.2, 1.0}, 1.0, 0.5),
    window({0.5, 0.3, 2.5}, {0.0, 0.0, 1.0}, 1.0, 1.0, true),
    window({-2.0, 0.0, 0.5}, {-1.0, 0.1, 0.0}, 0.4, 0.8, false, 0.3),
    window({0.0, 0.0, -3.0}, {0.0, 0.0, 1.0}, 1.0, 1.0),
    window({300.0, 0.0, 10.0}, {1.0, 0.0, 0.0}, 40.0, 40.0),
};
const std::array<glm::dvec3, 3> kPlaces = {glm::dvec3(0.0), glm::dvec3(0.7, -0.4, 1.2), glm::dvec3(0.2, 0.1, -5.0)};

DirectionMap uneven_map() {
  std::vector<float> weights(8 * 4);
  for (size_t i = 0; i < weights.size(); ++i)
    weights[i] = float(1 + i % 5);
  return DirectionMap(8, 4, weights);
}

// The sphere in cells of equal solid angle: uniform in z and in the angle about it.
constexpr int kRows = 24, kColumns = 48, kFine = 16;

TEST(Openings, SamplesHaveTheDensityThatIntegratesToOne) {
  const DirectionMap map = uneven_map();
  const DirectionTable table = map.table();
  const Openings openings{kWindows.data(), uint32_t(kWindows.size())};
  const double level = testing::sidak_level(testing::kSignificance, kPlaces.size());
  for (const glm::dvec3 &place : kPlaces) {
    const Vector3<double> p(place);
    std::vector<double> expected(kRows * kColumns), counts(kRows * kColumns);
    double total = 0.0;
    for (int row = 0; row < kRows * kFine; ++row)
      for (int column = 0; column < kColumns * kFine; ++column) {
        const double z = 1.0 - 2.0 * (row + 0.5) / (kRows * kFine), r = std::sqrt(1.0 - z * z);
        const double phi = 2.0 * glm::pi<double>() * (column + 0.5) / (kColumns * kFine);
        const Vector3<double> wi(r * std::cos(phi), r * std::sin(phi), z);
        const double share = density_through<float>(table, openings, p, wi) * 4.0 * glm::pi<double>() /
                             (double(kRows) * kFine * kColumns * kFine);
        expected[size_t(row / kFine * kColumns + column / kFine)] += share;
        total += share;
      }
    // The midpoint rule errs at the rims of openings and cells, which cross about 1 of 100 of the points; there the density
    // changes by some times its mean, on both sides alike.
    EXPECT_NEAR(total, 1.0, 5e-3);
    constexpr int kDraws = 40000;
    Random random(17);
    for (int i = 0; i < kDraws; ++i) {
      const DirectionSample<float> sample =
          sample_through<float>(table, openings, p, float(random.uniform()), float(random.uniform()));
      ASSERT_GT(sample.pdf, 0.0);
      EXPECT_EQ(sample.pdf, density_through<float>(table, openings, p, sample.direction));
      const double phi = std::atan2(sample.direction.y, sample.direction.x) / (2.0 * glm::pi<double>());
      const int row = std::clamp(int((1.0 - sample.direction.z) / 2.0 * kRows), 0, kRows - 1);
      const int column = std::min(int((phi < 0.0 ? phi + 1.0 : phi) * kColumns), kColumns - 1);
      counts[size_t(row * kColumns + column)] += 1.0;
    }
    for (double &share : expected)
      share *= kDraws / total;
    EXPECT_GT(testing::chi_square_test(counts, expected), level);
  }
}

TEST(Openings, BehindAllOpeningsTheMapHasAllSamples) {
  const DirectionMap map = uneven_map();
  const Openings openings{kWindows.data() + 3, 1};
  const Vector3<double> behind(glm::dvec3(0.0, 0.0, 1.0));
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const float u = float(random.uniform()), v = float(random.uniform());
    const DirectionSample<float> through = sample_through<float>(map.table(), openings, behind, u, v);
    const DirectionMap::Sample alone = map.sample({u, v});
    EXPECT_EQ(glm::dvec3(through.direction.x, through.direction.y, through.direction.z), alone.direction);
    EXPECT_EQ(through.pdf, map.pdf(glm::vec3(alone.direction)));
  }
}

} // namespace
} // namespace lancer
