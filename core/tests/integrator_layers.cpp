// Transparent layers: their number, transmittance, and the passes of surfaces behind them.
#include "picture_lab.h"
#include "roundings.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

lancer_light sun_above(const Studio &studio) { return studio.sun({0, 0, 1}, std::numbers::pi_v<float>); }

// Returns the light through this many panes of transmittance 1/2 from a floor that emits, or is white under a sun.
float through(uint32_t panes, uint32_t limit, bool shines, uint32_t shadow_limit = 8, bool above = true, uint32_t flags = 0,
              uint32_t integrator = LANCER_PATH) {
  Studio studio;
  studio.settings.integrator = integrator;
  studio.settings.transparent_bounces = limit;
  studio.settings.transparent_shadows = shadow_limit;
  lancer_material half = pane(0.5f);
  half.flags = flags;
  const uint32_t number = studio.add({}, half);
  for (uint32_t i = 0; i < panes; ++i)
    studio.place(LANCER_PLANE, number, moved(0, 0, 1 + i));
  studio.place(LANCER_PLANE, shines ? studio.add({}, glow(1.0f)) : studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
  studio.add(sun_above(studio));
  studio.look({0, 0, above ? 20.0 : 0.5}, {0, 0, 0});
  studio.render();
  return studio.color().x;
}

TEST(Layers, APathPassesSoMany) {
  for (const uint32_t panes : {1u, 2u, 3u})
    for (const uint32_t limit : {1u, 2u, 3u, 4u}) {
      // Behind the last one there is only emission.
      for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC})
        EXPECT_EQ(through(panes, limit, true, 8, true, 0, integrator), panes <= limit ? std::ldexp(1.0f, -int(panes)) : 0.0f)
            << panes << " " << limit << " " << integrator;
      // Light from above passes the same number of panes once more.
      EXPECT_NEAR(through(panes, limit, false), panes < limit ? std::ldexp(1.0f, -2 * int(panes)) : 0.0f, kWhiteFloor)
          << panes << " " << limit;
    }
}

TEST(Layers, AShadowRayPassesSoMany) {
  for (const uint32_t panes : {1u, 2u, 3u})
    for (const uint32_t limit : {0u, 1u, 2u, 3u, 4u, 6u}) {
      EXPECT_NEAR(through(panes, 8, false, limit, false), panes <= limit ? std::ldexp(1.0f, -int(panes)) : 0.0f, kWhiteFloor);
      // Together with the panes that the path has passed.
      EXPECT_NEAR(through(panes, 8, false, limit), 2 * panes <= limit ? std::ldexp(1.0f, -2 * int(panes)) : 0.0f, kWhiteFloor);
    }
}

TEST(Layers, OpaqueShadows) {
  EXPECT_EQ(through(1, 8, true, 8, true, LANCER_MATERIAL_OPAQUE_SHADOWS), 0.5f);
  EXPECT_EQ(through(1, 8, false, 8, false, LANCER_MATERIAL_OPAQUE_SHADOWS), 0.0f);
}

TEST(Layers, AShadowRayEndsAtItsLamp) {
  // A lid beyond the lamp casts no shadow, through a pane or not.
  for (const bool with_pane : {false, true}) {
    Studio studio;
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
    if (with_pane)
      studio.place(LANCER_PLANE, studio.add({}, pane(1.0f)), moved(0, 0, 2));
    studio.place(LANCER_PLANE, studio.add({}, black()), moved(0, 0, 4.5));
    lancer_light lamp = point_light();
    to_rows(moved(0, 0, 4), lamp.matrix);
    lamp.radius = 0.0f;
    std::fill(lamp.emission, lamp.emission + 3, 16.0f * std::numbers::pi_v<float>);
    studio.add(lamp);
    studio.render();
    // The lamp's 16 pi over 4^2 is this irradiance.
    EXPECT_NEAR(studio.color().x, 1.0f, kWhiteFloor);
  }
}

TEST(Layers, TheClippedEndStaysWhereItIs) {
  for (const double clip_end : {11.9, 12.1}) {
    Studio studio;
    studio.place(LANCER_PLANE, studio.add({}, pane(0.5f)), moved(0, 0, 5));
    studio.place(LANCER_PLANE, studio.add({}, glow(1.0f)));
    studio.look({0, 0, 12}, {0, 0, 0});
    studio.camera.clip_end = clip_end;
    studio.render();
    EXPECT_EQ(studio.color().x, clip_end > 12.0 ? 0.5f : 0.0f);
  }
}

TEST(Layers, AHalfIsHalfOfTheWhole) {
  // A white plane of opacity 1/2 under a wide lamp has half the light of an opaque one: both sampling techniques share it.
  const auto level = [](float opacity) {
    Studio studio;
    lancer_lobe white = lobe(LANCER_LAMBERT, 1.0f);
    white.weight = constant(opacity);
    studio.settings.samples = 1u << 16;
    studio.place(LANCER_PLANE, studio.add({white}, pane(1.0f - opacity)));
    lancer_light lamp = point_light();
    to_rows(moved(0, 0, 1.5), lamp.matrix);
    lamp.radius = 1.0f;
    lamp.soft_falloff = 0;
    lamp.hidden_from = LANCER_RAY_CAMERA;
    studio.add(lamp);
    studio.render();
    return studio.color().x;
  };
  // The standard deviation of a sample is below twice the mean: 4 standard errors of 2^16 samples on either side.
  EXPECT_NEAR(level(0.5f) / level(1.0f), 0.5, 0.5 * 4.0 * 2.0 * std::sqrt(2.0) / 256.0);
}

