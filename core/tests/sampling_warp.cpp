// Warps, tables and filters against their densities.
#include "sampling/warp.h"

#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "sampling/distribution.h"
#include "sampling/elementary.h"
#include "sampling/pixel_filter.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::Random;
constexpr int kDraws = 1000000, kCells = 32;

// Tests a warp in coordinates in [0, 1)^2 in which it should be uniform or have the given density (mean 1).
double p_value(uint64_t seed, const std::function<glm::dvec2(glm::vec2)> &place, const std::function<double(double)> &cdf_x) {
  std::vector<double> observed(kCells * kCells, 0.0), expected(kCells * kCells);
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j)
      expected[static_cast<std::size_t>(i * kCells + j)] =
          kDraws * (cdf_x((i + 1.0) / kCells) - cdf_x(static_cast<double>(i) / kCells)) / kCells;
  Random random(seed);
  for (int k = 0; k < kDraws; ++k) {
    const float x = random.uniform(), y = random.uniform();
    const glm::dvec2 p = place({x, y});
    const int i = std::clamp(static_cast<int>(p.x * kCells), 0, kCells - 1);
    const int j = std::clamp(static_cast<int>(p.y * kCells), 0, kCells - 1);
    observed[static_cast<std::size_t>(i * kCells + j)] += 1.0;
  }
  return testing::chi_square_test(observed, expected);
}

double azimuth(double x, double y) { return std::atan2(y, x) / (2.0 * std::numbers::pi) + 0.5; }

double identity(double x) { return x; }

// Each warp is tested once; together with their wrong variants below they share the level.
const double kLevel = testing::sidak_level(testing::kSignificance, 8);

TEST(Warp, DiskIsUniform) {
  // Uniform on the disk: the squared radius is uniform.
  const auto place = [](glm::vec2 u) {
    const glm::dvec2 p(warp_disk(u));
    return glm::dvec2(glm::dot(p, p), azimuth(p.x, p.y));
  };
  EXPECT_GT(p_value(1, place, identity), kLevel);
}

TEST(Warp, CosineHemisphereFollowsItsPdf) {
  // Density cos / pi over z: its integral up to z is z^2.
  const auto place = [](glm::vec2 u) {
    const glm::vec3 w = warp_cosine_hemisphere(u);
    return glm::dvec2(w.z, azimuth(w.x, w.y));
  };
  EXPECT_GT(p_value(2, place, [](double z) { return z * z; }), kLevel);
  EXPECT_LT(p_value(2, place, identity), kLevel);
  EXPECT_FLOAT_EQ(warp_cosine_hemisphere_pdf(0.5f), 0.5f / kPi);
  EXPECT_EQ(warp_cosine_hemisphere_pdf(-0.5f), 0.0f);
}

TEST(Warp, SphereIsUniform) {
  const auto place = [](glm::vec2 u) {
    const glm::vec3 w = warp_sphere(u);
    return glm::dvec2(0.5 * (1.0 + w.z), azimuth(w.x, w.y));
  };
  EXPECT_GT(p_value(3, place, identity), kLevel);
  EXPECT_FLOAT_EQ(warp_sphere_pdf(), 1.0f / (4.0f * kPi));
}

TEST(Warp, ConeIsUniformHoweverNarrow) {
  // From sin(theta)^2, which keeps its digits: 1 - cos = s2 / (1 + sqrt(1 - s2)).
  for (float sin2 : {1.0f, 0.3f, 1e-6f, 1e-12f}) {
    const float largest = one_minus_cos(sin2);
    const auto place = [&](glm::vec2 u) {
      const glm::dvec3 w(warp_cone(u, largest));
      const double s2 = w.x * w.x + w.y * w.y;
      return glm::dvec2(s2 / (1.0 + std::sqrt(std::max(0.0, 1.0 - s2))) / largest, azimuth(w.x, w.y));
    };
    EXPECT_GT(p_value(4, place, identity), kLevel) << sin2;
    // Solid angle 2 pi (1 - cos), in double: the float form rounds three times.
    const double exact = 1.0 / (2.0 * std::numbers::pi * (sin2 / (1.0 + std::sqrt(1.0 - static_cast<double>(sin2)))));
    EXPECT_NEAR(warp_cone_pdf(largest) / exact, 1.0, 5.0 * 0x1p-24);
  }
}

