// Memory of the film: its estimate, and the picture when memory runs out.
#include "allocations.h"

#include "render/film.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lancer {
namespace {

using lancer_test::Allocations;

constexpr uint32_t kSamples = 7, kPixels = 2;

// Sample s is 2^s everywhere: each count has a different mean, and every sum is exact.
std::vector<SampleResult> powers() {
  std::vector<SampleResult> results;
  for (uint32_t s = 0; s < kSamples; ++s) {
    SampleResult result(true);
    result.radiance = glm::vec3(std::ldexp(1.0f, int(s)));
    result.depth = result.radiance.x;
    results.insert(results.end(), kPixels, result);
  }
  return results;
}

void add(Film &film, const std::vector<SampleResult> &results, uint32_t first, uint32_t count) {
  film.add(film.tile(0), count, std::span(results).subspan(size_t(first) * kPixels, size_t(count) * kPixels));
}

void expect_shows_what_it_counts(Film &film) {
  const uint32_t count = film.tile(0).count;
  std::vector<float> combined(kPixels * 4), depth(kPixels);
  film.read(Pass::Combined, combined);
  film.read(Pass::Depth, depth);
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    EXPECT_EQ(combined[pixel * 4], count ? float((std::ldexp(1.0, int(count)) - 1.0) / count) : 0.0f);
    EXPECT_EQ(depth[pixel], count ? 1.0f : 1e10f);
  }
}

TEST(FilmMemory, WithoutMemoryTheFilmShowsTheWholeSamplesThatItHas) {
  const auto results = powers();
  for (uint32_t before = 0; before < kSamples; ++before) {
    bool failed = true;
    for (uint64_t allowed = 0; failed; ++allowed) {
      SCOPED_TRACE(std::to_string(before) + " samples, then allocations: " + std::to_string(allowed));
      Film film(kPixels, 1, kPixels, bit(Pass::Combined) | bit(Pass::Depth));
      if (before)
        add(film, results, 0, before);
      try {
        const Allocations allocations(allowed);
        add(film, results, before, kSamples - before);
        failed = false;
      } catch (const std::bad_alloc &) {
      }
      const uint32_t count = film.tile(0).count;
      EXPECT_EQ(count == kSamples, !failed);
      expect_shows_what_it_counts(film);
      // With memory again it continues normally.
      if (failed)
        add(film, results, count, kSamples - count);
      EXPECT_EQ(film.tile(0).count, kSamples);
      expect_shows_what_it_counts(film);
    }
  }
}

TEST(FilmMemory, NeedsTheSumsThatWait) {
  Film film(kPixels, 1, kPixels, bit(Pass::Combined) | bit(Pass::Depth));
  const SampleResult results[kPixels] = {SampleResult(true), SampleResult(true)};
  for (uint32_t samples = 1; samples <= 40; ++samples) {
    film.add(film.tile(0), 1, results);
    const Film::Tile &tile = film.tile(0);
    const size_t kept = film.bytes() - sizeof(Film::Tile) - tile.nodes.size() * sizeof(tile.nodes[0]);
    const auto sums = uint32_t(std::popcount(samples));
    EXPECT_EQ(Film::bytes_needed(kPixels, 1, bit(Pass::Combined) | bit(Pass::Depth), sums), double(kept)) << samples;
  }
}

} // namespace
} // namespace lancer