// A faint pane 5 away, a denser one 7 away, and the floor 10 away or none.
std::unique_ptr<Studio> stack(float threshold, bool floor = true, uint32_t integrator = LANCER_PATH) {
  auto studio = std::make_unique<Studio>();
  studio->settings.integrator = integrator;
  studio->settings.alpha_threshold = threshold;
  lancer_material faint = pane(0.7f), dense = pane(0.4f), ground = black();
  faint.material_index = 11;
  dense.material_index = 12;
  ground.material_index = 13;
  studio->place(LANCER_PLANE, studio->add({}, faint), moved(0, 0, 5)).object_index = 1;
  studio->place(LANCER_PLANE, studio->add({}, dense), moved(0, 0, 3)).object_index = 2;
  if (floor)
    studio->place(LANCER_PLANE, studio->add({}, ground)).object_index = 3;
  studio->look({0, 0, 10}, {0, 0, 0});
  studio->render();
  return studio;
}

TEST(Layers, TheFirstThatIsDenseEnoughIsTheOneOfThePasses) {
  for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC})
    for (const auto &[threshold, number, depth] : {std::tuple(0.0f, 1, 5.0f), {0.5f, 2, 7.0f}, {0.7f, 3, 10.0f}}) {
      const auto studio = stack(threshold, true, integrator);
      EXPECT_FLOAT_EQ(studio->number(LANCER_PASS_DEPTH), depth);
      EXPECT_EQ(studio->number(LANCER_PASS_OBJECT_INDEX), float(number));
      EXPECT_EQ(studio->number(LANCER_PASS_MATERIAL_INDEX), float(10 + number));
      // A position has some ten roundings to double of numbers up to 10; 5, 3 and 0 are floats.
      EXPECT_NEAR(studio->color(LANCER_PASS_POSITION).z, 10.0f - depth, double_roundings(10, 10.0));
      expect_near(studio->color(LANCER_PASS_NORMAL), {0, 0, 1});
    }
  // Without a surface behind, panes below the threshold set no pass.
  const auto empty = stack(0.7f, false);
  EXPECT_EQ(empty->number(LANCER_PASS_DEPTH), 1e10f);
  EXPECT_EQ(empty->number(LANCER_PASS_OBJECT_INDEX), 0.0f);
  EXPECT_EQ(empty->number(LANCER_PASS_MATERIAL_INDEX), 0.0f);
  expect_near(empty->color(LANCER_PASS_POSITION), glm::vec3(0.0f), 0.0f);
  expect_near(empty->color(LANCER_PASS_NORMAL), glm::vec3(0.0f), 0.0f);
}

TEST(Layers, APixelCoversWhatTheWholeWayMakesOfIt) {
  // The bump of a height x^2 tilts by its own step at x = 0: the floor's light is this tilt, which shows the footprint.
  const auto size = [](double distance, bool with_pane, bool mirrored) {
    Studio studio;
    lancer_material ruler = black();
    ruler.emission = result_of(5);
    const std::vector<lancer_node> nodes = {
        node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT),
        node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
        node(LANCER_NODE_MATH, LANCER_MATH_MULTIPLY, {result_of(1), result_of(1)}),
        node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(2), constant(0.0f), constant(1.0f)}),
        node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_CROSS_PRODUCT, {result_of(3), constant(0, 0, 1)}),
        node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_LENGTH, {result_of(4)})};
    const double half = 0.5 * distance;
    if (mirrored) {
      studio.place(LANCER_PLANE, studio.add({lobe(LANCER_MIRROR, 1.0f)}));
      studio.place(LANCER_PLANE, studio.add({}, ruler, nodes), moved(0, 0, half));
    } else {
      studio.place(LANCER_PLANE, studio.add({}, ruler, nodes), moved(0, 0, half - distance));
    }
    if (with_pane)
      studio.place(LANCER_PLANE, studio.add({}, pane(1.0f)), moved(0, 0, 0.25 * half));
    studio.look({0, 0, half * (1 - 0x1p-20)}, {0, 0, 0});
    studio.camera.kind = LANCER_PERSPECTIVE;
    const double window[4] = {-0x1p-9, 0x1p-9, -0x1p-9, 0x1p-9};
    std::copy(window, window + 4, studio.camera.window);
    studio.render();
    return studio.color().x;
  };
  const float near = size(4, false, false);
  EXPECT_GT(near, 0.0f);
  // A pixel centre off by a thousandth of a filter's width, and squares of steps below 2^-6.
  for (const bool with_pane : {false, true})
    for (const bool mirrored : {false, true}) {
      EXPECT_NEAR(size(4, with_pane, mirrored) / near, 1.0f, 2e-3f) << with_pane << mirrored;
      EXPECT_NEAR(size(8, with_pane, mirrored) / near, 2.0f, 4e-3f) << with_pane << mirrored;
    }
}

} // namespace
} // namespace lancer_test
