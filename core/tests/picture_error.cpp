// The error of films whose samples are random numbers of known variance; and the resulting refinement.
#include "render/picture_error.h"
#include "sampling/sobol.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

constexpr uint32_t kSize = 64;

// Fills the film with independent samples: draw(random, x, y) returns one.
template <class Draw> void fill(Film &film, uint32_t samples, uint32_t seed, Draw &&draw) {
  std::mt19937 random(seed);
  for (size_t i = 0; i < film.tile_count(); ++i) {
    Film::Tile &tile = film.tile(i);
    std::vector<SampleResult> results(size_t(samples) * tile.pixels());
    for (size_t k = 0; k < results.size(); ++k) {
      const glm::uvec2 at = tile.place(uint32_t(k % tile.pixels()));
      results[k].radiance = glm::vec3(draw(random, at.x, at.y));
    }
    film.add(tile, samples, results);
  }
}

struct Case {
  const char *name;
  float (*draw)(std::mt19937 &random, uint32_t x, uint32_t y);
  double (*mean)(uint32_t x, uint32_t y);
};

float gaussian(std::mt19937 &random) { return std::normal_distribution<float>()(random); }
bool chance(std::mt19937 &random, double p) { return std::uniform_real_distribution<double>()(random) < p; }

const Case kCases[] = {
    {"even noise", [](std::mt19937 &random, uint32_t, uint32_t) { return 1.0f + 0.5f * gaussian(random); },
     [](uint32_t, uint32_t) { return 1.0; }},
    {"a gradient of noise",
     [](std::mt19937 &random, uint32_t x, uint32_t) { return 1.0f + 0.02f * float(x) * gaussian(random); },
     [](uint32_t, uint32_t) { return 1.0; }},
    {"a bright clean half beside a dark noisy one",
     [](std::mt19937 &random, uint32_t x, uint32_t) { return x < kSize / 2 ? 5.0f : 0.2f * std::exp(gaussian(random)); },
     [](uint32_t x, uint32_t) { return x < kSize / 2 ? 5.0 : 0.2 * std::exp(0.5); }},
    {"half shadow", [](std::mt19937 &random, uint32_t x, uint32_t) { return chance(random, double(x) / kSize) ? 1.0f : 0.0f; },
     [](uint32_t x, uint32_t) { return double(x) / kSize; }},
    {"rare light on a dim wall",
     [](std::mt19937 &random, uint32_t, uint32_t) { return 0.2f + (chance(random, 0.01) ? 20.0f : 0.0f); },
     [](uint32_t, uint32_t) { return 0.4; }},
};

// Returns the true error of a picture, as defined in the header.
double real_error(const Case &scene, const LuminanceMap &map) {
  double level = 0.0, sum = 0.0;
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x)
      level += scene.mean(x, y) / (kSize * kSize);
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const double mean = scene.mean(x, y), off = map.unit * double(map.mean[y * kSize + x]) - mean;
      sum += off * off / ((mean + 0.01 * level) * (mean + 0.01 * level));
    }
  return std::sqrt(sum / (kSize * kSize));
}

// Returns the share of a pixel covered by a bright noise-free surface with an oblique edge in front of a dark noise-free one.
double covered(uint32_t x, uint32_t y) { return std::clamp(20.0 + 0.37 * double(y) - double(x), 0.0, 1.0); }

// The sum of the squared differences of the 3 x 3 pixels around two pixels, beyond the bound for noise. Inside the picture
// only.
float excess_around(const LuminanceMap &map, int x, int y, int dx, int dy) {
  float sum = 0.0f;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const int other_u = u + dx, other_v = v + dy, width = int(map.width), height = int(map.height);
      if (std::min({u, v, other_u, other_v}) < 0 || std::max(u, other_u) >= width || std::max(v, other_v) >= height)
        continue;
      const size_t p = size_t(v * width + u), q = size_t(other_v * width + other_u);
      const float apart = map.mean[p] - map.mean[q];
      sum += apart * apart - 4.0f * (map.variance[p] / map.count[p] + map.variance[q] / map.count[q]);
    }
  return sum;
}

