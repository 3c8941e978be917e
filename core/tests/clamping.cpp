// Clamping of indirect light: the removed and the remaining light.
#include "picture_lab.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// Returns the radiance of a wall with emission 10 behind panes of clear glass, or of glass that is not transparent in the film.
// paths: limit of a sample's branches at its first surface that can split.
float seen_through(int panes, float clamp, bool clear, uint32_t paths) {
  Studio studio;
  studio.settings.split_lights = 1;
  studio.settings.split_paths = paths;
  studio.settings.max_bounces = 4;
  studio.settings.clamp_indirect = clamp;
  studio.settings.film_transparent = studio.settings.transparent_glass = clear;
  lancer_lobe glass = lobe(LANCER_REFRACTION, 1.0f, 0.0f);
  glass.ior = constant(1.0f);
  glass.rules = LANCER_RULES_BLENDER_45;
  const uint32_t wall = studio.add({}, glow(10.0f)), pane = studio.add({glass});
  studio.place(LANCER_PLANE, wall);
  for (int i = 0; i < panes; ++i)
    studio.place(LANCER_PLANE, pane, moved(0, 0, 0.2 * (i + 1)));
  studio.render();
  return studio.color().x;
}

TEST(Clamping, TakesWhatCameByMoreThanOneScattering) {
  for (const bool clear : {false, true})
    for (const uint32_t paths : {1u, 8u}) {
      EXPECT_FLOAT_EQ(seen_through(0, 1.0f, clear, paths), 10.0f);
      EXPECT_FLOAT_EQ(seen_through(1, 1.0f, clear, paths), 10.0f);
      EXPECT_FLOAT_EQ(seen_through(2, 1.0f, clear, paths), 1.0f);
      EXPECT_FLOAT_EQ(seen_through(2, 0.0f, clear, paths), 10.0f);
      EXPECT_FLOAT_EQ(seen_through(2, 20.0f, clear, paths), 10.0f);
    }
}

} // namespace
} // namespace lancer_test
