// Several lights at once: two techniques share each of them, whichever light a sample chooses.
#include "light_choosers.h"
#include "picture_lab.h"

#include "lights/light_set.h"

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

namespace lancer {
namespace {

// Ten lamps, which have a tree of their own, beside a sun.
TEST(LightsChoice, KnowsItsOwnProbability) {
  std::vector<Light> lights(11);
  for (int i = 0; i < 10; ++i) {
    lights[size_t(i)].kind = LightKind::Point;
    lights[size_t(i)].emission = glm::dvec3(1.0 + i);
    lights[size_t(i)].position = {double(i), 0.5 * i, 3.0};
  }
  lights[10].kind = LightKind::Sun;
  lights[10].emission = glm::dvec3(0.5);
  const LightSet set(std::move(lights), {}, 0, Environment(), BuildContext{});
  const LightQuery query(glm::dvec3(2.0, 1.0, 0.0), glm::vec3(0.0f, 0.0f, 1.0f), false);
  bool lamp = false, sun = false;
  for (int i = 0; i < 64; ++i) {
    LightChoice choice = choose(set.binary_tree(), query, (i + 0.5) / 64.0);
    if (choice.number == set.size()) {
      const LightChoice of_many = choose(set.wide_tree(), query, choice.u);
      choice = {of_many.number, choice.probability * of_many.probability, of_many.u};
    }
    ASSERT_GT(choice.probability, 0.0);
    // The two ways multiply floats in another order.
    EXPECT_NEAR(choice.probability, set.probability(query, choice.number), 1e-5 * choice.probability);
    (choice.number == 10 ? sun : lamp) = true;
  }
  EXPECT_TRUE(lamp && sun);
}

} // namespace
} // namespace lancer
