// Light that leaves a surface after a walk: where, by which normals, and when a surface is too shallow to enter.
#include "wax.h"

namespace lancer_test {
namespace {

// Level of each of about ten comparisons of means in this file.
const double kLevel = lancer::testing::sidak_level(lancer::testing::kSignificance, 10);
// A sample is a product of less than sixteen factors in single precision.
constexpr double kRoundings = 16.0 * 0x1p-24;

// Returns the mean radiance of a plane at z = 0 in parallel light.
Mean plane_in_light(const lancer_lobe &lobe, const glm::dvec3 &eye, const glm::dvec3 &towards, uint32_t samples) {
  Studio studio;
  studio.settings.samples = samples;
  studio.place(LANCER_PLANE, studio.add({lobe}));
  studio.add(studio.sun(towards, 3.0f));
  studio.look(eye, {0, 0, 0}, 64, 1.0);
  studio.render();
  return mean_of(studio.read(LANCER_PASS_COMBINED, 4));
}

// By Burley's profile all light that enters a plane leaves the plane, on the side of its entry.
TEST(SubsurfaceExits, APlaneReflectsAsIfItWereDiffuse) {
  for (const double side : {5.0, -5.0}) {
    const glm::dvec3 eye(0, 0, side), towards(0.8, 0, 0.12 * side);
    const Mean expected = plane_in_light(lobe(LANCER_LAMBERT, 0.6f), eye, towards, 1);
    const Mean got = plane_in_light(wax(LANCER_SUBSURFACE_BURLEY, 0.6f, 0.2f), eye, towards, 64);
    EXPECT_GT(same_mean_p_value(got, expected, kRoundings * expected.value), kLevel)
        << side << " " << got.value << " " << expected.value;
  }
}

TEST(SubsurfaceExits, BumpedExitsFollowTheRulesOfTheirVersion) {
  const glm::dvec3 eye(0, 0, 5), towards(0.96, 0, 0.28);
  std::vector<double> values;
  for (const uint32_t rules :
       {LANCER_RULES_BLENDER_3, LANCER_RULES_BLENDER_4, LANCER_RULES_BLENDER_45, LANCER_RULES_BLENDER_52}) {
    lancer_lobe below = wax(LANCER_SUBSURFACE_BURLEY, 0.6f, 0.2f), matt = lobe(LANCER_DIFFUSE, 0.6f, 0.0f);
    below.rules = matt.rules = rules;
    below.normal = matt.normal = constant(0.6f, 0.0f, 0.8f);
    const Mean expected = plane_in_light(matt, eye, towards, 1), got = plane_in_light(below, eye, towards, 64);
    EXPECT_GT(same_mean_p_value(got, expected, kRoundings * expected.value), kLevel)
        << rules << " " << got.value << " " << expected.value;
    values.push_back(expected.value);
  }
  EXPECT_NE(values[1], values[2]);
}

// The light that enters the half of a square beside its diagonal, seen from above; the other half has another material.
std::vector<float> half_of_square(const lancer_lobe &other, bool bumped) {
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const uint32_t triangles[] = {0, 2, 3, 0, 1, 2};
  const uint16_t slots[] = {0, 1};
  lancer_mesh square = {};
  square.positions = positions;
  square.triangles = triangles;
  square.material_slots = slots;
  square.vertex_count = 4;
  square.triangle_count = 2;
  Studio studio;
  studio.settings.samples = 16;
  studio.add(square);
  lancer_material material = black();
  std::vector<lancer_node> nodes;
  if (bumped) {
    nodes = {
        node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION),
        node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY_ADD, {result_of(0), constant(0.0f), constant(0.6f, 0.0f, 0.8f)})};
    material.normal = result_of(1);
  }
  const uint32_t first = studio.add({wax(LANCER_SUBSURFACE_BURLEY, 0.6f, 0.2f)});
  const uint32_t second = studio.add({other}, material, nodes);
  studio.place(LANCER_MESH, {first, second});
  studio.add(studio.sun({0.8, 0, 0.6}, 3.0f));
  studio.look({-0.2, 0.2, 5}, {-0.2, 0.2, 0}, 16, 0.2);
  studio.render();
  return studio.read(LANCER_PASS_COMBINED, 4);
}

// As in Cycles: the bump of a material without light below it turns no exit.
TEST(SubsurfaceExits, AnExitOnAnotherMaterialHasTheNormalOfLightBelowIt) {
  const lancer_lobe matt = lobe(LANCER_LAMBERT, 0.5f), deep = wax(LANCER_SUBSURFACE_SKIN, 0.5f, 0.1f);
  const std::vector<float> plain = half_of_square(matt, false);
  EXPECT_EQ(half_of_square(matt, true), plain);
  EXPECT_EQ(half_of_square(deep, false), plain);
  EXPECT_NE(half_of_square(deep, true), plain);
}

