// Sums of mattes: the fixed tree of the film, id by id, and the limit of ids in a pixel.
#include "lancer.h"
#include "render/film.h"
#include "render/parts.h"

#include <bit>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace lancer {
namespace {

constexpr uint32_t kPixels = 3;
constexpr ExtraLayout kObjects{.mattes = 1u << kObjectMattes};

// Shares over many magnitudes: any other order of sums would change the last digits.
Extras random_extras(uint32_t samples, uint32_t ids) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> exponent(-30.0f, 0.0f);
  Extras extras;
  extras.begin(samples * kPixels, kObjects);
  for (uint32_t sample = 0; sample < samples * kPixels; ++sample)
    for (uint32_t count = random() % 4; count > 0; --count)
      extras.mattes.push_back({sample, std::exp2(exponent(random)), {1 + uint32_t(random()) % ids, 0, 0}});
  return extras;
}

Extras slice(const Extras &all, uint32_t first, uint32_t count) {
  Extras part;
  for (MatteShare matte : all.mattes)
    if (matte.sample >= first * kPixels && matte.sample < (first + count) * kPixels) {
      matte.sample -= first * kPixels;
      part.mattes.push_back(matte);
    }
  return part;
}

std::vector<float> read(const Film &film, uint32_t levels) {
  std::vector<float> all;
  for (uint32_t level = 0; level < levels; ++level) {
    std::vector<float> out(4 * film.width());
    film.read_mattes(kObjectMattes, level, out);
    all.insert(all.end(), out.begin(), out.end());
  }
  return all;
}

void fill(Film &film, const Extras &extras, const std::vector<uint32_t> &split) {
  uint32_t first = 0;
  for (const uint32_t count : split) {
    const std::vector<SampleResult> results(size_t(count) * kPixels);
    film.add(film.tile(0), count, results, slice(extras, first, count));
    first += count;
  }
}

// Ids have the bits of floats that NaN may be among: compare bits.
std::vector<uint32_t> bits(const std::vector<float> &values) {
  std::vector<uint32_t> found;
  for (const float value : values)
    found.push_back(std::bit_cast<uint32_t>(value));
  return found;
}

std::vector<uint32_t> film_of(const Extras &extras, const std::vector<uint32_t> &split) {
  Film film(kPixels, 1, kPixels, 1, false, kObjects);
  fill(film, extras, split);
  return bits(read(film, 40));
}

TEST(MatteSums, AnySplitGivesTheSameBits) {
  for (const uint32_t ids : {3u, 20u, 500u}) {
    const Extras extras = random_extras(157, ids);
    const auto whole = film_of(extras, {157});
    EXPECT_EQ(whole, film_of(extras, {1, 1, 2, 4, 8, 16, 32, 64, 29}));
    EXPECT_EQ(whole, film_of(extras, std::vector<uint32_t>(157, 1)));
    EXPECT_EQ(whole, film_of(extras, {100, 50, 7}));
  }
}

TEST(MatteSums, AreTheSumsOfEachId) {
  constexpr uint32_t kSamples = 64;
  const Extras extras = random_extras(kSamples, 9);
  Film film(kPixels, 1, kPixels, 1, false, kObjects);
  fill(film, extras, {kSamples});
  // Along the tree, in double.
  std::vector<std::map<uint32_t, std::vector<double>>> terms(kPixels);
  for (const MatteShare &matte : extras.mattes) {
    auto &of_id = terms[matte.sample % kPixels][matte.ids[0]];
    of_id.resize(kSamples);
    of_id[matte.sample / kPixels] += double(matte.share);
  }
  const auto read_out = read(film, 8);
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    std::map<uint32_t, float> expected, found;
    for (auto [id, sums] : terms[pixel]) {
      for (uint32_t size = kSamples / 2; size > 0; size /= 2)
        for (uint32_t i = 0; i < size; ++i)
          sums[i] = sums[2 * i] + sums[2 * i + 1];
      expected[id] = float(sums[0] / kSamples);
    }
    float before = 2.0f;
    for (uint32_t rank = 0; rank < 16; ++rank) {
      const float *at = read_out.data() + (rank / 2 * kPixels + pixel) * 4 + 2 * (rank % 2);
      if (const uint32_t id = std::bit_cast<uint32_t>(at[0]))
        found[id] = at[1];
      EXPECT_LE(at[1], before);
      before = at[1];
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(MatteSums, KeepTheLargestOfACrowd) {
  constexpr uint32_t kIds = 3 * LANCER_MOST_MATTES;
  Film film(1, 1, 1, 1, false, kObjects);
  Extras extras;
  for (uint32_t id = 1; id <= kIds; ++id)
    extras.mattes.push_back({0, 1.0f / float(id), {id, 0, 0}});
  film.add(film.tile(0), 1, std::vector<SampleResult>(1), extras);
  const auto out = read(film, LANCER_MOST_MATTES / 2 + 1);
  for (uint32_t rank = 0; rank < LANCER_MOST_MATTES; ++rank)
    EXPECT_EQ(std::bit_cast<uint32_t>(out[4 * (rank / 2) + 2 * (rank % 2)]), rank + 1);
  EXPECT_EQ(out[2 * LANCER_MOST_MATTES], 0.0f);
}

TEST(MatteSums, ACrowdNeedsLittleMemory) {
  Film film(kPixels, 1, kPixels, 1, false, kObjects);
  fill(film, random_extras(1024, 1u << 30), {1024});
  EXPECT_LT(film.bytes(), kPixels * (2 * LANCER_MOST_MATTES * 12 + 2000));
}

} // namespace
} // namespace lancer
