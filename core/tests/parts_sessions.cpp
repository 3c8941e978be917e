// Sessions of parts in states that a farm reaches rarely: ends of ranges that nobody runs, gaps, missing memory, single pixels.
#include "allocations.h"
#include "parts_made.h"

#include <cmath>

namespace {

using namespace lancer_test;

// An empty scene, whose pixels show nothing but an even background.
lancer_scene empty_scene() {
  lancer_scene scene = 0;
  EXPECT_EQ(lancer_scene_create(&scene), LANCER_OK);
  lancer_world sky = {};
  sky.radiance = parameter(0.1f, 0.2f, 0.3f);
  lancer_scene_set_world(scene, &sky);
  lancer_scene_set_digest(scene, kDigest);
  lancer_scene_commit(scene, LANCER_BVH, 1);
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  return scene;
}

// A stop drops the last samples of whole tiles; of a tile with gaps, no sum has all samples below a power of two.
// A square of one pixel is a tile, and a tile without pixels.
TEST(PartsOfSinglePixels, HaveAnErrorAndAreRefined) {
  const lancer_scene scene = named_scene();
  for (const uint32_t side : {1u, 17u}) {
    const lancer_settings settings = settings_of_parts();
    const lancer_camera camera = make_camera(side, side);
    const Owned session(scene, settings, camera), joiner(0, settings, camera);
    ASSERT_EQ(lancer_session_render(session.handle, 0, 2), LANCER_OK);
    ASSERT_EQ(finish(session.handle), LANCER_OK);
    ASSERT_EQ(import(joiner.handle, exported(session.handle)), LANCER_OK) << lancer_last_error();
    lancer_error error;
    lancer_session_error(joiner.handle, 0.95, &error);
    EXPECT_TRUE(std::isfinite(error.error)) << side;
    uint32_t count = 0;
    EXPECT_EQ(lancer_session_plan(joiner.handle, 0.0, 0.95, 0, nullptr, &count), LANCER_OK) << lancer_last_error();
    EXPECT_EQ(count, side == 1 ? 1u : 7u);
    EXPECT_EQ(lancer_session_refine(session.handle, 0.0, 0.95), LANCER_OK) << lancer_last_error();
    EXPECT_EQ(finish(session.handle), LANCER_OK);
    lancer_session_error(session.handle, 0.95, &error);
    EXPECT_EQ(error.least_samples, 4u);
  }
  lancer_scene_destroy(scene);
}

TEST(PartsOfEvenBackgrounds, ContinueAfterGaps) {
  const lancer_scene scene = empty_scene();
  const lancer_settings settings = made_settings();
  const lancer_camera camera = make_camera(kMadeWidth, kMadeHeight);
  const Owned whole(scene, settings, camera), session(scene, settings, camera), source(scene, settings, camera);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 16), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  const Bytes missing = rendered(source.handle, {{0, 3, 5}});
  ASSERT_EQ(import(session.handle, rendered(source.handle, {{0, 0, 3}, {1, 0, 16}})), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(import(session.handle, rendered(source.handle, {{0, 8, 3}})), LANCER_OK) << lancer_last_error();
  const lancer_range last = {0, 11, 5};
  ASSERT_EQ(lancer_session_render_ranges(session.handle, 1, &last), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(finish(session.handle), LANCER_OK);
  ASSERT_EQ(import(session.handle, missing), LANCER_OK) << lancer_last_error();
  expect_equal(whole.handle, session.handle);
  lancer_scene_destroy(scene);
}

// A camera that is far away in a large scene.
} // namespace
