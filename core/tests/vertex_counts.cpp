// The number of vertices that a render counts.
#include "picture_lab.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

constexpr uint32_t kPixels = 24, kSamples = 4, kRays = kPixels * kPixels * kSamples;

// Returns the statistics of a surface that fills the view. Each camera ray hits it once.
lancer_statistics seen(const lancer_lobe &lobe, uint32_t passes, uint32_t threads, uint32_t integrator = LANCER_PATH) {
  Studio studio;
  studio.settings.integrator = integrator;
  studio.settings.passes = passes;
  studio.settings.threads = threads;
  studio.settings.samples = kSamples;
  studio.place(LANCER_PLANE, studio.add({lobe}));
  studio.add(studio.sun({0, 0, 1}));
  studio.look({0, 0, 1}, {0, 0, 0}, kPixels, 1.0);
  studio.render();
  return studio.statistics();
}

constexpr uint32_t kPicture = 1u << LANCER_PASS_COMBINED, kMore = kPicture | 1u << LANCER_PASS_DEPTH;

TEST(VertexCounts, CountTheSurfacesOfAPictureAlone) {
  for (const uint32_t threads : {1u, 2u, 5u}) {
    const lancer_statistics alone = seen(newest(LANCER_DIFFUSE, 0.5f, 0.0f), kPicture, threads);
    EXPECT_EQ(alone.camera_rays, kRays);
    EXPECT_EQ(alone.vertices, kRays);
  }
}

TEST(VertexCounts, CountThemWithOtherPassesAndLobes) {
  // Another pass beside the picture; a rare lobe.
  for (const lancer_statistics &statistics :
       {seen(newest(LANCER_DIFFUSE, 0.5f, 0.0f), kMore, 2), seen(newest(LANCER_SHEEN, 0.5f), kPicture, 2)}) {
    EXPECT_EQ(statistics.vertices, kRays);
  }
}

TEST(VertexCounts, CountThemInEveryIntegrator) {
  for (const uint32_t integrator : {LANCER_NORMALS, LANCER_CLASSIC}) {
    const lancer_statistics statistics = seen(lobe(LANCER_LAMBERT, 0.5f), kPicture, 2, integrator);
    EXPECT_EQ(statistics.vertices, kRays);
  }
}

TEST(VertexCounts, EmptySpaceHasNone) {
  Studio studio;
  studio.sky(1, 1, 1);
  studio.render();
  EXPECT_EQ(studio.statistics().vertices, 0u);
}

} // namespace
} // namespace lancer_test
