// Several lights at once: each is found by two ways that share it, whichever light a sample has chosen.
#include "picture_lab.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

TEST(LightsChoice, AddUpUnderASky) {
  // A white floor under a sky of 1 and a wide sun of its own level shows both.
  for (const bool by_nodes : {false, true}) {
    Studio studio;
    studio.settings.samples = 1u << 16;
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
    studio.sky(1, 1, 1, 0, by_nodes);
    lancer_light sun = studio.sun({0, 0, 1}, std::numbers::pi_v<float>);
    sun.sun_angle = 0.2f;
    studio.add(sun);
    studio.render();
    // The sun's disk leans by its radius of 0.1 at most: the mean cosine is 1 - 0.1^2 / 4. The spread of a sample is that of
    // which light it asks, below the mean of 2: 4 standard errors of 2^16.
    EXPECT_NEAR(studio.color().x, 2.0 - 0.0025, 4.0 * 2.0 / 256.0);
  }
}

} // namespace
} // namespace lancer_test
