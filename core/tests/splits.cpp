// Split samples, with several lights and several branches: the same light on average, and the same choice of the split by every
// thread.
#include "picture_lab.h"

#include <array>
#include <gtest/gtest.h>
#include <memory>

namespace lancer_test {
namespace {

struct Way {
  uint32_t lights, paths;
};

class Splitting : public testing::Test {
protected:
  ~Splitting() override { lancer_scene_destroy(scene_); }

  lancer_session start(uint32_t samples) {
    lancer_session session = 0;
    EXPECT_EQ(lancer_session_create(scene_, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
    EXPECT_EQ(lancer_session_render(session, 0, samples), LANCER_OK) << lancer_last_error();
    EXPECT_EQ(finish(session), LANCER_OK);
    return session;
  }
  std::vector<float> read(lancer_session session, uint32_t pass, uint32_t channels) const {
    std::vector<float> image(size_t(camera.region_width) * camera.region_height * channels);
    EXPECT_EQ(lancer_session_read(session, pass, image.data(), image.size()), LANCER_OK) << lancer_last_error();
    return image;
  }
  // The mean over the pictures of this many seeds, and its standard error.
  struct Level {
    double mean, error;
  };
  Level level(const Way &way, uint32_t samples, uint32_t pass = LANCER_PASS_COMBINED, uint32_t channels = 4) {
    return level_of(way, samples, [&](lancer_session session) {
      const std::vector<float> image = read(session, pass, channels);
      double sum = 0.0;
      for (size_t i = 0; i < image.size(); ++i)
        sum += i % channels < 3 ? double(image[i]) : 0.0;
      return sum / double(image.size());
    });
  }
  template <class Value> Level level_of(const Way &way, uint32_t samples, Value &&value) {
    constexpr uint32_t kSeeds = 24;
    settings.split_lights = way.lights;
    settings.split_paths = way.paths;
    std::vector<double> levels;
    for (settings.seed = 0; settings.seed < kSeeds; ++settings.seed) {
      const lancer_session session = start(samples);
      levels.push_back(value(session));
      lancer_session_destroy(session);
    }
    double mean = 0.0, square = 0.0;
    for (const double of_seed : levels)
      mean += of_seed / kSeeds;
    for (const double of_seed : levels)
      square += (of_seed - mean) * (of_seed - mean);
    return {mean, std::sqrt(square / (kSeeds - 1) / kSeeds)};
  }
  // Means of renders that differ by chance only are more than four standard errors apart once in some ten thousand times
  // (Student, 46 degrees of freedom: 2e-4).
  static void expect_same(const Level &a, const Level &b) {
    EXPECT_LT(std::abs(a.mean - b.mean), 4.0 * std::hypot(a.error, b.error)) << a.mean << " and " << b.mean;
  }
  Way found(uint32_t samples = 16) {
    settings.split_lights = settings.split_paths = 0;
    const lancer_session session = start(samples);
    lancer_statistics statistics = {};
    lancer_session_statistics(session, &statistics);
    lancer_session_destroy(session);
    return {statistics.split_lights, statistics.split_paths};
  }

  lancer_scene scene_ = make_scene();
  lancer_camera camera = make_camera();
  lancer_settings settings = make_settings();
};

constexpr std::array<Way, 4> kWays = {Way{4, 1}, Way{1, 4}, Way{2, 3}, Way{8, 8}};

// The scene has glass, an emitting mirror, a lamp, a sky, and half transparent surfaces.
TEST_F(Splitting, BringsTheSameLight) {
  const Level plain = level({1, 1}, 8);
  for (const Way &way : kWays)
    expect_same(level(way, 8), plain);
}

// Each branch is clamped as if it were the only one of its sample: clamping removes the same amount.
TEST_F(Splitting, IsClampedAsOnePathIs) {
  const double open = level({1, 1}, 8).mean;
  settings.clamp_indirect = 0.02f;
  const Level plain = level({1, 1}, 8);
  EXPECT_LT(plain.mean, 0.99 * open);
  for (const Way &way : kWays)
    expect_same(level(way, 8), plain);
}

// Light removed by clamping, and light beyond the last bounce.
TEST_F(Splitting, DeclaresTheSameLosses) {
  settings.clamp_indirect = 0.1f;
  settings.max_bounces = 1;
  for (double lancer_error::*const share : {&lancer_error::clipped, &lancer_error::missing}) {
    const auto told = [&](lancer_session session) {
      lancer_error error = {};
      EXPECT_EQ(lancer_session_error(session, 0.95, &error), LANCER_OK);
      return error.*share;
    };
    const Level plain = level_of({1, 1}, 16, told);
    EXPECT_GT(plain.mean, 0.0);
    expect_same(level_of({2, 4}, 16, told), plain);
  }
}

TEST_F(Splitting, FillsPassesAsOnePathDoes) {
  settings.film_transparent = settings.transparent_glass = 1;
  settings.glass_roughness = 0.3f;
  const struct {
    uint32_t pass, channels;
  } passes[] = {{LANCER_PASS_NORMAL, 3},
                {LANCER_PASS_MIST, 1},
                {LANCER_PASS_ALBEDO, 3},
                {LANCER_PASS_DIFFUSE_INDIRECT, 3},
                {LANCER_PASS_GLOSSY_DIRECT, 3},
                {LANCER_PASS_GLOSSY_INDIRECT, 3},
                {LANCER_PASS_AMBIENT_OCCLUSION, 3},
                {LANCER_PASS_EMISSION, 3}};
  for (const auto &[pass, channels] : passes) {
    SCOPED_TRACE(pass);
    expect_same(level({2, 4}, 8, pass, channels), level({1, 1}, 8, pass, channels));
  }
}

// The parts of a picture sum to it, clamped or not.
TEST_F(Splitting, KeepsThePassesTogether) {
  for (const Way &way : {Way{1, 1}, Way{2, 4}})
    for (const float clamp : {0.0f, 0.05f}) {
      SCOPED_TRACE(clamp);
      settings.split_lights = way.lights;
      settings.split_paths = way.paths;
      settings.clamp_indirect = clamp;
      const lancer_session session = start(8);
      const std::vector<float> combined = read(session, LANCER_PASS_COMBINED, 4);
      std::vector<double> sum(combined.size() / 4 * 3);
      const auto add = [&](uint32_t pass, const std::vector<float> &color) {
        const std::vector<float> light = read(session, pass, 3);
        for (size_t i = 0; i < light.size(); ++i)
          sum[i] += double(light[i]) * (color.empty() ? 1.0 : double(color[i]));
      };
      add(LANCER_PASS_EMISSION, {});
      add(LANCER_PASS_ENVIRONMENT, {});
      for (const uint32_t first : {LANCER_PASS_DIFFUSE_DIRECT, LANCER_PASS_GLOSSY_DIRECT, LANCER_PASS_TRANSMISSION_DIRECT}) {
        const std::vector<float> color = read(session, first + 2, 3);
        add(first, color);
        add(first + 1, color);
      }
      lancer_session_destroy(session);
      // Floats of passes, each divided by a colour and multiplied by it again.
      for (size_t i = 0; i < sum.size(); ++i)
        EXPECT_NEAR(sum[i], double(combined[i / 3 * 4 + i % 3]), 1e-4 * std::max(1.0, sum[i]));
    }
}

// A matt ball on a matt floor under a uniform sky: all its noise is from the direction of branches.
lancer_scene make_open_scene() {
  lancer_scene scene = 0;
  lancer_scene_create(&scene);
  add_material(scene, {lobe(LANCER_LAMBERT, 0.6f)});
  lancer_instance instances[2] = {};
  place(instances[0].matrix, 0.0, 0.0, 0.0);
  place(instances[1].matrix, 0.0, 0.0, 1.0);
  instances[0].kind = LANCER_PLANE;
  instances[1].kind = LANCER_SPHERE;
  instances[0].slot_count = instances[1].slot_count = 1;
  const uint32_t slot = 0;
  lancer_scene_add_instances(scene, 2, instances, 1, &slot, nullptr, 0);
  lancer_world sky = {};
  sky.radiance = parameter(1.0f);
  lancer_scene_set_world(scene, &sky);
  lancer_scene_commit(scene, LANCER_BVH, 1);
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  return scene;
}

TEST_F(Splitting, IsFoundAlikeByAnyThreadsAndAnyRegion) {
  lancer_scene_destroy(scene_);
  scene_ = make_open_scene();
  settings.samples = 16;
  camera = make_camera(48, 32);
  const Way way = found();
  EXPECT_GT(way.lights * way.paths, 1u);
  std::vector<float> whole;
  for (const uint32_t threads : {1u, 2u, 5u}) {
    settings.threads = threads;
    const lancer_session session = start(16);
    const std::vector<float> image = read(session, LANCER_PASS_COMBINED, 4);
    lancer_session_destroy(session);
    EXPECT_TRUE(whole.empty() || whole == image) << threads;
    whole = image;
  }
  camera.x = 17;
  camera.y = 9;
  camera.region_width = 11;
  camera.region_height = 7;
  const lancer_session session = start(16);
  const std::vector<float> part = read(session, LANCER_PASS_COMBINED, 4);
  lancer_session_destroy(session);
  for (uint32_t y = 0; y < camera.region_height; ++y)
    for (uint32_t i = 0; i < 4 * camera.region_width; ++i)
      ASSERT_EQ(part[y * 4 * camera.region_width + i], whole[(y + camera.y) * 4 * 48 + 4 * camera.x + i]);
}

TEST_F(Splitting, IsFoundAlikeByAnySeed) {
  lancer_scene_destroy(scene_);
  scene_ = make_open_scene();
  settings.samples = 16;
  const Way way = found();
  for (settings.seed = 1; settings.seed < 20; ++settings.seed) {
    const Way other = found();
    EXPECT_EQ(other.lights, way.lights);
    EXPECT_EQ(other.paths, way.paths);
  }
}

TEST_F(Splitting, IsNotLookedForWhereFewSamplesArePlanned) {
  settings.samples = 15;
  const Way way = found(8);
  EXPECT_EQ(way.lights, 1u);
  EXPECT_EQ(way.paths, 1u);
}

TEST_F(Splitting, IsToldAndReplayed) {
  settings.split_lights = 2;
  settings.split_paths = 4;
  settings.pixel_filter = LANCER_FILTER_BOX;
  const lancer_session session = start(1);
  lancer_statistics statistics = {};
  lancer_session_statistics(session, &statistics);
  EXPECT_EQ(statistics.split_lights, 2u);
  EXPECT_EQ(statistics.split_paths, 4u);
  const std::vector<float> image = read(session, LANCER_PASS_COMBINED, 4);
  for (const uint32_t x : {3u, 8u, 15u}) {
    float rgba[4] = {};
    uint32_t vertices = 0;
    ASSERT_EQ(lancer_debug_sample(session, x, 6, 0, rgba, nullptr, 0, &vertices), LANCER_OK) << lancer_last_error();
    for (uint32_t channel = 0; channel < 3; ++channel)
      EXPECT_EQ(rgba[channel], image[(6 * camera.region_width + x) * 4 + channel]);
  }
  lancer_session_destroy(session);
}

TEST_F(Splitting, IsRefusedBeyondSixteen) {
  settings.split_paths = 17;
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create(scene_, &camera, &settings, &session), LANCER_ERROR_ARGUMENT);
  EXPECT_NE(std::string(lancer_last_error()).find("split_paths 17"), std::string::npos);
}

} // namespace
} // namespace lancer_test
