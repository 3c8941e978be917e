// The sampler: exact stratification of every prefix, independence of pixels, seeds and dimensions.
#include "sampling/sobol.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "statistics.h"

namespace lancer {
namespace {

using testing::Random;

// Returns whether every elementary interval of area 2^(t - m) contains exactly 2^t of the 2^m points.
bool is_net(const std::vector<glm::vec2> &points, int m, int t) {
  const int digits = m - t;
  for (int a = 0; a <= digits; ++a) {
    std::vector<int> count(std::size_t{1} << digits, 0);
    for (const glm::vec2 &p : points) {
      const auto column = static_cast<uint32_t>(p.x * static_cast<float>(1u << a));
      const auto row = static_cast<uint32_t>(p.y * static_cast<float>(1u << (digits - a)));
      ++count[column << (digits - a) | row];
    }
    for (int c : count)
      if (c != 1 << t)
        return false;
  }
  return true;
}

std::vector<glm::vec2> points(uint32_t seed, uint32_t x, uint32_t y, uint32_t first, int m, uint32_t dimension) {
  std::vector<glm::vec2> result;
  for (uint32_t s = first; s < first + (1u << m); ++s)
    result.push_back(Sampler(seed, x, y, s).get2(dimension));
  return result;
}

TEST(Sobol, EachJointDimensionIsStratified) {
  for (uint32_t d = 0; d < kJointDimensions; ++d)
    for (int m = 0; m <= 12; ++m) {
      std::vector<int> count(std::size_t{1} << m, 0);
      for (uint32_t s = 0; s < 1u << m; ++s)
        ++count[static_cast<std::size_t>(Sampler(3, 5, 7, s).get1(d) * static_cast<float>(1u << m))];
      for (int c : count)
        ASSERT_EQ(c, 1) << "dimension " << d << ", 2^" << m << " points";
    }
}

TEST(Sobol, JointPairsAreNets) {
  // Sobol's theorem: two dimensions with polynomials of degrees e and e' are a (t, 2)-sequence with t = e - 1 + e' - 1. The
  // first dimension counts 0. Every aligned block of 2^m points is then a (t, m, 2)-net.
  const int degree[kJointDimensions] = {4, 5, 4, 5, 1, 1, 3, 2, 6, 3, 6, 6, 5, 6, 7, 6, 6, 5, 5, 5};
  for (uint32_t d = 0; d < kJointDimensions; d += 2) {
    const int t = degree[d] - 1 + degree[d + 1] - 1;
    for (int m = t; m <= 13; ++m)
      for (uint32_t block = 0; block < 3; ++block)
        ASSERT_TRUE(is_net(points(11, 2, 9, block << m, m, d), m, t)) << "dimension " << d << ", 2^" << m << " points";
  }
}

// Returns the least t for which the first 2^m points of some dimensions are a (t, m, s)-net: every box of volume 2^(t - m)
// whose sides are powers of two contains 2^t of them.
int strength(const std::vector<uint32_t> &dimensions, int m) {
  const auto holds = [&](int t) {
    std::vector<int> digits(dimensions.size(), 0);
    const std::function<bool(std::size_t, int)> each = [&](std::size_t i, int rest) {
      if (i + 1 < dimensions.size()) {
        for (digits[i] = 0; digits[i] <= rest; ++digits[i])
          if (!each(i + 1, rest - digits[i]))
            return false;
        return true;
      }
      digits[i] = rest;
      std::vector<int> count(std::size_t{1} << (m - t), 0);
      for (uint32_t s = 0; s < 1u << m; ++s) {
        uint32_t box = 0;
        for (std::size_t j = 0; j < dimensions.size(); ++j) {
          const float sides = static_cast<float>(1u << digits[j]);
          box = box << digits[j] | static_cast<uint32_t>(Sampler(5, 1, 2, s).get1(dimensions[j]) * sides);
        }
        ++count[box];
      }
      return std::ranges::all_of(count, [&](int c) { return c == 1 << t; });
    };
    return each(0, m - t);
  };
  int t = 0;
  while (!holds(t))
    ++t;
  return t;
}

TEST(Sobol, ProjectionsThatPathsDependOnAreEven) {
  // For 64 and for 256 points. Any m points are an (m, m, s)-net, so these values are significant; they are the results of the
  // search.
  const uint32_t bsdf = 4, light = 6, choice = 8, lobe = 9, next = 12;
  const struct {
    std::vector<uint32_t> dimensions;
    int of_64, of_256;
  } projections[] = {
      {{0, 1}, 2, 1},
      {{bsdf, bsdf + 1}, 0, 0},
      {{light, light + 1}, 1, 2},
      {{bsdf, bsdf + 1, lobe}, 1, 2},
      {{light, light + 1, choice}, 2, 2},
      {{next, next + 1}, 2, 1},
      {{next + 2, next + 3}, 1, 2},
  };
  for (const auto &[dimensions, of_64, of_256] : projections) {
    EXPECT_LE(strength(dimensions, 6), of_64) << dimensions[0];
    EXPECT_LE(strength(dimensions, 8), of_256) << dimensions[0];
  }
}

TEST(Sobol, PaddedPairsAreNets) {
  for (uint32_t d : {20u, 22u, 40u, 1000u})
    for (int m = 0; m <= 12; ++m)
      for (uint32_t block = 0; block < 3; ++block)
        ASSERT_TRUE(is_net(points(11, 2, 9, block << m, m, d), m, 0)) << "dimension " << d << ", 2^" << m << " points";
}

TEST(Sobol, SingleNumbersAreThoseOfThePairs) {
  for (uint32_t d : {0u, 7u, 14u, 16u, 30u}) {
    const Sampler sampler(1, 2, 3, 77);
    const glm::vec2 pair = sampler.get2(d);
    EXPECT_EQ(pair.x, sampler.get1(d));
    EXPECT_EQ(pair.y, sampler.get1(d + 1));
  }
}

TEST(Sobol, EightAtOnceAreTheSameNumbers) {
  for (uint32_t sample = 0; sample < 64; ++sample)
    for (uint32_t dimension = 0; dimension < 64; dimension += 4) {
      const Sampler sampler(3, 5, 7, sample * 0x2545f491u);
      const auto numbers = sampler.get8(dimension);
      for (uint32_t i = 0; i < 8; ++i)
        ASSERT_EQ(numbers[i], sampler.get1(dimension + i)) << dimension << " + " << i;
    }
}

TEST(Sobol, StaysBelowOne) {
  // 2^24 samples of one dimension visit each of 2^24 cells once, including the last. A conversion that rounds would return 1
  // there for half of the scramblings.
  for (uint32_t seed = 0; seed < 4; ++seed) {
    float largest = 0.0f;
    for (uint32_t s = 0; s < 1u << 24; ++s)
      largest = std::max(largest, Sampler(seed, 0, 0, s).get1(0));
    EXPECT_EQ(largest, 1.0f - 0x1p-24f);
  }
}

// Chi-square of pairs (a, b) in [0, 1)^2 against independence and uniformity, 16 x 16 cells.
class PairTest {
public:
  void add(float a, float b) {
    observed_[static_cast<std::size_t>(a * 16.0f) * 16 + static_cast<std::size_t>(b * 16.0f)] += 1.0;
    total_ += 1.0;
  }
  double p_value() const { return testing::chi_square_test(observed_, std::vector<double>(256, total_ / 256.0)); }

private:
  std::vector<double> observed_ = std::vector<double>(256, 0.0);
  double total_ = 0.0;
};

TEST(Sobol, PixelsSeedsAndPairsAreIndependent) {
  // Over the pixels of an image one sample's number is a plain random number: pairs of them at two addresses that differ in one
  // coordinate only must be uniform on the square.
  constexpr uint32_t size = 192;
  std::vector<double> p_values;
  for (uint32_t d : {0u, 1u, 5u, 15u, 16u, 17u, 21u})
    for (uint32_t s : {0u, 1u, 6u, 100u}) {
      PairTest right, up, seed, next_dimension, far_dimension;
      for (uint32_t y = 0; y < size; y += 2)
        for (uint32_t x = 0; x < size; x += 2) {
          const float u = Sampler(0, x, y, s).get1(d);
          right.add(u, Sampler(0, x + 1, y, s).get1(d));
          up.add(u, Sampler(0, x, y + 1, s).get1(d));
          seed.add(u, Sampler(1, x, y, s).get1(d));
          next_dimension.add(u, Sampler(0, x, y, s).get1(d + 1));
          far_dimension.add(u, Sampler(0, x, y, s).get1(d + 33));
        }
      for (const PairTest *test : {&right, &up, &seed, &next_dimension, &far_dimension})
        p_values.push_back(test->p_value());
    }
  for (double p : p_values)
    EXPECT_GT(p, testing::sidak_level(testing::kSignificance, p_values.size()));
}

TEST(Sobol, ScramblingIsUnbiased) {
  // The mean over 16 points of a smooth product integrand, over many scramblings, must be its integral 1: a z-test with the
  // means' own variance. A scrambling with preferred digits would shift it.
  for (uint32_t d : {0u, 4u, 16u, 22u}) {
    double sum = 0.0, sum2 = 0.0;
    constexpr int runs = 20000;
    for (uint32_t run = 0; run < runs; ++run) {
      double mean = 0.0;
      for (uint32_t s = 0; s < 16; ++s) {
        const glm::dvec2 u(Sampler(run, 3, 4, s).get2(d));
        mean += 9.0 * u.x * u.x * u.y * u.y / 16.0;
      }
      sum += mean;
      sum2 += mean * mean;
    }
    const double mean = sum / runs, variance = (sum2 / runs - mean * mean) / runs;
    EXPECT_GT(testing::normal_p_value((mean - 1.0) / std::sqrt(variance)), testing::sidak_level(testing::kSignificance, 4))
        << d;
  }
}

TEST(Sobol, ConvergesFasterThanRandom) {
  // Owen: for smooth integrands the scrambled net's variance falls like N^-3, random numbers' like 1/N: at 256 points in 2-D a
  // factor of thousands if t is 0. If t is 1 the net is as uniform as one of half the points, with a further gain coefficient
  // of 2: less by up to 16.
  for (uint32_t d : {0u, 4u, 20u}) {
    constexpr int runs = 200, count = 256;
    double net = 0.0, plain = 0.0;
    Random random(3);
    for (uint32_t run = 0; run < runs; ++run) {
      double a = 0.0, b = 0.0;
      for (uint32_t s = 0; s < count; ++s) {
        const glm::dvec2 u(Sampler(run, 8, 8, s).get2(d));
        a += 9.0 * u.x * u.x * u.y * u.y / count;
        const double x = random.uniform(), y = random.uniform();
        b += 9.0 * x * x * y * y / count;
      }
      net += (a - 1.0) * (a - 1.0);
      plain += (b - 1.0) * (b - 1.0);
    }
    EXPECT_LT(net * (d == 0 ? 50.0 : 1000.0), plain) << d;
  }
}

TEST(Hash, FlipsHalfOfTheBits) {
  // One flipped input bit flips each of 32 output bits with probability 1/2: over 4096 inputs the count is 2048 +- 32, and
  // chance exceeds 6 standard deviations in 1 of 5e5 of 1024 counts.
  for (int in = 0; in < 32; ++in) {
    int flips[32] = {};
    for (uint32_t x = 0; x < 4096; ++x) {
      const uint32_t change = hash(x * 0x2545f491u) ^ hash((x * 0x2545f491u) ^ 1u << in);
      for (int out = 0; out < 32; ++out)
        flips[out] += static_cast<int>(change >> out & 1);
    }
    for (int out = 0; out < 32; ++out)
      EXPECT_NEAR(flips[out], 2048, 6 * 32) << in << " -> " << out;
  }
}

TEST(Hash, CombineKeepsTheOrderOfCoordinates) {
  EXPECT_NE(hash_combine(hash_combine(1u, 2u), 3u), hash_combine(hash_combine(1u, 3u), 2u));
}

} // namespace
} // namespace lancer