TEST(Warp, TriangleIsUniform) {
  // The share with a weight of corner 0 above 1 - x is x^2; along each such line the position is uniform.
  const auto place = [](glm::vec2 u) {
    const glm::dvec2 b(warp_triangle(u));
    return glm::dvec2(b.x + b.y, b.x / std::max(b.x + b.y, 0x1p-60));
  };
  EXPECT_GT(p_value(5, place, [](double x) { return x * x; }), kLevel);
}

TEST(Warp, DirectionsAreUnitAndFinite) {
  // Warps break at the corners of the square first. Rounding: three squares, each to a few ulp.
  for (float x : {0.0f, 0x1p-24f, 0.5f, 1.0f - 0x1p-24f})
    for (float y : {0.0f, 0x1p-24f, 0.5f, 1.0f - 0x1p-24f})
      for (const glm::vec3 &w :
           {warp_sphere({x, y}), warp_cosine_hemisphere({x, y}), warp_cone({x, y}, 1.0f), warp_cone({x, y}, 1e-12f)})
        EXPECT_NEAR(glm::dot(w, w), 1.0f, 10.0f * 0x1p-24f);
}

TEST(WeightedChoice, FollowsItsWeights) {
  const std::vector<double> weights{0.0, 3.0, 1e-4, 0.0, 5.0, 0.5, 0.0};
  const WeightedChoice distribution(weights);
  std::vector<double> observed(weights.size() * 4, 0.0), expected(weights.size() * 4);
  double pmf_sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    // The pmf is rounded to a float once.
    EXPECT_NEAR(distribution.pmf(i), weights[i] / 8.5001, 0x1p-24);
    pmf_sum += distribution.pmf(i);
    for (std::size_t j = 0; j < 4; ++j)
      expected[4 * i + j] = kDraws * weights[i] / 8.5001 / 4.0;
  }
  EXPECT_NEAR(pmf_sum, 1.0, 7 * 0x1p-25);
  Random random(6);
  for (int k = 0; k < kDraws; ++k) {
    const WeightedChoice::Choice choice = distribution.sample(static_cast<double>(random.next() >> 11) * 0x1p-53);
    ASSERT_EQ(choice.pmf, distribution.pmf(choice.index));
    ASSERT_TRUE(choice.u >= 0.0f && choice.u < 1.0f);
    observed[4 * choice.index + static_cast<std::size_t>(choice.u * 4.0f)] += 1.0;
  }
  EXPECT_GT(testing::chi_square_test(observed, expected), testing::kSignificance);
}

TEST(WeightedChoice, FindsTheEntryThatHoldsTheNumber) {
  Random random(11);
  for (const std::size_t count : {1u, 2u, 5u, 64u, 1000u}) {
    // Powers of two, whose sums are exact; most of the weight in few of them.
    std::vector<double> weights(count), sums(1, 0.0);
    for (double &w : weights)
      w = random.next() % 3 ? std::ldexp(1.0, static_cast<int>(random.next() % 20)) : 0.0;
    weights[count / 2] = 1.0;
    for (const double w : weights)
      sums.push_back(sums.back() + w);
    const WeightedChoice choice(weights);
    for (int k = 0; k < 4000; ++k) {
      const double u = static_cast<double>(random.next() >> 11) * 0x1p-53;
      const uint32_t i = choice.sample(u).index;
      ASSERT_GT(weights[i], 0.0);
      // The division by the sum rounds once.
      EXPECT_LE(sums[i], u * sums.back() * (1.0 + 0x1p-51));
      EXPECT_GE(sums[i + 1], u * sums.back() * (1.0 - 0x1p-51));
    }
  }
}
TEST(WeightedChoice, TakesBadWeights) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(WeightedChoice().sample(0.5).pmf, 0.0f);
  EXPECT_EQ(WeightedChoice({0.0, 0.0}).sample(0.5).pmf, 0.0f);
  EXPECT_EQ(WeightedChoice({0.0, 0.0}).pmf(1), 0.0f);
  EXPECT_EQ(WeightedChoice({-1.0, std::nan(""), infinity}).sample(0.5).pmf, 0.0f);
  EXPECT_EQ(WeightedChoice({1e308, 1e308, 0.0}).sample(0.75).index, 1u);
  EXPECT_EQ(WeightedChoice({1e308, 1e308, 0.0}).pmf(1), 0.5f);
  EXPECT_EQ(WeightedChoice({0.0, 1e-320, 0.0}).sample(0.0).index, 1u);
  EXPECT_EQ(WeightedChoice({1.0, 1.0, 0.0}).sample(1.0 - 0x1p-53).index, 1u);
}

