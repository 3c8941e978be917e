// Complete renders through the C interface: determinism, cancelling, lifetime of handles, replay.
#include "scene/messages.h"
#include "tiny_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <thread>

namespace {

using namespace lancer_test;

std::vector<float> render(lancer_scene scene, const lancer_camera &camera, const lancer_settings &settings,
                          const std::vector<uint32_t> &split = {8}) {
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
  uint32_t first = 0;
  for (uint32_t count : split) {
    EXPECT_EQ(lancer_session_render(session, first, count), LANCER_OK) << lancer_last_error();
    EXPECT_EQ(finish(session), LANCER_OK) << lancer_last_error();
    first += count;
  }
  std::vector<float> image(size_t(camera.region_width) * camera.region_height * 4);
  EXPECT_EQ(lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size()), LANCER_OK);
  EXPECT_EQ(lancer_session_destroy(session), LANCER_OK);
  return image;
}

class Sessions : public testing::TestWithParam<uint32_t> {};

TEST_P(Sessions, BitsDoNotDependOnThreadsTilesOrSplits) {
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera();
  lancer_settings settings = make_settings(GetParam());
  const auto image = render(scene, camera, settings);
  EXPECT_EQ(image, render(scene, camera, settings, {1, 2, 5}));
  settings.threads = 1;
  EXPECT_EQ(image, render(scene, camera, settings));
  settings.tile_size = 7;
  EXPECT_EQ(image, render(scene, camera, settings));
  settings.features = LANCER_FEATURES_ALL;
  EXPECT_EQ(image, render(scene, camera, settings));
  settings.seed = 1;
  // NORMALS has one value per surface, but pixels at edges see another mixture.
  EXPECT_NE(image, render(scene, camera, settings));
  lancer_scene_destroy(scene);
}

TEST_P(Sessions, AcceleratorsGiveTheSameImage) {
  const lancer_camera camera = make_camera();
  const lancer_settings settings = make_settings(GetParam());
  std::vector<std::vector<float>> images;
  for (uint32_t accelerator : {LANCER_BVH, LANCER_KDTREE, LANCER_BRUTE_FORCE}) {
    const lancer_scene scene = make_scene(accelerator, LANCER_SHADING_GOURAUD);
    images.push_back(render(scene, camera, settings));
    lancer_scene_destroy(scene);
  }
  EXPECT_EQ(images[0], images[1]);
  EXPECT_EQ(images[0], images[2]);
}

TEST_P(Sessions, ReplayGivesWhatTheFilmGot) {
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera();
  const lancer_settings settings = make_settings(GetParam());
  lancer_session session = 0;
  ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK);
  lancer_session_render(session, 0, 1);
  ASSERT_EQ(finish(session), LANCER_OK);
  std::vector<float> image(24 * 16 * 4);
  lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size());
  for (uint32_t y = 0; y < 16; ++y) {
    for (uint32_t x = 0; x < 24; ++x) {
      float rgba[4];
      lancer_vertex vertices[2];
      uint32_t count = 0;
      ASSERT_EQ(lancer_debug_sample(session, x, y, 0, rgba, vertices, 2, &count), LANCER_OK);
      for (int c = 0; c < 4; ++c)
        EXPECT_EQ(rgba[c], image[(size_t(y) * 24 + x) * 4 + size_t(c)]);
    }
  }
  lancer_session_destroy(session);
  lancer_scene_destroy(scene);
}

INSTANTIATE_TEST_SUITE_P(AllIntegrators, Sessions, testing::Values(LANCER_PATH, LANCER_CLASSIC, LANCER_NORMALS));

TEST(Session, OutlivesItsScene) {
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera();
  const lancer_settings settings = make_settings();
  lancer_session session = 0;
  ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK);
  EXPECT_EQ(lancer_scene_destroy(scene), LANCER_OK);
  EXPECT_EQ(lancer_scene_destroy(scene), LANCER_ERROR_HANDLE);
  EXPECT_EQ(lancer_session_render(session, 0, 2), LANCER_OK);
  EXPECT_EQ(finish(session), LANCER_OK);
  EXPECT_EQ(lancer_session_destroy(session), LANCER_OK);
  EXPECT_EQ(lancer_session_render(session, 2, 1), LANCER_ERROR_HANDLE);
  EXPECT_EQ(lancer_session_destroy(session), LANCER_ERROR_HANDLE);
  // A scene's handle is not a session's.
  EXPECT_EQ(lancer_session_cancel(scene), LANCER_ERROR_HANDLE);
}

