// Several lights at once: two techniques share each of them, whichever light a sample chooses.
#include "picture_lab.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

TEST(LightsChoice, AddUpUnderASky) {
  // A white floor under a sky of 1 and a wide sun of its own level receives both.
  for (const bool by_nodes : {false, true}) {
    Studio studio;
    studio.settings.samples = 1u << 16;
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
    studio.sky(1, 1, 1, 0, by_nodes);
    lancer_light sun = studio.sun({0, 0, 1}, std::numbers::pi_v<float>);
    sun.sun_angle = 0.2f;
    studio.add(sun);
    studio.render();
    // The sun's disk deviates by its radius of at most 0.1: the mean cosine is 1 - 0.1^2 / 4. The standard deviation of a
    // sample is that of the light choice, below the mean of 2: 4 standard errors of 2^16.
    EXPECT_NEAR(studio.color().x, 2.0 - 0.0025, 4.0 * 2.0 / 256.0);
  }
}

} // namespace
} // namespace lancer_test
