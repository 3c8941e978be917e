// Sums without rounding, and the checksum of parts.
#include "integrator/exact_sum.h"
#include "render/checksum.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace lancer {
namespace {

std::vector<float> of_all_sizes(uint32_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-149.0f, 120.0f), sign(-1.0f, 1.0f);
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i)
    values.push_back(sign(random) * std::exp2(exponent(random)));
  return values;
}

ExactSum sum_of(const std::vector<float> &values, size_t begin, size_t end) {
  ExactSum sum;
  for (size_t i = begin; i < end; ++i)
    sum += values[i];
  return sum;
}

TEST(ExactSum, IsTheSameInAnyOrderAndOfAnyParts) {
  std::vector<float> values = of_all_sizes(1000);
  const auto whole = sum_of(values, 0, values.size()).digits();
  std::shuffle(values.begin(), values.end(), std::mt19937(9));
  EXPECT_EQ(whole, sum_of(values, 0, values.size()).digits());
  ExactSum parts = sum_of(values, 300, 1000);
  parts += sum_of(values, 0, 300);
  EXPECT_EQ(whole, parts.digits());
  parts -= sum_of(values, 0, 300);
  EXPECT_EQ(parts.digits(), sum_of(values, 300, 1000).digits());
}

TEST(ExactSum, LosesNothing) {
  constexpr float kLeast = std::numeric_limits<float>::denorm_min(), kMost = std::numeric_limits<float>::max();
  ExactSum sum;
  for (const float value : {kMost, kLeast, 1.0f, -kMost, -1.0f})
    sum += value;
  EXPECT_EQ(sum.value(), double(kLeast));
  sum += -kLeast;
  EXPECT_EQ(sum.value(), 0.0);
  sum += -2.5f;
  EXPECT_EQ(sum.value(), -2.5);
  for (int i = 0; i < 1000; ++i)
    sum += kMost;
  EXPECT_DOUBLE_EQ(sum.value(), 1000.0 * double(kMost));
}

TEST(ExactSum, RoundsOnceToADouble) {
  const std::vector<float> values = of_all_sizes(1);
  EXPECT_EQ(sum_of(values, 0, 1).value(), double(values[0]));
}

// Values of the reference implementation with seed 0. The last text fills a stripe, a lane of 8 bytes, one of 4, and 2 bytes.
TEST(Checksum, IsXxh64) {
  const auto of = [](const std::string &text) { return checksum(text.data(), text.size()); };
  EXPECT_EQ(of(""), 0xEF46DB3751D8E999u);
  EXPECT_EQ(of("a"), 0xD24EC4F1A98C6E5Bu);
  EXPECT_EQ(of("abc"), 0x44BC2CF5AD770999u);
  EXPECT_EQ(of("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1u);
  EXPECT_EQ(of("Forty-six bytes: a stripe, eight, four and two"), 0x521EE84C08AAC9C0u);
}

} // namespace
} // namespace lancer