TEST(Session, CancelKeepsWhatThereIs) {
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera(64, 48);
  const lancer_settings settings = make_settings();
  lancer_session session = 0;
  ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK);
  ASSERT_EQ(lancer_session_render(session, 0, 1), LANCER_OK);
  ASSERT_EQ(finish(session), LANCER_OK);
  ASSERT_EQ(lancer_session_render(session, 1, 1u << 24), LANCER_OK);
  EXPECT_EQ(lancer_session_render(session, 1, 1), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_session_cancel(session), LANCER_OK);
  EXPECT_EQ(finish(session), LANCER_CANCELLED);
  std::vector<float> image(64 * 48 * 4);
  EXPECT_EQ(lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size()), LANCER_OK);
  for (size_t i = 3; i < image.size(); i += 4)
    EXPECT_GT(image[i], 0.0f);
  EXPECT_EQ(lancer_session_render(session, 1, 1), LANCER_ERROR_STATE);
  lancer_session_destroy(session);
  lancer_scene_destroy(scene);
}

TEST(Session, MayBeDestroyedWhileItRenders) {
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera(64, 48);
  const lancer_settings settings = make_settings();
  for (int i = 0; i < 5; ++i) {
    lancer_session session = 0;
    ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK);
    ASSERT_EQ(lancer_session_render(session, 0, 1u << 20), LANCER_OK);
    EXPECT_EQ(lancer_session_destroy(session), LANCER_OK);
  }
  lancer_scene_destroy(scene);
}

TEST(Session, TwoRunAtOnce) {
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera();
  const lancer_settings settings = make_settings();
  const auto alone = render(scene, camera, settings);
  std::vector<float> one, two;
  std::thread a([&] { one = render(scene, camera, settings); }), b([&] { two = render(scene, camera, settings); });
  a.join();
  b.join();
  EXPECT_EQ(alone, one);
  EXPECT_EQ(alone, two);
  lancer_scene_destroy(scene);
}

TEST(Session, RefusesWhatNoFilmCanHave) {
  const lancer_scene scene = make_scene();
  lancer_camera camera = make_camera();
  lancer_settings settings = make_settings();
  settings.passes = 1u << LANCER_PASS_COMBINED;
  lancer_session session = 0;
  camera.width = camera.height = camera.region_width = camera.region_height = 4000000000u;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_ERROR_MEMORY);
  EXPECT_NE(std::string(lancer_last_error()).find("4000000000"), std::string::npos);
  EXPECT_EQ(std::string(lancer_last_error()).find("denoising"), std::string::npos);
  lancer_settings denoised = settings;
  denoised.passes |= 1u << LANCER_PASS_ALBEDO_HALVES;
  EXPECT_EQ(lancer_session_create(scene, &camera, &denoised, &session), LANCER_ERROR_MEMORY);
  EXPECT_NE(std::string(lancer_last_error()).find("denoising"), std::string::npos);
  camera.region_width = 0;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_session_create(scene, nullptr, &settings, &session), LANCER_ERROR_ARGUMENT);
  lancer_scene_destroy(scene);
}

TEST(Session, RefusesSamplesWhoseSumsNoFilmCanKeep) {
  // One sum of every pixel takes half of the film's limit; seven samples are held in three sums.
  const double most = 0.8 * lancer::physical_memory();
  const auto side = uint32_t(std::sqrt(most / 2.0 / (4 * sizeof(double))));
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera(side, side);
  lancer_settings settings = make_settings();
  settings.passes = 1u << LANCER_PASS_COMBINED;
  settings.tile_size = 256;
  settings.samples = 1;
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
  lancer_session_destroy(session);
  settings.samples = 7;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_ERROR_MEMORY);
  EXPECT_NE(std::string(lancer_last_error()).find(", 7 samples need"), std::string::npos) << lancer_last_error();
  lancer_scene_destroy(scene);
}

} // namespace