// The window's integral from 0 to x relative to its whole integral, 0.35875.
double blackman_harris_cdf(double x) {
  const double t = 2.0 * std::numbers::pi;
  return x + (-0.48829 * std::sin(t * x) + 0.14128 / 2.0 * std::sin(2.0 * t * x) - 0.01168 / 3.0 * std::sin(3.0 * t * x)) /
                 (t * 0.35875);
}

TEST(PixelFilter, BlackmanHarrisFollowsTheWindow) {
  for (float width : {1.0f, 1.5f, 4.0f}) {
    const PixelFilter filter(FilterKind::BlackmanHarris, width);
    constexpr int cells = 200;
    std::vector<double> observed(cells, 0.0), expected(cells);
    for (int i = 0; i < cells; ++i)
      expected[static_cast<std::size_t>(i)] =
          kDraws * (blackman_harris_cdf((i + 1.0) / cells) - blackman_harris_cdf(static_cast<double>(i) / cells));
    Random random(8);
    for (int k = 0; k < kDraws; ++k)
      observed[static_cast<std::size_t>(
          std::clamp((filter.sample(random.uniform()) / width + 0.5) * cells, 0.0, cells - 1.0))] += 1.0;
    EXPECT_GT(testing::chi_square_test(observed, expected), testing::sidak_level(testing::kSignificance, 3));
  }
}

TEST(PixelFilter, InvertsTheWindowsIntegral) {
  // Linear interpolation between 512 nodes deviates from a place x(t) by h^2 / 8 |x''|, and from the integral by the window
  // times this, with |x''| w < 1.0 w_mean: 4.8e-7. For floats, three roundings of at most 2^-25 each, where the window is at
  // most 2.8 w_mean.
  const PixelFilter filter(FilterKind::BlackmanHarris, 1.0f);
  for (int i = 0; i <= 1000; ++i) {
    const float u = std::min(static_cast<float>(i) / 1000.0f, 1.0f - 0x1p-24f);
    EXPECT_NEAR(blackman_harris_cdf(filter.sample(u) + 0.5), u, 7.4e-7);
  }
}

TEST(PixelFilter, IsMonotoneAndStaysInside) {
  for (FilterKind kind : {FilterKind::Box, FilterKind::BlackmanHarris}) {
    const PixelFilter filter(kind, 1.5f);
    float last = -0.75f;
    for (uint32_t i = 0; i < 1u << 24; i += 61) {
      const float offset = filter.sample(static_cast<float>(i) * 0x1p-24f);
      ASSERT_GE(offset, last);
      last = offset;
    }
    EXPECT_LE(filter.sample(1.0f - 0x1p-24f), 0.75f);
    EXPECT_GE(filter.sample(0.0f), -0.75f);
    // Symmetric: u = 0.5 is the centre of the pixel, up to the rounding of the table's sums.
    EXPECT_NEAR(filter.sample(0.5f), 0.0f, 0x1p-22f);
  }
}

TEST(ErfInverse, MatchesMpmath) {
  const double values[][2] = {{9.99999993922529e-09, 8.8622692006673962e-9}, {0.0010000000474974513, 0.0008862271995601054},
                              {0.10000000149011612, 0.088855991825306482},   {0.5, 0.47693627620446987},
                              {0.8999999761581421, 1.1630870719457722},      {0.9900000095367432, 1.8213866009002778},
                              {0.9990000128746033, 2.3267563267961548},      {0.9999989867210388, 3.45707472603595},
                              {0.9999999403953552, 3.8325068569007109}};
  // The fit's own bound of 3.5e-7 and the rounding of 9 Horner steps.
  for (const auto &v : values) {
    EXPECT_NEAR(erf_inverse(static_cast<float>(v[0])) / v[1], 1.0, 7e-7);
    EXPECT_EQ(erf_inverse(static_cast<float>(-v[0])), -erf_inverse(static_cast<float>(v[0])));
  }
}

} // namespace
} // namespace lancer
