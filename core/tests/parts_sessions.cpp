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

MadeTile of_samples(uint32_t start, uint32_t level, uint32_t tile = 0) {
  MadeTile made;
  made.tile = tile;
  made.nodes = {{start, level, std::ldexp(1.0, int(level))}};
  return made;
}

// Samples 0 ... 11 of both tiles, or of tile 0 four fewer.
Bytes twelve_samples(bool gap) {
  MadeTile tiles[2] = {of_samples(0, 3), of_samples(0, 3, 1)};
  tiles[0].nodes.push_back({gap ? 12u : 8u, 2, 4.0});
  tiles[1].nodes.push_back({8u, 2, 4.0});
  return Made({tiles[0], tiles[1]}).bytes();
}

TEST(PartsAndEnds, OfNoRangeChangeNothing) {
  for (const auto &end : {lancer_session_cancel, lancer_session_stop})
    for (const bool gap : {false, true}) {
      const MadeJoiner joiner;
      ASSERT_EQ(import(joiner.handle, twelve_samples(gap)), LANCER_OK) << lancer_last_error();
      const Bytes before = exported(joiner.handle);
      end(joiner.handle);
      EXPECT_EQ(finish(joiner.handle), LANCER_OK);
      EXPECT_EQ(before, exported(joiner.handle));
      uint32_t count = 0;
      EXPECT_EQ(lancer_session_plan(joiner.handle, 0.0, 0.95, 0, nullptr, &count), LANCER_ERROR_STATE);
      EXPECT_EQ(std::string(lancer_last_error()).find("cancelled"), std::string::npos) << lancer_last_error();
    }
  const lancer_scene scene = named_scene();
  const Owned session(scene, settings_of_parts());
  lancer_session_cancel(session.handle);
  EXPECT_EQ(finish(session.handle), LANCER_OK);
  EXPECT_EQ(lancer_session_render(session.handle, 0, 1), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(finish(session.handle), LANCER_OK);
  lancer_scene_destroy(scene);
}

// A stop drops the last samples of whole tiles; of a tile with gaps, no sum has all samples below a power of two.
TEST(PartsAndEnds, KeepSumsAndCountsEqual) {
  const lancer_scene scene = named_scene();
  const Owned session(scene, made_settings(), make_camera(kMadeWidth, kMadeHeight));
  ASSERT_EQ(lancer_session_render(session.handle, 0, 2), LANCER_OK);
  ASSERT_EQ(finish(session.handle), LANCER_OK);
  ASSERT_EQ(import(session.handle, Made({of_samples(4, 2), of_samples(2, 0, 1)}).bytes()), LANCER_OK) << lancer_last_error();
  lancer_session_stop(session.handle);
  ASSERT_EQ(finish(session.handle), LANCER_OK);
  lancer_statistics statistics;
  lancer_session_statistics(session.handle, &statistics);
  EXPECT_EQ(statistics.samples, (6u + 2u) * kMadePixels);
  const Bytes part = exported(session.handle);
  const MadeJoiner joiner;
  EXPECT_EQ(import(joiner.handle, part), LANCER_OK) << lancer_last_error();
  lancer_scene_destroy(scene);
}

TEST(PartsAndEnds, AreForgottenByAClear) {
  const lancer_scene scene = named_scene();
  const Owned session(scene, settings_of_parts());
  const lancer_range endless = {0, 0, 1u << 30};
  ASSERT_EQ(lancer_session_render_ranges(session.handle, 1, &endless), LANCER_OK);
  lancer_session_cancel(session.handle);
  EXPECT_EQ(finish(session.handle), LANCER_CANCELLED);
  ASSERT_EQ(lancer_session_clear(session.handle), LANCER_OK);
  lancer_progress progress;
  EXPECT_EQ(lancer_session_wait(session.handle, 0, &progress), LANCER_OK);
  EXPECT_EQ(progress.samples, 0u);
  EXPECT_EQ(lancer_session_render(session.handle, 0, 1), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(finish(session.handle), LANCER_OK);
  lancer_scene_destroy(scene);
}

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

TEST(PartsWithoutSamples, DecideNoSplits) {
  const lancer_scene scene = named_scene();
  lancer_settings settings = settings_of_parts(), told = settings;
  settings.split_lights = settings.split_paths = 0;
  const Owned undecided(scene, settings), session(scene, settings), worker(scene, told);
  ASSERT_EQ(import(session.handle, exported(undecided.handle)), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(import(session.handle, exported(worker.handle)), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(import(session.handle, rendered(worker.handle, {{0, 0, 1}})), LANCER_OK) << lancer_last_error();
  lancer_statistics statistics;
  lancer_session_statistics(session.handle, &statistics);
  EXPECT_EQ(statistics.split_lights, told.split_lights);
  lancer_scene_destroy(scene);
}

TEST(PartsWithoutMemory, LetASessionStartAtSampleZero) {
  const lancer_scene scene = named_scene();
  const lancer_settings settings = made_settings();
  const lancer_camera camera = make_camera(kMadeWidth, kMadeHeight);
  const Owned whole(scene, settings, camera);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 2), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  const lancer_range range = {0, 5, 1};
  uint64_t allowed = 0;
  for (lancer_status status = LANCER_ERROR_MEMORY; status != LANCER_OK; ++allowed) {
    const Owned session(scene, settings, camera);
    {
      const Allocations allocations(allowed);
      status = lancer_session_render_ranges(session.handle, 1, &range);
    }
    ASSERT_TRUE(status == LANCER_OK || status == LANCER_ERROR_MEMORY) << lancer_last_error();
    ASSERT_EQ(finish(session.handle), LANCER_OK);
    if (status == LANCER_OK)
      break;
    ASSERT_EQ(lancer_session_render(session.handle, 0, 2), LANCER_OK) << lancer_last_error();
    ASSERT_EQ(finish(session.handle), LANCER_OK);
    expect_equal(whole.handle, session.handle);
  }
  EXPECT_GT(allowed, 2u);
  lancer_scene_destroy(scene);
}

// A camera that is far away in a large scene.
TEST(Joiner, TakesTheCamerasOfSessions) {
  lancer_scene scene = 0;
  lancer_scene_create(&scene);
  add_material(scene, {lobe(LANCER_LAMBERT, 0.5f)});
  lancer_instance ball = {};
  place(ball.matrix, 0.0, 0.0, 0.0, 1e19);
  ball.kind = LANCER_SPHERE;
  ball.slot_count = 1;
  const uint32_t slot = 0;
  ASSERT_EQ(lancer_scene_add_instances(scene, 1, &ball, 1, &slot, nullptr, 0), LANCER_OK) << lancer_last_error();
  lancer_scene_set_digest(scene, kDigest);
  ASSERT_EQ(lancer_scene_commit(scene, LANCER_BVH, 1), LANCER_OK);
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  const lancer_settings settings = made_settings();
  lancer_camera camera = make_camera(kMadeWidth, kMadeHeight);
  camera.matrix[7] = -4e19;
  camera.clip_end = 1e21;
  const Owned session(scene, settings, camera), joiner(0, settings, camera);
  EXPECT_EQ(import(joiner.handle, rendered(session.handle, {{0, 0, 2}})), LANCER_OK) << lancer_last_error();
  lancer_scene_destroy(scene);
}

} // namespace
