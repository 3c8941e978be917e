// Sixteen million samples in one pixel: no drift, and two halves equal the whole.
#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

constexpr uint32_t kSamples = 1u << 24, kPeriod = 1u << 12;
constexpr float kLarge = 0x1p20f, kSmall = 0x1p-8f;

std::vector<float> read(const Film &film, Pass pass) {
  std::vector<float> out(channels(pass));
  film.read(pass, out);
  return out;
}

// Adds the same samples repeatedly.
void add_periods(Film &film, const std::vector<SampleResult> &period, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i)
    film.add(film.tile(0), uint32_t(period.size()), period);
}

// Each sum of these is a whole number of units that double represents, so a film that adds in double has no error: 2^24 samples
// of up to 2^20 in units of 2^-8 take 52 bits, fractions in units of 2^-24 or 2^-27 up to 51.
TEST(FilmLongSums, SixteenMillionSamplesAreExact) {
  // Not a power of two: sums of whole periods reach all places of the tree.
  constexpr uint32_t length = 5001, periods = kSamples / length;
  std::mt19937 random(3);
  std::vector<SampleResult> period(length);
  glm::dvec3 light(0.0), normal(0.0);
  for (uint32_t i = 0; i < length; ++i) {
    period[i].radiance = glm::vec3(i % 2 ? kSmall : kLarge, 0.1f, std::ldexp(float(random() >> 8), -24));
    period[i].alpha = 1.0f;
    // One bright sample in each period, and otherwise 0.
    period[i].normal = glm::vec3(i == 77 ? kLarge : 0.0f, i == 78 ? kSmall : 0.0f, 1.0f);
    light += glm::dvec3(period[i].radiance);
    normal += glm::dvec3(period[i].normal);
  }
  const auto mean = [&](double sum) { return float(sum / length); };
  const std::vector<float> combined = {mean(light.x), 0.1f, mean(light.z), 1.0f};
  const std::vector<float> normals = {mean(normal.x), mean(normal.y), 1.0f};
  Film film(1, 1, 1, bit(Pass::Combined) | bit(Pass::Normal));
  for (uint32_t done = 0, next = 1; done < periods; done = next, next = std::min(2 * next, periods)) {
    add_periods(film, period, next - done);
    ASSERT_EQ(read(film, Pass::Combined), combined) << next << " periods";
    ASSERT_EQ(read(film, Pass::Normal), normals) << next << " periods";
  }
}

// Sums of neighbours, as documented for the film.
double tree_sum(const std::vector<float> &values, uint32_t begin, uint32_t size) {
  if (size == 1)
    return double(values[begin % values.size()]);
  return tree_sum(values, begin, size / 2) + tree_sum(values, begin + size / 2, size / 2);
}

// The second half subtracts the first in another order: only the roundings remain, all of them. A film that adds in any other
// order, or rounds in between, has other roundings.
TEST(FilmLongSums, TwoHalvesGiveTheBitsOfTheWhole) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> exponent(-20.0f, 20.0f);
  std::vector<float> given(kPeriod), taken(kPeriod);
  for (uint32_t i = 0; i < kPeriod; ++i)
    given[i] = std::exp2(exponent(random));
  for (uint32_t i = 0; i < kPeriod; ++i)
    taken[i] = -given[(i * 1001 + 5) % kPeriod];
  const auto results = [](const std::vector<float> &values) {
    std::vector<SampleResult> period(kPeriod);
    for (uint32_t i = 0; i < kPeriod; ++i)
      period[i].normal = glm::vec3(values[i]);
    return period;
  };
  Film film(1, 1, 1, bit(Pass::Combined) | bit(Pass::Normal));
  add_periods(film, results(given), kSamples / kPeriod / 2);
  add_periods(film, results(taken), kSamples / kPeriod / 2);
  // Each half by itself, as sent by another machine.
  const double halves = tree_sum(given, 0, kSamples / 2) + tree_sum(taken, 0, kSamples / 2);
  ASSERT_NE(halves, 0.0);
  EXPECT_EQ(read(film, Pass::Normal)[0], float(halves / kSamples));
}

} // namespace
} // namespace lancer