TEST(PictureError, SimilarNeighboursAreThoseOfTheDefinition) {
  // Small integers, whose sums are exact in any order. The heights are those of one band, of one band and a row, and of
  // several.
  std::mt19937 random(5);
  for (const int height : {3, 33, 34, 80}) {
    constexpr int kWidth = 11;
    LuminanceMap map(Film(4, 4, 4, 1));
    map.width = kWidth, map.height = uint32_t(height);
    map.mean.clear(), map.variance.clear(), map.count.clear();
    for (int i = 0; i < kWidth * height; ++i) {
      map.mean.push_back(float(random() % 3));
      map.variance.push_back(float(random() % 2));
      map.count.push_back(4.0f);
    }
    for (const uint32_t threads : {1u, 3u}) {
      const SimilarNeighbours found(map, threads);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < kWidth; ++x) {
          float count = 1.0f, mean = map.mean[size_t(y * kWidth + x)], variance = map.variance[size_t(y * kWidth + x)];
          for (int v = std::max(0, y - 3); v <= std::min(height - 1, y + 3); ++v)
            for (int u = std::max(0, x - 3); u <= std::min(kWidth - 1, x + 3); ++u)
              if ((u != x || v != y) && excess_around(map, x, y, u - x, v - y) <= 0.0f) {
                count += 1.0f;
                mean += map.mean[size_t(v * kWidth + u)];
                variance += map.variance[size_t(v * kWidth + u)];
              }
          const size_t at = size_t(y * kWidth + x);
          ASSERT_EQ(found.count[at], count) << height << ": " << x << ", " << y;
          ASSERT_EQ(found.mean[at], mean);
          ASSERT_EQ(found.variance[at], variance);
        }
    }
  }
}

TEST(PictureError, BarsOfEdgesAreNotThoseOfTheirCleanFlanks) {
  // For pixels with a coverage of at least a tenth, so that 64 samples are nearly Gaussian. They share a variance: over an edge
  // share (1 - share) is 1/6 in the mean and at most 1/4, where 1.96 sqrt(4/6) = 1.6 standard deviations contain 89 %.
  double inside = 0.0, edges = 0.0, blurred = 0.0, clean = 0.0;
  for (uint32_t seed = 0; seed < 100; ++seed) {
    Film film(kSize, kSize, 16, 1);
    fill(film, 64, seed,
         [](std::mt19937 &random, uint32_t x, uint32_t y) { return chance(random, covered(x, y)) ? 2.0f : 0.5f; });
    const LuminanceMap map(film);
    const std::vector<float> bars = error_bars(map);
    for (uint32_t y = 0; y < kSize; ++y)
      for (uint32_t x = 0; x < kSize; ++x) {
        const double share = covered(x, y), bar = double(bars[y * kSize + x]);
        if (share == 0.0 || share == 1.0) {
          // The rounding error of differences of sums over the picture is far below this.
          blurred += bar > 1e-6;
          clean += 1.0;
        } else if (share > 0.1 && share < 0.9) {
          const double off = map.unit * double(map.mean[y * kSize + x]) - (0.5 + 1.5 * share);
          inside += std::abs(off) <= 1.96 * bar;
          edges += 1.0;
        }
      }
  }
  EXPECT_GT(edges, 3000.0);
  EXPECT_GT(inside / edges, 0.89);
  EXPECT_LT(inside / edges, 0.965);
  // A pixel covered to all but a hundredth looks like noise of its flank, if any, and spreads it to the 600 pixels around it.
  // This is one of the edge's pixels in a picture, which in half of the pictures has not hit the second surface.
  EXPECT_LT(blurred / clean, 0.5 * 600.0 / 4032.0);
}

double disc_seen(uint32_t x, uint32_t y) {
  const double off = std::hypot(x - 31.5, y - 31.5);
  return off < 20.0 ? 1.0 : off < 21.0 ? 0.25 : 0.0;
}

TEST(PictureError, IntervalsHoldTheErrorAndBarsThePixels) {
  // 40 pictures of each kind. Intervals may miss 7 % in the long run; of 200 Bernoulli trials with this probability more than
  // 26 fail once in a thousand times. Bars contain 95 +- 1.5 % of the pixels: chance adds sqrt(.95 .05 / 163840) = 0.05 % to
  // this.
  int missed = 0;
  for (const Case &scene : kCases) {
    double inside = 0.0;
    constexpr uint32_t kPictures = 40;
    for (uint32_t seed = 0; seed < kPictures; ++seed) {
      Film film(kSize, kSize, 16, 1);
      fill(film, 64, seed, scene.draw);
      const LuminanceMap map(film);
      const PictureError error = picture_error(map, RelativeVariance(map), 0.95);
      EXPECT_LE(error.low, error.error);
      EXPECT_LE(error.error, error.high);
      const double real = real_error(scene, map);
      missed += !(error.low <= real && real <= error.high);
      const std::vector<float> bars = error_bars(map);
      for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x) {
          const double off = map.unit * double(map.mean[y * kSize + x]) - scene.mean(x, y);
          // A noise-free pixel's mean is a float.
          inside += std::abs(off) <= 1.96 * double(bars[y * kSize + x]) + 1e-6 * scene.mean(x, y);
        }
    }
    const double share = inside / (double(kPictures) * kSize * kSize);
    EXPECT_GT(share, 0.9345) << scene.name;
    EXPECT_LT(share, 0.9655 + (scene.draw == kCases[2].draw ? 0.5 * 0.0345 : 0.0)) << scene.name;
  }
  EXPECT_LE(missed, 26);
}

