// Positions beyond the range of float: passes contain the largest float, and the picture is complete.
#include "tiny_scene.h"

#include <gtest/gtest.h>
#include <limits>

namespace {

using namespace lancer_test;

std::vector<float> read(lancer_session session, uint32_t pass, size_t channels) {
  std::vector<float> values(24 * 16 * channels);
  EXPECT_EQ(lancer_session_read(session, pass, values.data(), values.size()), LANCER_OK) << lancer_last_error();
  return values;
}

// A plane under a sphere of nearly the largest valid size, and a sky.
lancer_scene make_large_scene() {
  lancer_scene scene = 0;
  lancer_scene_create(&scene);
  add_material(scene, {lobe(LANCER_LAMBERT, 0.6f)});
  const uint32_t slot = 0;
  lancer_instance instances[2] = {};
  place(instances[0].matrix, 0.0, 0.0, 0.0);
  place(instances[1].matrix, 0.0, 0.0, 2e29, 1e29);
  instances[0].kind = LANCER_PLANE;
  instances[1].kind = LANCER_SPHERE;
  for (lancer_instance &instance : instances)
    instance.slot_count = 1;
  lancer_scene_add_instances(scene, 2, instances, 1, &slot, nullptr, 0);
  lancer_world sky = {};
  sky.radiance = parameter(0.1f, 0.2f, 0.3f);
  lancer_scene_set_world(scene, &sky);
  lancer_scene_commit(scene, LANCER_BVH, 1);
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  return scene;
}

TEST(PassesFarAway, EndWhereFloatEnds) {
  const lancer_scene scene = make_large_scene();
  lancer_camera camera = make_camera();
  // Along y over the plane, beyond the range of float.
  camera.matrix[7] = 1e39;
  camera.matrix[11] = 1e29;
  camera.clip_end = 1e31;
  const lancer_settings settings = make_settings();
  lancer_session session = 0;
  ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(lancer_session_render(session, 0, 1), LANCER_OK);
  ASSERT_EQ(finish(session), LANCER_OK);
  const float farthest = std::numeric_limits<float>::max();
  // The lowest row shows the plane.
  EXPECT_EQ(read(session, LANCER_PASS_POSITION, 3)[1], farthest);
  EXPECT_EQ(read(session, LANCER_PASS_UV, 3)[1], farthest);
  EXPECT_GT(read(session, LANCER_PASS_COMBINED, 4)[0], 0.0f);
  lancer_statistics statistics;
  lancer_session_statistics(session, &statistics);
  EXPECT_EQ(statistics.invalid_samples, 0u);
  lancer_session_destroy(session);
  lancer_scene_destroy(scene);
}

} // namespace
