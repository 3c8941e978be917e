// Sampling of triangles: directions are uniform over the solid angle.
#include "sampling/warp.h"

#include <gtest/gtest.h>
#include <vector>

#include "statistics.h"

namespace lancer {
namespace {

using testing::Random;

struct Corners {
  glm::dvec3 a, b, c;
  SphericalTriangle<double> seen() const { return {a, b, c}; }
};

// A triangle is divided into parts by steps along two of its sides: some have its orientation, others between them are
// inverted.
constexpr int kSteps = 8, kParts = kSteps * kSteps;

std::size_t cell_of(int i, int j, bool upright) { return static_cast<std::size_t>((i * kSteps + j) * 2 + upright); }

Corners part_of(const Corners &whole, int i, int j, bool upright) {
  const auto at = [&](int u, int v) {
    return whole.a + double(u) / kSteps * (whole.b - whole.a) + double(v) / kSteps * (whole.c - whole.a);
  };
  if (upright)
    return {at(i, j), at(i + 1, j), at(i, j + 1)};
  return {at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)};
}

// Returns the point where a direction hits the triangle's plane, in steps along both sides.
glm::dvec2 steps_of(const Corners &whole, const glm::dvec3 &wi) {
  const glm::dvec3 e1 = whole.b - whole.a, e2 = whole.c - whole.a, across = glm::cross(wi, e2);
  const double scale = kSteps / glm::dot(across, e1);
  return {-glm::dot(whole.a, across) * scale, -glm::dot(wi, glm::cross(whole.a, e1)) * scale};
}

const std::vector<Corners> kTriangles = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},                // an octant
    {{-1, -1, 0.02}, {3, -1, 0.02}, {-1, 3, 0.02}},   // from just below it
    {{5, 0, 1}, {5, 1, 1}, {5, 0, 2}},                // aside
    {{0, 0, 2}, {0.01, 0, 2}, {0, 3, 1}},             // a sliver
    {{100, 0, 0}, {100, 1, 0}, {100, 0, 1}},          // far away
    {{-1e6, -1, 0.5}, {1e6, -1, 0.5}, {0.3, 1, 0.1}}, // very long
};
// Each is tested once, and once against parts by area.
const double kLevel = testing::sidak_level(testing::kSignificance, 2 * static_cast<int>(kTriangles.size()));

std::vector<double> counts_of(const Corners &whole, int draws, uint64_t seed) {
  const SphericalTriangle<double> seen = whole.seen();
  std::vector<double> counts(2 * kParts, 0.0);
  Random random(seed);
  for (int k = 0; k < draws; ++k) {
    const double x = random.uniform(), y = random.uniform();
    const glm::dvec3 wi = seen.sample(x, y);
    EXPECT_NEAR(glm::length(wi), 1.0, 1e-9);
    const glm::dvec2 at = glm::clamp(steps_of(whole, wi), 0.0, kSteps - 1e-9);
    const int i = static_cast<int>(at.x), j = std::min(static_cast<int>(at.y), kSteps - 1 - i);
    const bool upright = at.x - i + (at.y - j) < 1.0 || i + j == kSteps - 1;
    counts[cell_of(i, j, upright)] += 1.0;
  }
  return counts;
}

} // namespace

TEST(SphericalTriangle, KnowsItsSolidAngle) {
  EXPECT_NEAR(kTriangles[0].seen().solid_angle, 0.5 * std::numbers::pi, 1e-14);
  // Far away it is area times cosine over squared distance, up to the square of its size over its distance.
  EXPECT_NEAR(kTriangles[4].seen().solid_angle, 0.5e-4, 0.5e-4 * 1e-4);
  // Parts sum to the whole from any point.
  for (const Corners &whole : kTriangles) {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; i + j < kSteps; ++j) {
        sum += part_of(whole, i, j, true).seen().solid_angle;
        if (i + j < kSteps - 1)
          sum += part_of(whole, i, j, false).seen().solid_angle;
      }
    EXPECT_NEAR(sum, whole.seen().solid_angle, 1e-9 * sum);
  }
  // Edge on, and from one of its corners, nothing is visible.
  EXPECT_EQ(SphericalTriangle<double>({1, 0, 0}, {2, 1, 0}, {1, 1, 0}).solid_angle, 0.0);
  EXPECT_EQ(SphericalTriangle<double>({0, 0, 0}, {2, 1, 0}, {1, 1, 0}).solid_angle, 0.0);
}

TEST(SphericalTriangle, DirectionsAreEven) {
  constexpr int kDraws = 200000;
  uint64_t seed = 1;
  for (const Corners &whole : kTriangles) {
    std::vector<double> expected(2 * kParts, 0.0), by_area(2 * kParts, 0.0);
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; i + j < kSteps; ++j)
        for (const bool upright : {true, false}) {
          if (!upright && i + j == kSteps - 1)
            continue;
          const std::size_t cell = cell_of(i, j, upright);
          expected[cell] += kDraws * part_of(whole, i, j, upright).seen().solid_angle / whole.seen().solid_angle;
          by_area[cell] += double(kDraws) / kParts;
        }
    EXPECT_GT(testing::chi_square_test(counts_of(whole, kDraws, seed), expected), kLevel) << seed;
    // For the one far away, area gives the same.
    if (&whole != &kTriangles[4]) {
      EXPECT_LT(testing::chi_square_test(counts_of(whole, kDraws, seed), by_area), kLevel) << seed;
    }
    ++seed;
  }
}

} // namespace lancer
