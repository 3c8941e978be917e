// Statistical tests: a p-value is the probability that a correct sampler deviates at least this much.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lancer::testing {

// Probability that one run of the whole suite fails without an error; sidak_level divides it among the assertions.
inline constexpr double kSignificance = 1e-3;

// Returns the level of each of count independent tests such that any of them fails by chance with probability level.
inline double sidak_level(double level, std::size_t count) {
  return -std::expm1(std::log1p(-level) / static_cast<double>(count));
}

// Q(a, x) = Gamma(a, x) / Gamma(a): the series of P below a + 1, else the continued fraction (Lentz).
inline double upper_gamma_ratio(double a, double x) {
  if (x <= 0.0)
    return 1.0;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  const double precision = std::numeric_limits<double>::epsilon();
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; std::abs(term) > sum * precision; n += 1.0)
      sum += term *= x / n;
    return 1.0 - front * sum;
  }
  const double tiny = std::numeric_limits<double>::min() / precision;
  double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = an * d + b;
    d = std::abs(d) < tiny ? tiny : d;
    c = b + an / c;
    c = std::abs(c) < tiny ? tiny : c;
    d = 1.0 / d;
    h *= d * c;
    if (std::abs(d * c - 1.0) < precision)
      break;
  }
  return front * h;
}

inline double chi_square_p_value(double statistic, double degrees) { return upper_gamma_ratio(0.5 * degrees, 0.5 * statistic); }

// Pearson's test of counts against expected counts. Cells are pooled from the rarest up until each expects at least 10, where
// the chi-square law is accurate. A hit in an impossible cell gives p = 0. Totals must agree: rejected samples form a cell,
// too.
inline double chi_square_test(const std::vector<double> &observed, const std::vector<double> &expected) {
  std::vector<std::size_t> order(expected.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  double statistic = 0.0, pooled_observed = 0.0, pooled_expected = 0.0;
  int cells = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    if (!(expected[i] > 0.0)) {
      if (observed[i] > 0.0)
        return 0.0;
      continue;
    }
    pooled_observed += observed[i];
    pooled_expected += expected[i];
    if (pooled_expected < 10.0 && k + 1 < order.size())
      continue;
    const double difference = pooled_observed - pooled_expected;
    statistic += difference * difference / pooled_expected;
    pooled_observed = pooled_expected = 0.0;
    ++cells;
  }
  return cells < 2 ? 1.0 : chi_square_p_value(statistic, cells - 1);
}

// Kolmogorov's test that numbers are uniform on 0 ... 1, with Stephens' correction for small counts.
inline double uniformity_p_value(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size()), root = std::sqrt(n);
  double apart = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double index = static_cast<double>(i);
    apart = std::max({apart, values[i] - index / n, (index + 1.0) / n - values[i]});
  }
  const double x = (root + 0.12 + 0.11 / root) * apart;
  // The series alternates and decreases quickly except for tiny x, where the result is 1.
  double p = 0.0;
  for (int k = 1; k <= 100; ++k)
    p += (k % 2 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return x < 0.2 ? 1.0 : std::clamp(p, 0.0, 1.0);
}

// Two-sided p-value of a standard normal deviate.
inline double normal_p_value(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

// Independent uniform numbers for tests, so that a test of a sampler does not depend on the sampler (SplitMix64).
class Random {
public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t next() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ z >> 27) * 0x94d049bb133111ebull;
    return z ^ z >> 31;
  }
  float uniform() { return static_cast<float>(next() >> 40) * 0x1p-24f; }

private:
  uint64_t state_;
};

} // namespace lancer::testing
