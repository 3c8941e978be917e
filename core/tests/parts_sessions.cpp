// Sessions of parts in states that a farm reaches rarely: ends of ranges that nobody runs, gaps, missing memory, single pixels.
#include "allocations.h"
#include "parts_made.h"

#include <cmath>

namespace {

using namespace lancer_test;

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

// A camera that is far away in a large scene.
} // namespace
