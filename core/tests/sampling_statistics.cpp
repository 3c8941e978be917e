// Tests of the statistical tests: exact p-values, correct samplers pass, wrong ones fail.
#include "statistics.h"

#include <gtest/gtest.h>

namespace lancer::testing {
namespace {

TEST(Statistics, ChiSquareTailMatchesMpmath) {
  // {degrees, statistic, upper tail at 50 digits}
  const double values[][3] = {{1, 3.5, 0.061368829139402173},     {10, 18.0, 0.054963641495104904},
                              {100, 124.0, 0.052198762557077495}, {1000, 1100.0, 0.014614408126295194},
                              {1000, 900.0, 0.98928276190871026}, {50, 20.0, 0.9999530506185732}};
  // lgamma(500) is about 2600, so that its rounding alone is 2600 * 2^-52 = 6e-13 of the result.
  for (const auto &v : values)
    EXPECT_NEAR(chi_square_p_value(v[1], v[0]), v[2], 2e-12);
}

TEST(Statistics, SidakKeepsTheWholeLevel) {
  // 1 - (1 - level)^n is the requested level, up to the rounding of 1 - level.
  const double each = sidak_level(kSignificance, 250);
  EXPECT_NEAR(1.0 - std::pow(1.0 - each, 250), kSignificance, 1e-12);
}

// Counts of a density 1 + slope (2 u - 1) on [0, 1), tested against the uniform density.
double p_value_of_slope(double slope, uint64_t seed) {
  constexpr int cells = 100, draws = 1000000;
  std::vector<double> observed(cells, 0.0);
  const std::vector<double> expected(cells, static_cast<double>(draws) / cells);
  Random random(seed);
  for (int i = 0; i < draws; ++i) {
    const double v = random.uniform();
    const double u =
        slope == 0.0 ? v : (slope - 1.0 + std::sqrt((1.0 - slope) * (1.0 - slope) + 4.0 * slope * v)) / (2.0 * slope);
    observed[std::min(cells - 1, static_cast<int>(u * cells))] += 1.0;
  }
  return chi_square_test(observed, expected);
}

TEST(Statistics, AcceptsTheRightSampler) {
  // The seeds are fixed; a correct sampler fails one of 20 with probability kSignificance in total.
  for (uint64_t seed = 0; seed < 20; ++seed)
    EXPECT_GT(p_value_of_slope(0.0, seed), sidak_level(kSignificance, 20));
}

TEST(Statistics, RejectsASlopeOfTwoPercent) {
  // The non-centrality is draws * slope^2 / 3 = 133, against 99 +- 14: over 9 standard deviations above the expectation.
  for (uint64_t seed = 0; seed < 20; ++seed)
    EXPECT_LT(p_value_of_slope(0.02, seed), sidak_level(kSignificance, 20));
}

TEST(Statistics, PValuesOfARightSamplerAreUniform) {
  // Ten cells of p-values over 2000 runs, tested by the same test: neither too strict nor too lenient.
  std::vector<double> observed(10, 0.0);
  Random random(7);
  for (int run = 0; run < 2000; ++run) {
    std::vector<double> counts(50, 0.0);
    for (int i = 0; i < 5000; ++i)
      counts[static_cast<std::size_t>(random.uniform() * 50.0f)] += 1.0;
    observed[std::min(9, static_cast<int>(10.0 * chi_square_test(counts, std::vector<double>(50, 100.0))))] += 1.0;
  }
  EXPECT_GT(chi_square_test(observed, std::vector<double>(10, 200.0)), kSignificance);
}

TEST(Statistics, RejectsAHitWhereNothingMayLand) {
  EXPECT_EQ(chi_square_test({1000.0, 1000.0, 1.0}, {1000.0, 1001.0, 0.0}), 0.0);
}

TEST(Statistics, PoolsRareCellsWithoutLosingThem) {
  // 100 cells that expect 0.2 each contain 20 in total; 80 hits there must be detected although no single cell could show it.
  std::vector<double> expected(100, 0.2), observed(100, 0.8);
  expected.push_back(1000.0);
  observed.push_back(1000.0);
  EXPECT_LT(chi_square_test(observed, expected), 1e-9);
}

} // namespace
} // namespace lancer::testing
