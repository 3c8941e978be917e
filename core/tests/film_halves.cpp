// Chessboard tiles, the variance from halves of the samples, and the reduction to a power of two.
#include "render/film.h"
#include "render/picture_error.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <tuple>

namespace lancer {
namespace {

std::vector<SampleResult> grey(const std::vector<float> &values) {
  std::vector<SampleResult> results(values.size());
  for (size_t i = 0; i < values.size(); ++i)
    results[i].radiance = glm::vec3(values[i]);
  return results;
}

TEST(FilmHalves, EveryPixelBelongsToOneTile) {
  for (const uint32_t width : {1u, 2u, 15u, 16u, 33u})
    for (const uint32_t height : {1u, 2u, 17u, 32u}) {
      Film film(width, height, 16, 1, true);
      std::set<std::pair<uint32_t, uint32_t>> seen;
      for (size_t i = 0; i < film.tile_count(); ++i) {
        const Film::Tile &tile = film.tile(i), &other = film.tile(i ^ 1);
        EXPECT_EQ(tile.x, other.x);
        EXPECT_EQ(tile.y, other.y);
        for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
          const glm::uvec2 at = tile.place(pixel);
          EXPECT_LT(at.x - tile.x, tile.width);
          EXPECT_LT(at.y - tile.y, tile.height);
          EXPECT_EQ((at.x + at.y) % 2, i % 2);
          EXPECT_TRUE(seen.insert({at.x, at.y}).second);
        }
      }
      EXPECT_EQ(seen.size(), size_t(width) * height);
    }
}

TEST(FilmLuminances, AreTheMeanAndTheVarianceOfHalves) {
  // Samples 1, 2, 5, 8 | 9, 7 | 3: the halves (1, 2) and (5, 8) have means 1.5 and 6.5, so the variance of their mean is (6.5 -
  // 1.5)^2 / 4 = 6.25; that of the next two is (9 - 7)^2 / 4 = 1; and the last one deviates from the mean 16/3 of all before it
  // by 7/3. Their shares are 4/7, 2/7 and 1/7.
  const std::vector<SampleResult> results = grey({1.0f, 2.0f, 5.0f, 8.0f, 9.0f, 7.0f, 3.0f});
  const double parts[] = {16.0 * 6.25, 4.0 * 1.0, 49.0 / 9.0};
  const struct {
    uint32_t count;
    double mean, variance;
  } expected[] = {{4, 4.0, parts[0] / 16.0},
                  {6, 16.0 / 3.0, (parts[0] + parts[1]) / 36.0},
                  {7, 5.0, (parts[0] + parts[1] + parts[2]) / 49.0}};
  for (const auto &[count, mean, variance] : expected) {
    Film film(1, 1, 1, 1);
    film.add(film.tile(0), count, std::span(results).first(count));
    Film::Luminance luminance[1];
    EXPECT_EQ(film.luminances(film.tile(0), luminance), count);
    EXPECT_NEAR(luminance[0].mean, mean, 1e-6);
    EXPECT_NEAR(luminance[0].variance, variance, 1e-6);
    EXPECT_NEAR(luminance[0].brightest, count < 6 ? 8.0 : 9.0, 1e-6);
  }
}

TEST(FilmLuminances, AreUnknownBelowTwoSamples) {
  Film film(1, 1, 1, 1);
  Film::Luminance luminance[1];
  film.add(film.tile(0), 1, grey({1.0f}));
  EXPECT_EQ(film.luminances(film.tile(0), luminance), 0u);
  EXPECT_FALSE(LuminanceMap(film).known);
  film.add(film.tile(0), 1, grey({1.0f}));
  EXPECT_EQ(film.luminances(film.tile(0), luminance), 2u);
  EXPECT_TRUE(LuminanceMap(film).known);
}

TEST(FilmLuminances, KeepTheScaleOfTheBrightest) {
  // The square of 1e30 overflows float.
  Film film(2, 1, 2, 1);
  film.add(film.tile(0), 2, grey({1e30f, 0.0f, 3e30f, 0.0f}));
  const LuminanceMap map(film);
  EXPECT_NEAR(map.unit, 1e30, 1e24);
  EXPECT_NEAR(map.mean[0], 2.0f, 1e-6f);
  EXPECT_NEAR(map.variance[0], 2.0f, 1e-5f);
  EXPECT_EQ(map.mean[1], 0.0f);
}

TEST(FilmLuminances, AreThoseOfSamplesWhoseSumIsNoFloat) {
  Film film(1, 1, 1, 1);
  std::vector<float> values;
  for (int i = 0; i < 64; ++i)
    values.push_back(i < 32 ? 3e38f : 1e38f);
  film.add(film.tile(0), 64, grey(values));
  Film::Luminance luminance[1];
  EXPECT_EQ(film.luminances(film.tile(0), luminance), 64u);
  // Halves of 1e38 and of 3e38. The three weights of luminance, as floats, each round by 6e-8, as do the values and their
  // difference: twice as much for its square.
  EXPECT_NEAR(luminance[0].mean, 2e38, 2e38 * 2 * 6e-8);
  EXPECT_NEAR(luminance[0].variance, 1e76, 1e76 * 2 * 3 * 6e-8);
  const LuminanceMap map(film);
  EXPECT_TRUE(std::isfinite(map.unit) && std::isfinite(map.mean[0]) && std::isfinite(map.variance[0]));
}

TEST(FilmDropped, AreThoseThatTheFilmHas) {
  Film film(4, 2, 4, 1, true);
  Film::Tile &even = film.tile(0), &odd = film.tile(1);
  EXPECT_EQ(film.dropped().samples, 0u);
  const std::vector<SampleResult> some = grey(std::vector<float>(4 * 6, 1.0f));
  // Two in sample 3 of a tile and one in its sample 4; two in sample 2 of the other.
  film.drop(even, {0, 0, 3});
  film.drop(even, {2, 0, 3});
  film.drop(even, {1, 1, 4});
  film.add(even, 6, some);
  film.drop(odd, {0, 1, 2});
  film.drop(odd, {2, 1, 2});
  film.add(odd, 6, some);
  EXPECT_EQ(film.dropped().samples, 5u);
  const auto first = [&] {
    const SampleAddress address = film.dropped().first;
    return std::tuple(address.x, address.y, address.sample);
  };
  EXPECT_EQ(first(), std::tuple(0u, 1u, 2u));
  film.round_down(even);
  EXPECT_EQ(film.dropped().samples, 4u);
  // Starts again with the same samples.
  film.drop(even, {1, 1, 4});
  film.add(even, 4, some);
  EXPECT_EQ(film.dropped().samples, 5u);
  Film other(4, 2, 4, 1, true);
  other.drop(other.tile(0), {2, 0, 2});
  other.add(other.tile(0), 3, some);
  other.round_down(other.tile(0));
  EXPECT_EQ(other.dropped().samples, 0u);
}

TEST(FilmHalves, RoundingDownGivesTheBitsOfThePower) {
  std::vector<float> values;
  for (int i = 0; i < 23; ++i)
    values.push_back(std::ldexp(1.0f + 0.01f * float(i), i % 7 * 5));
  const std::vector<SampleResult> results = grey(values);
  const auto read = [](const Film &film) {
    std::vector<float> out(4);
    film.read(Pass::Combined, out);
    return out;
  };
  for (const uint32_t count : {1u, 3u, 16u, 23u}) {
    Film film(1, 1, 1, 1), power(1, 1, 1, 1);
    film.add(film.tile(0), count, std::span(results).first(count));
    film.round_down(film.tile(0));
    power.add(power.tile(0), std::bit_floor(count), std::span(results).first(std::bit_floor(count)));
    EXPECT_EQ(film.tile(0).count, std::bit_floor(count));
    EXPECT_EQ(read(film), read(power));
    // And continues normally.
    const uint32_t rest = 23 - film.tile(0).count;
    film.add(film.tile(0), rest, std::span(results).last(rest));
    power.add(power.tile(0), rest, std::span(results).last(rest));
    EXPECT_EQ(read(film), read(power));
  }
}

} // namespace
} // namespace lancer
