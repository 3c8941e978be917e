// The film's sums: one fixed tree over sample numbers for any split, as documented in the header.
#include "render/film.h"

#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

std::vector<SampleResult> random_results(uint32_t samples, uint32_t pixels) {
  std::mt19937 random(7);
  // Values over many magnitudes: any other order of sums would change the last digits.
  std::uniform_real_distribution<float> exponent(-20.0f, 20.0f);
  std::vector<SampleResult> results(size_t(samples) * pixels);
  for (SampleResult &result : results) {
    result.radiance = glm::vec3(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
    result.normal = glm::vec3(std::exp2(exponent(random)));
    result.depth = exponent(random);
  }
  return results;
}

std::vector<float> film_of(const std::vector<SampleResult> &results, uint32_t pixels, const std::vector<uint32_t> &split) {
  Film film(pixels, 1, pixels, 0x7);
  uint32_t first = 0;
  for (uint32_t count : split) {
    film.add(film.tile(0), count, std::span(results).subspan(size_t(first) * pixels, size_t(count) * pixels));
    first += count;
  }
  std::vector<float> out(pixels * 4);
  film.read(Pass::Combined, out);
  return out;
}

double tree_sum(const std::vector<SampleResult> &results, uint32_t pixels, uint32_t pixel, uint32_t begin, uint32_t size) {
  if (size == 1)
    return double(results[size_t(begin) * pixels + pixel].radiance.x);
  return tree_sum(results, pixels, pixel, begin, size / 2) + tree_sum(results, pixels, pixel, begin + size / 2, size / 2);
}

TEST(Film, AnySplitGivesTheSameBits) {
  const auto results = random_results(37, 5);
  const auto whole = film_of(results, 5, {37});
  EXPECT_EQ(whole, film_of(results, 5, {1, 1, 2, 4, 8, 16, 5}));
  EXPECT_EQ(whole, film_of(results, 5, std::vector<uint32_t>(37, 1)));
  EXPECT_EQ(whole, film_of(results, 5, {3, 30, 4}));
}

TEST(Film, SumsAlongTheTree) {
  const auto results = random_results(64, 3);
  const auto out = film_of(results, 3, {5, 59});
  for (uint32_t pixel = 0; pixel < 3; ++pixel)
    EXPECT_EQ(out[pixel * 4], float(tree_sum(results, 3, pixel, 0, 64) / 64.0));
}

TEST(Film, KeepsSampleZeroAndMeansApart) {
  const auto results = random_results(4, 2);
  Film film(2, 1, 2, 0x7);
  film.add(film.tile(0), 4, results);
  std::vector<float> depth(2), normal(6);
  film.read(Pass::Depth, depth);
  film.read(Pass::Normal, normal);
  EXPECT_EQ(depth[1], results[1].depth);
  const double mean = ((double(results[1].normal.x) + double(results[3].normal.x)) +
                       (double(results[5].normal.x) + double(results[7].normal.x))) /
                      4.0;
  EXPECT_EQ(normal[3], float(mean));
}

TEST(Film, IsEmptyBeforeTheFirstSample) {
  const Film film(3, 2, 32, 0x3);
  std::vector<float> combined(24, 5.0f), depth(6, 5.0f);
  film.read(Pass::Combined, combined);
  film.read(Pass::Depth, depth);
  EXPECT_EQ(combined, std::vector<float>(24, 0.0f));
  EXPECT_EQ(depth, std::vector<float>(6, 1e10f));
}

} // namespace
} // namespace lancer
