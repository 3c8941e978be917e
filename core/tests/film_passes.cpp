// The film's passes: storage, cost, and conversion of sums to pictures.
#include "render/film.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace lancer {
namespace {

// The error is of the film as a whole, not of samples.
constexpr uint32_t kAll = ((1u << kPassCount) - 1) & ~bit(Pass::Error);
// Data that every film keeps of a pixel: the sums of the picture, the difference of its halves, and the brightest sample.
constexpr double kPlain = 4 * sizeof(double) + 2 * sizeof(float);

Pass pass(uint32_t number) { return static_cast<Pass>(number); }

// Samples whose radiance is the sum of their parts, as from an integrator; all numbers differ.
std::vector<SampleResult> synthetic(uint32_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> number(0.1f, 1.0f);
  const auto color = [&] { return glm::vec3(number(random), number(random), number(random)); };
  std::vector<SampleResult> results(count);
  for (SampleResult &result : results) {
    for (glm::vec3 &light : result.light)
      light = color();
    result.radiance = result.light[kLightEmission] + result.light[kLightEnvironment];
    for (uint32_t component = 0; component < 3; ++component)
      for (uint32_t way = 0; way < 2; ++way)
        result.radiance += result.light[kLightComponents + 3 * component + way];
    result.alpha = number(random);
    result.normal = color();
    result.albedo = color();
    result.depth = number(random);
    result.position = color();
    result.object_index = number(random);
    result.material_index = number(random);
    result.uv = color();
    result.mist = number(random);
    result.denoising_normal = color();
    result.denoising_depth = number(random);
    result.vector = glm::vec4(color(), number(random));
    result.vector_weight = 1.0f;
  }
  return results;
}

std::vector<float> read(const Film &film, Pass which) {
  std::vector<float> out(size_t(film.width()) * film.height() * channels(which));
  film.read(which, out);
  return out;
}

// A film of one pixel.
std::unique_ptr<Film> film_of(const std::vector<SampleResult> &results, uint32_t passes = kAll) {
  auto film = std::make_unique<Film>(1, 1, 1, passes);
  film->add(film->tile(0), uint32_t(results.size()), results);
  return film;
}

double mean_of(const std::vector<SampleResult> &results, const std::function<float(const SampleResult &)> &value) {
  double sum = 0.0;
  for (const SampleResult &result : results)
    sum += double(value(result));
  return sum / double(results.size());
}

TEST(FilmPasses, LightOverADarkColourIsAtTheEdgeOfFloat) {
  std::vector<SampleResult> results = synthetic(1);
  results[0].light[kLightComponents] = glm::vec3(1e38f, 1.0f, 0.0f);
  results[0].light[kLightComponents + 2] = glm::vec3(1e-3f, 0.5f, 0.0f);
  const std::vector<float> light = read(*film_of(results), pass(LANCER_PASS_DIFFUSE_DIRECT));
  EXPECT_EQ(light[0], std::numeric_limits<float>::max());
  EXPECT_EQ(light[1], 2.0f);
  // Without colour: the mean of the others.
  EXPECT_EQ(light[2], std::numeric_limits<float>::max());
}

TEST(FilmPasses, PartsSumToCombined) {
  const auto results = synthetic(16);
  const auto film = film_of(results);
  const auto combined = read(*film, Pass::Combined);
  for (int i = 0; i < 3; ++i) {
    float sum = read(*film, Pass::Emission)[size_t(i)] + read(*film, pass(LANCER_PASS_ENVIRONMENT))[size_t(i)];
    for (uint32_t first = LANCER_PASS_DIFFUSE_DIRECT; first <= LANCER_PASS_TRANSMISSION_DIRECT; first += 3)
      sum += read(*film, pass(first + 2))[size_t(i)] *
             (read(*film, pass(first))[size_t(i)] + read(*film, pass(first + 1))[size_t(i)]);
    // Roundings to float: four of a product, five of the sum of products, one of COMBINED, seven within a sample's radiance.
    EXPECT_NEAR(sum, combined[size_t(i)], 17.0f * std::ldexp(1.0f, -24) * combined[size_t(i)]);
  }
}

TEST(FilmPasses, EveryPassShowsItsOwnNumbers) {
  const auto results = synthetic(8);
  const auto film = film_of(results);
  const auto expect_mean = [&](Pass which, const std::function<float(const SampleResult &)> &last) {
    // The sum of 8 floats and the mean in double are exact to the last digit; then one rounding to float.
    EXPECT_EQ(read(*film, which).back(), float(mean_of(results, last))) << uint32_t(which);
  };
  expect_mean(Pass::Combined, [](const auto &r) { return r.alpha; });
  expect_mean(Pass::Normal, [](const auto &r) { return r.normal.z; });
  expect_mean(Pass::Albedo, [](const auto &r) { return r.albedo.z; });
  expect_mean(Pass::Uv, [](const auto &r) { return r.uv.z; });
  expect_mean(Pass::DenoisingNormal, [](const auto &r) { return r.denoising_normal.z; });
  expect_mean(Pass::DenoisingDepth, [](const auto &r) { return r.denoising_depth; });
  for (uint32_t light : {0u, 1u, 2u, 5u, 8u, 11u})
    expect_mean(pass(LANCER_PASS_EMISSION + light), [&](const auto &r) { return r.light[light].z; });
  for (uint32_t light : {3u, 4u, 6u, 7u, 9u, 10u}) {
    const uint32_t color = light - light % 3 + 2;
    const double expected = mean_of(results, [&](const auto &r) { return r.light[light].z; }) /
                            mean_of(results, [&](const auto &r) { return r.light[color].z; });
    EXPECT_EQ(read(*film, pass(LANCER_PASS_EMISSION + light)).back(), float(expected)) << light;
  }
  expect_mean(Pass::Vector, [](const auto &r) { return r.vector.w; });
  EXPECT_EQ(read(*film, Pass::Mist).back(), float(1.0 - mean_of(results, [](const auto &r) { return r.mist; })));
  EXPECT_EQ(read(*film, Pass::Depth).back(), results[0].depth);
  EXPECT_EQ(read(*film, Pass::Position).back(), results[0].position.z);
  EXPECT_EQ(read(*film, Pass::ObjectIndex).back(), results[0].object_index);
  EXPECT_EQ(read(*film, Pass::MaterialIndex).back(), results[0].material_index);
}

TEST(FilmPasses, WhatAPassShowsDoesNotDependOnTheOthers) {
  const auto results = synthetic(13);
  const auto all = film_of(results);
  for (uint32_t number = 0; number < kPassCount; ++number) {
    if (!(kAll >> number & 1u))
      continue;
    const auto alone = film_of(results, 1u << number);
    EXPECT_TRUE(alone->has(pass(number)));
    EXPECT_EQ(read(*alone, pass(number)), read(*all, pass(number))) << number;
    EXPECT_EQ(read(*alone, Pass::Combined), read(*all, Pass::Combined)) << number;
  }
}

// The tree of sums as it is defined: means of the earlier and the later half of the samples [first, first + count).
double half_difference(const std::vector<SampleResult> &results, size_t first, size_t count) {
  double earlier = 0.0, later = 0.0;
  for (size_t i = 0; i < count / 2; ++i) {
    earlier += double(results[first + i].radiance.y);
    later += double(results[first + count / 2 + i].radiance.y);
  }
  return (earlier - later) / double(count);
}

TEST(FilmPasses, HalvesCompareTheHalvesOfEachSum) {
  const auto results = synthetic(13);
  const auto of = [&](uint32_t count) {
    return read(*film_of({results.begin(), results.begin() + count}, bit(Pass::Halves)), Pass::Halves)[1];
  };
  // The sums are rounded to double, and their difference to float.
  EXPECT_FLOAT_EQ(of(8), float(half_difference(results, 0, 8)));
  EXPECT_FLOAT_EQ(of(12), float(8.0 / 12 * half_difference(results, 0, 8) + 4.0 / 12 * half_difference(results, 8, 4)));
  // The thirteenth sample has no half: it is compared with the mean of the others.
  double before = 0.0;
  for (size_t i = 0; i < 12; ++i)
    before += double(results[i].radiance.y) / 12;
  EXPECT_FLOAT_EQ(of(13), float(8.0 / 13 * half_difference(results, 0, 8) + 4.0 / 13 * half_difference(results, 8, 4) +
                                1.0 / 13 * (double(results[12].radiance.y) - before)));
  EXPECT_EQ(of(1), 0.0f);
}

TEST(FilmPasses, HalvesBringTheirPass) {
  EXPECT_EQ(kept_passes(bit(Pass::NormalHalves)), bit(Pass::Combined) | bit(Pass::DenoisingNormal));
  EXPECT_EQ(Film::bytes_needed(1, 1, bit(Pass::NormalHalves), 1), kPlain + 3 * sizeof(double) + 3 * sizeof(float));
  EXPECT_EQ(Film::bytes_needed(1, 1, bit(Pass::Halves), 1), kPlain + 3 * sizeof(float));
}

TEST(FilmPasses, AreKeptOnlyWhereAskedFor) {
  const uint32_t direct = 1u << LANCER_PASS_GLOSSY_DIRECT;
  const Film film(1, 1, 1, direct);
  EXPECT_TRUE(film.has(Pass::Combined));
  // The divisor is stored, but reading it was not requested.
  EXPECT_FALSE(film.has(pass(LANCER_PASS_GLOSSY_COLOR)));
  EXPECT_EQ(Film::bytes_needed(1, 1, 0, 1), kPlain);
  EXPECT_EQ(Film::bytes_needed(1, 1, direct, 1), kPlain + 6 * sizeof(double));
  EXPECT_EQ(Film::bytes_needed(1, 1, direct | 1u << LANCER_PASS_GLOSSY_COLOR, 1), kPlain + 6 * sizeof(double));
  EXPECT_EQ(Film::bytes_needed(1, 1, bit(Pass::Depth), 1), kPlain + sizeof(float));
  EXPECT_EQ(Film::bytes_needed(1, 1, bit(Pass::Position), 1), kPlain + 3 * sizeof(float));
}

TEST(FilmPasses, AChannelWithoutColorIsGrey) {
  EXPECT_EQ(divide_by_color({1, 2, 3}, {2, 2, 2}), glm::dvec3(0.5, 1.0, 1.5));
  EXPECT_EQ(divide_by_color({1, 0, 3}, {2, 0, 2}), glm::dvec3(0.5, 1.0, 1.5));
  EXPECT_EQ(divide_by_color({0, 0, 3}, {0, 0, 2}), glm::dvec3(1.5));
  EXPECT_EQ(divide_by_color({1, 2, 3}, {0, 0, 0}), glm::dvec3(0.0));
}

TEST(FilmPasses, MistIsWhatIsNotClear) {
  SampleResult clear, sky, bright;
  clear.mist = 0.75f;
  // Split paths may slightly exceed a weight of 1.
  bright.mist = 1.5f;
  EXPECT_EQ(read(*film_of({clear, sky}), Pass::Mist)[0], 0.625f);
  EXPECT_EQ(read(*film_of({sky}), Pass::Mist)[0], 1.0f);
  EXPECT_EQ(read(*film_of({bright}), Pass::Mist)[0], 0.0f);
}

TEST(FilmPasses, VectorsAreTheMeanOfThoseThereAre) {
  SampleResult first, second, sky;
  first.vector = {1.0f, -2.0f, 3.0f, 0.5f};
  second.vector = {3.0f, 2.0f, 4.0f, 1.5f};
  first.vector_weight = second.vector_weight = 1.0f;
  EXPECT_EQ(read(*film_of({first, sky, second, sky, sky}), Pass::Vector), (std::vector<float>{2.0f, 0.0f, 3.5f, 1.0f}));
  EXPECT_EQ(read(*film_of({sky}), Pass::Vector), std::vector<float>(4, 0.0f));
  EXPECT_EQ(Film::bytes_needed(1, 1, bit(Pass::Vector), 1), kPlain + 5 * sizeof(double));
}

TEST(FilmPasses, FiniteMeansEveryNumberThatIsSummed) {
  const float nan = std::nanf("");
  const Film plain(1, 1, 1, 0), all(1, 1, 1, kAll);
  SampleResult result(true);
  EXPECT_TRUE(plain.finite(result) && all.finite(result));
  result.light[kLightPasses - 1].y = nan;
  EXPECT_TRUE(plain.finite(result));
  EXPECT_FALSE(all.finite(result));
  result = SampleResult{};
  result.alpha = INFINITY;
  EXPECT_FALSE(plain.finite(result));
}

} // namespace
} // namespace lancer