// An edge across the pixel, at one of eight angles.
bool beyond_edge(const glm::dvec2 &u, uint32_t angle) {
  const double a = 0.1 + 0.15 * angle;
  return u.x * std::cos(a) + u.y * std::sin(a) > 0.6;
}

TEST(PictureError, IntervalsHoldWhereSequencesFallFasterThanRandomNumbers) {
  // Scrambled nets on edges: the variance falls as N^-1.5, and halves estimate 2^1.5 - 1 = 1.8 times it.
  double mean[8] = {};
  constexpr uint32_t kFine = 1024, kPictures = 20;
  for (uint32_t angle = 0; angle < 8; ++angle)
    for (uint32_t i = 0; i < kFine * kFine; ++i)
      mean[angle] += beyond_edge((glm::dvec2(i % kFine, i / kFine) + 0.5) / double(kFine), angle) / double(kFine * kFine);
  int held = 0;
  double told = 0.0;
  for (uint32_t seed = 0; seed < kPictures; ++seed) {
    Film film(kSize, kSize, 16, 1);
    std::vector<uint32_t> taken(kSize * kSize);
    fill(film, 64, seed, [&](std::mt19937 &, uint32_t x, uint32_t y) {
      const Sampler sampler(seed, x, y, taken[y * kSize + x]++);
      return beyond_edge(glm::dvec2(sampler.get2(kJointDimensions)), x % 8) ? 1.0f : 0.0f;
    });
    const LuminanceMap map(film);
    const PictureError error = picture_error(map, RelativeVariance(map), 0.95);
    double sum = 0.0, level = 0.0;
    for (const double m : mean)
      level += m / 8.0;
    for (uint32_t i = 0; i < kSize * kSize; ++i) {
      const double off = (map.unit * double(map.mean[i]) - mean[i % 8]) / (mean[i % 8] + 0.01 * level);
      sum += off * off / (kSize * kSize);
    }
    held += error.low <= std::sqrt(sum) && std::sqrt(sum) <= error.high;
    told += error.error / std::sqrt(sum) / kPictures;
  }
  // Of 20 trials that fail with a probability of 7 %, more than 5 fail once in a thousand times.
  EXPECT_GE(held, 15);
  // sqrt(1.8) = 1.35, and not below the true error.
  EXPECT_GT(told, 1.0);
  EXPECT_LT(told, 1.6);
}

TEST(PictureError, EdgesInTheBlackDoNotWidenIt) {
  // A noisy disc; one sample in four of its edge's pixels hits it. The black around it has missed no light.
  const Case disc = {"disc",
                     [](std::mt19937 &random, uint32_t x, uint32_t y) {
                       return chance(random, disc_seen(x, y)) ? 1.0f + 0.3f * gaussian(random) : 0.0f;
                     },
                     disc_seen};
  int held = 0;
  double told = 0.0;
  constexpr uint32_t kPictures = 20;
  for (uint32_t seed = 0; seed < kPictures; ++seed) {
    Film film(kSize, kSize, 16, 1);
    fill(film, 64, seed, disc.draw);
    const LuminanceMap map(film);
    const PictureError error = picture_error(map, RelativeVariance(map), 0.95);
    const double real = real_error(disc, map);
    held += error.low <= real && real <= error.high;
    told += error.error / real / kPictures;
  }
  // Of 20 trials that fail with a probability of 7 %, more than 5 fail once in a thousand times.
  EXPECT_GE(held, 15);
  // Twice the estimated error costs four times the samples for a target.
  EXPECT_LT(told, 2.0);
}

TEST(PictureError, FallsWithTheRootOfSamples) {
  // 0.5 / 1.01 / sqrt(n). The sum over 4096 pixels of squares of one difference each gives the root to 1 / sqrt(2 * 4096) = 1.1
  // %, and a quotient of two to 1.6 %: four times this is allowed.
  std::vector<double> errors;
  for (const uint32_t samples : {16u, 64u, 256u}) {
    Film film(kSize, kSize, 16, 1);
    fill(film, samples, 1, kCases[0].draw);
    const LuminanceMap map(film);
    const PictureError error = picture_error(map, RelativeVariance(map), 0.9999);
    EXPECT_LT(error.low, 0.5 / 1.01 / std::sqrt(double(samples)));
    EXPECT_GT(error.high, 0.5 / 1.01 / std::sqrt(double(samples)));
    errors.push_back(error.error);
  }
  EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.064 * 2.0);
  EXPECT_NEAR(errors[1] / errors[2], 2.0, 0.064 * 2.0);
}

