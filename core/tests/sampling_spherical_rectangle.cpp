// Sampling of rectangles: directions are uniform over the solid angle.
#include "sampling/warp.h"

#include <gtest/gtest.h>
#include <vector>

#include "statistics.h"

namespace lancer {
namespace {

using testing::Random;

struct Sides {
  glm::dvec2 low, high;
  double z;
  SphericalRectangle<double> seen() const { return {{low.x, low.y}, {high.x, high.y}, z}; }
};

// A rectangle is divided into parts by steps along its sides.
constexpr int kSteps = 8;

Sides part_of(const Sides &whole, int i, int j) {
  const auto at = [&](int u, int v) {
    return whole.low + glm::dvec2(double(u) / kSteps, double(v) / kSteps) * (whole.high - whole.low);
  };
  return {at(i, j), at(i + 1, j + 1), whole.z};
}

const std::vector<Sides> kRectangles = {
    {{-1, -1}, {1, 1}, 1},         // a side of a cube from its centre
    {{-3, -1}, {1, 2}, 0.02},      // from just below it
    {{5, 1}, {6, 2}, 1},           // aside
    {{-2, 0.5}, {-1, 4}, 0.3},     // aside, in the other direction
    {{0, 0}, {2, 3}, 1},           // from below a corner
    {{-0.005, -4}, {0.005, 3}, 1}, // a tube
    {{-1, 20}, {1, 22}, 100},      // far away
    {{-1e6, -1}, {1e6, 1}, 0.5},   // very long
    {{-1e6, -1e6}, {1e6, 1e6}, 1}, // half of all directions
};
// Each is tested once, and once against parts by area.
const double kLevel = testing::sidak_level(testing::kSignificance, 2 * static_cast<int>(kRectangles.size()));

std::vector<double> counts_of(const Sides &whole, int draws, uint64_t seed) {
  const SphericalRectangle<double> seen = whole.seen();
  std::vector<double> counts(kSteps * kSteps, 0.0);
  Random random(seed);
  for (int k = 0; k < draws; ++k) {
    const double u = random.uniform(), v = random.uniform();
    const Vector2<double> at = seen.sample(u, v);
    EXPECT_TRUE(whole.low.x <= at.x && at.x <= whole.high.x && whole.low.y <= at.y && at.y <= whole.high.y);
    const glm::dvec2 steps = (glm::dvec2(at.x, at.y) - whole.low) / (whole.high - whole.low) * double(kSteps);
    const glm::ivec2 cell = glm::min(glm::ivec2(steps), kSteps - 1);
    counts[static_cast<std::size_t>(cell.x * kSteps + cell.y)] += 1.0;
  }
  return counts;
}

} // namespace

TEST(SphericalRectangle, KnowsItsSolidAngle) {
  EXPECT_NEAR(kRectangles[0].seen().solid_angle, 4.0 * std::numbers::pi / 6.0, 1e-14);
  // The whole hemisphere except a rim as wide as the plane's height over its extent.
  EXPECT_NEAR(kRectangles[8].seen().solid_angle, 2.0 * std::numbers::pi, 8e-6);
  // Far away it is area times cosine over squared distance, up to the square of its size over its distance.
  const double distance2 = 100.0 * 100.0 + 21.0 * 21.0, cosine = 100.0 / std::sqrt(distance2);
  EXPECT_NEAR(kRectangles[6].seen().solid_angle, 4.0 * cosine / distance2, 4.0 / distance2 * 1e-3);
  // Parts sum to the whole from any point.
  for (const Sides &whole : kRectangles) {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        sum += part_of(whole, i, j).seen().solid_angle;
    EXPECT_NEAR(sum, whole.seen().solid_angle, 1e-9 * sum);
  }
  // Edge on nothing is visible.
  EXPECT_EQ(SphericalRectangle<double>({1, -1}, {2, 1}, 0.0).solid_angle, 0.0);
}

TEST(SphericalRectangle, DirectionsAreEven) {
  constexpr int kDraws = 200000;
  uint64_t seed = 1;
  for (const Sides &whole : kRectangles) {
    std::vector<double> expected, by_area(kSteps * kSteps, double(kDraws) / (kSteps * kSteps));
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        expected.push_back(kDraws * part_of(whole, i, j).seen().solid_angle / whole.seen().solid_angle);
    EXPECT_GT(testing::chi_square_test(counts_of(whole, kDraws, seed), expected), kLevel) << seed;
    // For the one far away, area gives the same.
    if (&whole != &kRectangles[6]) {
      EXPECT_LT(testing::chi_square_test(counts_of(whole, kDraws, seed), by_area), kLevel) << seed;
    }
    ++seed;
  }
}

} // namespace lancer
