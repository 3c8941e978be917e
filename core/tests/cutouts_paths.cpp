// Paths skip cut-out layers as if they had stopped there, and every pass agrees.
#include "foliage_pictures.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// Each feature alone, and all at once.
const Planting kPlantings[] = {
    {},
    {.lamps = true},
    {.holdout = true},
    {.hidden = true},
    {.mirrored = true},
    {.leaf_flags = LANCER_MATERIAL_OPAQUE_SHADOWS, .lamps = true},
    {.leaf_flags = LANCER_MATERIAL_OPAQUE_SHADOWS, .lamps = true, .holdout = true, .hidden = true, .mirrored = true}};

constexpr uint32_t kCombined = 1u << LANCER_PASS_COMBINED, kEverything = (1u << LANCER_PASS_COUNT) - 1;

IntegratorSettings three_bounces(uint32_t passes) {
  IntegratorSettings settings;
  settings.max_bounces = 3;
  settings.passes = passes;
  settings.mist_start = 3.0f;
  settings.mist_depth = 5.0f;
  return settings;
}

// A ray restarted behind a layer hits the next within roundings of double. They change the last digit of a sample's floats
// occasionally, 2^-24 of radiances up to 1, in each of some 2^6 operations.
constexpr double kLightError = 0x1p-18;

TEST(Cutouts, PathsGoPastWhatIsNotThereAsIfTheyHadStopped) {
  const auto stopping = foliage(Writing::Unknown);
  IntegratorSettings settings = three_bounces(kCombined);
  for (const Writing writing : {Writing::Plain, Writing::Mixed, Writing::Disguised}) {
    const auto scene = foliage(writing);
    for (const uint32_t limit : {0u, 1u, 3u, 8u}) {
      settings.transparent_bounces = limit;
      const Picture fast = picture(*scene, settings), slow = picture(*stopping, settings);
      EXPECT_LE(mean_difference(radiance(fast), radiance(slow)), kLightError) << limit;
      EXPECT_EQ(fast.counts.camera, slow.counts.camera);
      if (limit == 8) {
        EXPECT_LT(fast.counts.bounce, slow.counts.bounce * 3 / 4);
      }
    }
  }
  settings.transparent_bounces = 0;
  const Picture none = picture(*stopping, settings);
  settings.transparent_bounces = 8;
  EXPECT_GT(mean_difference(radiance(none), radiance(picture(*stopping, settings))), 0.01);
}

// Compares numbers that each side rounds to float once, computed from inputs equal except for roundings of double.
void expect_rounded(const glm::vec3 &a, const glm::vec3 &b, float least = 0x1p-24f) {
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(a[axis], b[axis], 0x1p-23f * std::max(std::abs(b[axis]), least));
}

void expect_the_same_place(const SampleResult &a, const SampleResult &b) {
  EXPECT_EQ(a.object_index, b.object_index);
  EXPECT_EQ(a.material_index, b.material_index);
  expect_rounded(glm::vec3(a.depth), glm::vec3(b.depth));
  expect_rounded(a.position, b.position);
  // A triangle's UVs are those of its corners, up to 1, times rounded weights.
  expect_rounded(a.uv, b.uv, 1.0f);
  // Normals of exact surfaces follow the place: one rounding to float, and three more to normalise.
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(a.normal[axis], b.normal[axis], 4 * 0x1p-24f);
}

void expect_the_same_light(const Picture &a, const Picture &b) {
  float brightest = 1.0f;
  for (const glm::vec3 &one : radiance(b))
    brightest = std::max({brightest, one.x, one.y, one.z});
  const auto expect = [&](auto &&ask) { EXPECT_LE(mean_difference(each(a, ask), each(b, ask)), kLightError * brightest); };
  expect([](const SampleResult &result) { return result.radiance; });
  expect([](const SampleResult &result) { return glm::vec3(result.alpha, result.mist, 0.0f); });
  for (uint32_t pass = 0; pass < kLightPasses; ++pass)
    expect([&](const SampleResult &result) { return result.light[pass]; });
}