TEST(PictureError, WhatWasNeverMetIsBoundedByTheRuleOfThree) {
  Film film(16, 16, 16, 1);
  fill(film, 8, 1, [](std::mt19937 &, uint32_t x, uint32_t y) { return x == 3 && y == 5 ? 256.0f : 1.0f; });
  const LuminanceMap map(film);
  const double mean = (255.0 + 256.0) / 256.0, missing = 3.0 * 256.0 / (256.0 * 8.0);
  EXPECT_NEAR(picture_error(map, RelativeVariance(map), 0.95).cannot_exclude, missing / (1.01 * mean), 1e-5);
}

TEST(PictureError, IsTheSameForLightFarBelowZeroAndFarAbove) {
  for (const float depth : {1e10f, 1e20f, 1e28f}) {
    PictureError errors[2];
    for (const bool below : {false, true}) {
      Film film(kSize, kSize, 16, 1);
      fill(film, 16, 9, [&](std::mt19937 &random, uint32_t x, uint32_t y) {
        const float light = x == 30 && y == 20 ? depth * std::exp(gaussian(random)) : 0.2f + 0.1f * gaussian(random);
        return below ? -light : light;
      });
      const LuminanceMap map(film);
      errors[below] = picture_error(map, RelativeVariance(map), 0.95);
      for (const float bar : error_bars(map))
        ASSERT_TRUE(std::isfinite(bar)) << depth;
    }
    EXPECT_TRUE(std::isfinite(errors[1].high) && errors[1].low > 0.0) << depth;
    EXPECT_EQ(errors[1].low, errors[0].low) << depth;
    EXPECT_EQ(errors[1].error, errors[0].error) << depth;
    EXPECT_EQ(errors[1].high, errors[0].high) << depth;
    EXPECT_EQ(errors[1].cannot_exclude, errors[0].cannot_exclude) << depth;
  }
}

TEST(PictureError, OfBlackAndOfEvenPicturesIsNone) {
  for (const float value : {0.0f, 3.0f}) {
    Film film(20, 9, 8, 1);
    fill(film, 4, 1, [&](std::mt19937 &, uint32_t, uint32_t) { return value; });
    const LuminanceMap map(film);
    const PictureError error = picture_error(map, RelativeVariance(map), 0.95);
    EXPECT_EQ(error.error, 0.0);
    EXPECT_EQ(error.high, 0.0);
    for (const float bar : error_bars(map))
      EXPECT_EQ(bar, 0.0f);
  }
}

TEST(Refinement, DoublesWhereTheOtherHalfIsNoisy) {
  Film film(kSize, kSize, 16, 1, true);
  fill(film, 64, 1, [](std::mt19937 &random, uint32_t x, uint32_t) {
    return x >= 48 ? 1.0f + 0.5f * gaussian(random) : 5.0f + 0.001f * gaussian(random);
  });
  const LuminanceMap map(film);
  const RelativeVariance relative(map);
  const double now = picture_error(map, relative, 0.95).error;
  // The last of four columns of squares has all of the noise, in eight halves. Doubling them all removes half of the variance,
  // which suffices for a factor of 1.9; doubling seven removes 7/16, which does not.
  const Refinement plan = plan_refinement(film, map, relative, now / std::sqrt(1.9), 1 << 20);
  EXPECT_EQ(plan.tiles.size(), 8u);
  for (const uint32_t tile : plan.tiles)
    EXPECT_GE(film.tile(tile).x, 48u);
  EXPECT_EQ(plan.samples, 64.0 * 16 * 64);
  // Without a target all are doubled, these first.
  const Refinement all = plan_refinement(film, map, relative, 0.0, 1 << 20);
  EXPECT_EQ(all.tiles.size(), film.tile_count());
  for (size_t i = 0; i < 8; ++i)
    EXPECT_GE(film.tile(all.tiles[i]).x, 48u);
  // No pixel exceeds the limit.
  EXPECT_TRUE(plan_refinement(film, map, relative, 0.0, 127).tiles.empty());
}

TEST(Refinement, IsBlindToTheSamplesThatItJudges) {
  // One half of a square is noisy, its other half is not: the noise-free half receives the samples.
  Film film(16, 16, 16, 1, true);
  fill(film, 64, 1,
       [](std::mt19937 &random, uint32_t x, uint32_t y) { return (x + y) % 2 ? 1.0f : 100.0f + 50.0f * gaussian(random); });
  const LuminanceMap map(film);
  const Refinement plan = plan_refinement(film, map, RelativeVariance(map), 0.0, 1 << 20);
  ASSERT_EQ(plan.tiles.size(), 2u);
  EXPECT_EQ(film.tile(plan.tiles[0]).cells, Film::Cells::Odd);
}

} // namespace
} // namespace lancer