// Walks find the surface of an object whether or not its rays see it.
TEST(SubsurfaceExits, AWalkFindsAHiddenObject) {
  const auto picture = [](uint32_t method, uint32_t hidden_from) {
    Studio studio;
    studio.settings.samples = 4;
    studio.place(LANCER_SPHERE, studio.add({wax(method, 0.8f, 0.5f)})).hidden_from = hidden_from;
    studio.sky(0.3f, 0.3f, 0.3f);
    studio.look({0, 0, 5}, {0, 0, 0}, 8, 1.6);
    studio.render();
    return studio.read(LANCER_PASS_COMBINED, 4);
  };
  for (const uint32_t method : {LANCER_SUBSURFACE_BURLEY, LANCER_SUBSURFACE_RANDOM_WALK})
    EXPECT_EQ(picture(method, LANCER_RAY_DIFFUSE | LANCER_RAY_GLOSSY | LANCER_RAY_TRANSMISSION | LANCER_RAY_SHADOW),
              picture(method, 0));
}

TEST(SubsurfaceExits, SplitPathsHaveTheSameBitsOnAnyThreadsAndTiles) {
  const auto picture = [](uint32_t threads, uint32_t tile) {
    Studio studio;
    studio.settings.samples = 4;
    studio.settings.max_bounces = 4;
    studio.settings.split_paths = 4;
    studio.settings.split_lights = 2;
    studio.settings.threads = threads;
    studio.settings.tile_size = tile;
    const uint32_t floor = studio.add({lobe(LANCER_LAMBERT, 0.8f)});
    for (int i = 0; i < 4; ++i)
      studio.place(LANCER_SPHERE, studio.add({wax(uint32_t(i), 0.8f, 0.5f)}), moved(i % 2 * 2 - 1, i / 2 * 2 - 1, 0));
    studio.place(LANCER_PLANE, floor, moved(0, 0, -1));
    studio.add(studio.sun({0.8, 0, 0.6}, 3.0f));
    studio.sky(0.3f, 0.3f, 0.3f);
    studio.look({0, 0, 5}, {0, 0, 0}, 24, 5.0);
    studio.render();
    return studio.read(LANCER_PASS_COMBINED, 4);
  };
  const std::vector<float> one = picture(1, 24);
  EXPECT_EQ(picture(2, 5), one);
  EXPECT_EQ(picture(1, 7), one);
}

TEST(SubsurfaceExits, WithoutARadiusItIsDiffuse) {
  const auto picture = [](const lancer_lobe &lobe, uint32_t integrator) {
    Studio studio;
    studio.settings.samples = 4;
    studio.settings.integrator = integrator;
    studio.place(LANCER_SPHERE, studio.add({lobe}));
    studio.add(studio.sun({0, 1, 1}, 2.0f));
    studio.sky(0.3f, 0.3f, 0.3f);
    studio.look({0, 0, 5}, {0, 0, 0}, 8, 1.8);
    studio.render();
    return studio.read(LANCER_PASS_COMBINED, 4);
  };
  const lancer_lobe matt = lobe(LANCER_LAMBERT, 0.7f);
  EXPECT_EQ(picture(wax(LANCER_SUBSURFACE_SKIN, 0.7f, 0.0f), LANCER_PATH), picture(matt, LANCER_PATH));
  EXPECT_EQ(picture(wax(LANCER_SUBSURFACE_SKIN, 0.7f, 0.5f), LANCER_CLASSIC), picture(matt, LANCER_CLASSIC));
}

// Blender 4.0 to 4.3 takes radii below a quarter of a pixel as none.
TEST(SubsurfaceExits, ARadiusBelowAQuarterOfAPixelIsDiffuse) {
  constexpr uint32_t kPixels = 8;
  const auto picture = [&](const lancer_lobe &lobe) {
    Studio studio;
    studio.settings.samples = 4;
    studio.place(LANCER_PLANE, studio.add({lobe}));
    studio.sky(0.3f, 0.3f, 0.3f);
    studio.look({0, 0, 5}, {0, 0, 0}, kPixels, 1.0);
    studio.render();
    return studio.read(LANCER_PASS_COMBINED, 4);
  };
  const auto skin = [](float radius) {
    lancer_lobe result = wax(LANCER_SUBSURFACE_SKIN | 4, 0.7f, radius);
    result.rules = LANCER_RULES_BLENDER_4;
    return result;
  };
  constexpr float kQuarter = 0.25f / float(kPixels);
  const std::vector<float> matt = picture(lobe(LANCER_LAMBERT, 0.7f));
  EXPECT_EQ(picture(skin(0.99f * kQuarter)), matt);
  EXPECT_NE(picture(skin(1.01f * kQuarter)), matt);
}

} // namespace
} // namespace lancer_test