TEST(Cutouts, PassesTellTheSameOfThem) {
  std::vector<std::vector<glm::vec3>> seen;
  for (const Planting &planting : kPlantings) {
    const auto plain = foliage(Writing::Plain, planting), stopping = foliage(Writing::Unknown, planting);
    for (const float threshold : {0.0f, 0.5f})
      for (const uint32_t limit : {0u, 2u, 8u, 2000u}) {
        SCOPED_TRACE(testing::Message() << &planting - kPlantings << ", threshold " << threshold << ", limit " << limit);
        IntegratorSettings settings = three_bounces(kEverything);
        settings.alpha_threshold = threshold;
        settings.transparent_bounces = limit;
        settings.film_transparent = limit == 8;
        settings.clamp_indirect = limit == 2 ? 0.1f : 0.0f;
        const Picture fast = picture(*plain, settings), slow = picture(*stopping, settings);
        for (size_t i = 0; i < fast.results.size(); ++i) {
          SCOPED_TRACE(i);
          expect_the_same_place(fast.results[i], slow.results[i]);
        }
        expect_the_same_light(fast, slow);
        // The picture does not depend on other passes.
        settings.passes = kCombined;
        const Picture alone = picture(*plain, settings);
        EXPECT_EQ(radiance(fast), radiance(alone));
        const auto alpha = [](const SampleResult &result) { return glm::vec3(result.alpha); };
        EXPECT_EQ(each(fast, alpha), each(alone, alpha));
        if (threshold == 0.0f && limit == 8)
          seen.push_back(radiance(slow));
      }
  }
  // All pictures are different.
  for (size_t i = 0; i < seen.size(); ++i)
    EXPECT_EQ(std::count(seen.begin(), seen.end(), seen[i]), 1) << i;
}

TEST(Cutouts, DenoisersAreToldTheSameOfThem) {
  for (const Planting &planting : kPlantings)
    for (const bool blended : {false, true}) {
      SCOPED_TRACE(testing::Message() << &planting - kPlantings << ", blended " << blended);
      IntegratorSettings settings = three_bounces(kEverything);
      settings.blended_features = blended;
      const Picture fast = picture(*foliage(Writing::Plain, planting), settings);
      const Picture slow = picture(*foliage(Writing::Unknown, planting), settings);
      expect_the_same_light(fast, slow);
      const auto expect = [&](auto &&ask) { EXPECT_LE(mean_difference(each(fast, ask), each(slow, ask)), kLightError); };
      expect([](const SampleResult &result) { return result.albedo; });
      expect([](const SampleResult &result) { return result.denoising_normal; });
      // A path that stops at each surface rounds each segment's length to float, at most nine before the last: 2^-24 each.
      for (size_t i = 0; i < fast.results.size(); ++i)
        EXPECT_NEAR(fast.results[i].denoising_depth, slow.results[i].denoising_depth,
                    10 * 0x1p-24f * slow.results[i].denoising_depth);
    }
}

bool same_bits(const Picture &a, const Picture &b) {
  return std::memcmp(a.results.data(), b.results.data(), a.results.size() * sizeof(SampleResult)) == 0;
}

TEST(Cutouts, AReplayedSampleIsTheSame) {
  for (const Writing writing : {Writing::Plain, Writing::Mixed})
    for (const Planting &planting : kPlantings) {
      SCOPED_TRACE(&planting - kPlantings);
      const auto scene = foliage(writing, planting);
      IntegratorSettings settings = three_bounces(kEverything);
      EXPECT_TRUE(same_bits(picture(*scene, settings), picture(*scene, settings, true)));
      // The picture alone, and with recorded vertices.
      settings.passes = kCombined;
      EXPECT_EQ(radiance(picture(*scene, settings)), radiance(picture(*scene, settings, true)));
    }
}

} // namespace
} // namespace lancer_test
