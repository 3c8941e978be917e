// Light Path nodes: data of the ray that hits a world, lamp or surface, and of the vertex that samples its light.
#include "picture_lab.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

struct Measured {
  double mean, error; // standard error of the mean
};

// A white floor under a sky of 1 + Ray Depth, seen from above. directed: nodes read the direction, too, without effect.
Measured floor_under_sky(bool directed) {
  constexpr uint32_t kPixels = 16;
  Studio studio;
  studio.settings.samples = 256;
  studio.settings.max_bounces = 1;
  lancer_node nodes[4] = {
      node(LANCER_NODE_LIGHT_PATH, LANCER_PATH_DEPTH), node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY_ADD, {result_of(1), constant(0.0f), constant(1.0f)}),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_ADD, {result_of(0), directed ? result_of(2) : constant(1.0f)})};
  lancer_world world = {};
  world.radiance = result_of(3);
  world.nodes = nodes;
  world.node_count = 4;
  world.map_resolution = 16;
  studio.add(world);
  studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
  studio.look({0, 0, 1}, {0, 0, 0}, kPixels, 1.0);
  studio.render();
  const std::vector<float> picture = studio.read(LANCER_PASS_COMBINED, 4);
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < picture.size(); i += 4) {
    sum += double(picture[i]);
    squares += double(picture[i]) * double(picture[i]);
  }
  constexpr double kCount = double(kPixels) * kPixels;
  const double mean = sum / kCount;
  return {mean, std::sqrt(std::max(squares / kCount - mean * mean, 0.0) / kCount)};
}

// As in Cycles (5.0 and 5.2: 2.82288 and 3.0).
// For a light sample the sky is one scattering event beyond the floor: 2; a ray that hits it counts itself, too: 3. By the
// power heuristic the second technique has the weight c^2 / (c^2 + 1 / 16) at the cosine c, for densities c / pi and
// 1 / (4 pi), so that the floor sends 2 + the integral of 2 c c^2 / (c^2 + 1 / 16) from 0 to 1, which is 2 + 1 - ln(17) / 16.
TEST(LightPaths, ASampledSkyLiesOneScatteringBeyond) {
  const Measured seen = floor_under_sky(true);
  // The pixels are independent: five standard errors of their mean, precise enough to distinguish one scattering event from
  // none.
  EXPECT_NEAR(seen.mean, 3.0 - std::log(17.0) / 16.0, 5.0 * seen.error);
  EXPECT_LT(5.0 * seen.error, 0.05);
}

// A sky without directional variation is not a light, and only rays hit it. A few roundings of floats.
TEST(LightPaths, ASkyWithoutDirectionsIsMetByRaysAlone) { EXPECT_NEAR(floor_under_sky(false).mean, 3.0, 3.0 * 8 * 0x1p-24); }

// An emitting ball over a floor, with light samples and ray hits: both evaluate it one scattering event beyond the camera.
TEST(LightPaths, ASampledEmitterLiesOneScatteringBeyond) {
  const auto level = [](bool asks) {
    Studio studio;
    studio.settings.samples = 64;
    studio.settings.max_bounces = 1;
    lancer_material ball = glow(1.0f);
    if (asks)
      ball.emission = result_of(0);
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
    studio.place(LANCER_SPHERE, studio.add({}, ball, {node(LANCER_NODE_LIGHT_PATH, LANCER_PATH_DEPTH)}), moved(0, 0, 3));
    studio.look({4, 0, 1}, {0, 0, 0});
    studio.render();
    return studio.color().x;
  };
  // The counts are whole numbers: the same light by the same operations.
  EXPECT_GT(level(false), 0.05f);
  EXPECT_EQ(level(true), level(false));
}

// A surface along a shadow ray reads that ray's path: its kind, one scattering event, its length so far.
TEST(LightPaths, APaneAsksWhichShadowRayPasses) {
  // A lamp at height 4 of irradiance 1 on a white floor, a pane at height 2 that transmits `value` of it.
  const auto level = [](uint32_t which, float factor) {
    Studio studio;
    lancer_material pane = black();
    pane.transmittance = result_of(1);
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
    studio.place(LANCER_PLANE,
                 studio.add({}, pane,
                            {node(LANCER_NODE_LIGHT_PATH, which),
                             node(LANCER_NODE_MATH, LANCER_MATH_MULTIPLY, {result_of(0), constant(factor)})}),
                 moved(0, 0, 2));
    lancer_light lamp = point_light();
    to_rows(moved(0, 0, 4), lamp.matrix);
    lamp.radius = 0.0f;
    std::fill(lamp.emission, lamp.emission + 3, 16.0f * std::numbers::pi_v<float>);
    studio.add(lamp);
    // From below the pane, nearly straight down.
    studio.look({0.01, 0, 1}, {0, 0, 0});
    studio.render();
    return studio.color().x;
  };
  // The floor's share of light is 1 except for a hundredth's square, and float roundings.
  EXPECT_NEAR(level(LANCER_PATH_IS_SHADOW, 0.5f), 0.5f, 1e-4f);
  EXPECT_NEAR(level(LANCER_PATH_DEPTH, 0.25f), 0.25f, 1e-4f);
  EXPECT_NEAR(level(LANCER_PATH_LENGTH, 0.125f), 0.25f, 1e-4f);
  EXPECT_EQ(level(LANCER_PATH_IS_CAMERA, 1.0f), 0.0f);
}

} // namespace
} // namespace lancer_test
