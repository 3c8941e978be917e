// Vertices are shaded in lanes if only the picture is requested, one by one if more is: the pictures are equal, bit for bit.
#include "random_scenes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

// Nodes of one lobe each, mixed; some are left to the general code.
std::vector<lancer_lobe> mixture(Random &random) {
  std::vector<lancer_lobe> lobes(1 + random() % 4);
  for (lancer_lobe &one : lobes) {
    const uint32_t kinds[] = {LANCER_DIFFUSE, LANCER_GLOSSY, LANCER_GLASS, LANCER_CONDUCTOR};
    one = lobe(kinds[random() % 4], 0.0f, random() % 4 ? number(random, 0.02f, 1.0f) : 0.0f);
    if (one.kind == LANCER_DIFFUSE)
      one.roughness = constant(random() % 6 ? 0.0f : 0.5f);
    const uint32_t distributions[] = {LANCER_DISTRIBUTION_GGX, LANCER_DISTRIBUTION_MULTI_GGX, LANCER_DISTRIBUTION_MULTI_GGX,
                                      LANCER_DISTRIBUTION_BECKMANN};
    one.distribution = distributions[random() % 8 ? random() % 3 : 3];
    one.rules = random() % 2 ? LANCER_RULES_BLENDER_4 : LANCER_RULES_BLENDER_45;
    one.color = random() % 8 ? color(random) : constant(0.0f);
    one.edge = color(random);
    one.ior = constant(random() % 2 ? number(random, 1.0f, 2.5f) : random() % 2 ? 1.0f : 0.7f);
    one.anisotropy = constant(random() % 12 ? 0.0f : 0.4f);
    const float weight = number(random, 0.1f, 1.0f) / float(lobes.size());
    one.weight = constant(weight, 0.7f * weight, weight);
  }
  return lobes;
}

uint32_t add_some_material(Studio &studio, Random &random, bool may_shine) {
  lancer_material material = black();
  // The object position as a colour.
  std::vector<lancer_node> nodes;
  const bool by_nodes = random() % 2;
  if (by_nodes)
    nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED)};
  if (random() % 6 == 0 && may_shine)
    material.emission = by_nodes ? result_of(0) : constant(0.5f);
  if (random() % 4 == 0)
    material.transmittance = by_nodes && random() % 2 ? result_of(0) : constant(0.3f, 0.2f, 0.5f);
  if (random() % 4 == 0) {
    lancer_lobe matte = lobe(LANCER_DIFFUSE, number(random), random() % 2 ? 0.0f : 0.7f);
    if (by_nodes)
      matte.color = result_of(0);
    return studio.add({matte}, material, nodes);
  }
  if (random() % 3 == 0)
    return studio.add(mixture(random), material, nodes);
  lancer_principled p = principled(random);
  if (by_nodes)
    p.base_color = result_of(0);
  lancer_lobe layered = lobe(LANCER_PRINCIPLED, 1.0f);
  if (by_nodes && random() % 2)
    layered.weight = result_of(0);
  layered.principled = &p;
  return studio.add({layered}, material, nodes);
}

// few: lamps with a position only, which are chosen in lanes.
void add_lights(Studio &studio, Random &random, bool few) {
  lancer_light lamp = point_light();
  lamp.radius = 0.5f;
  studio.add(lamp);
  lamp.soft_falloff = 0;
  lamp.hidden_from = random() % 2 ? LANCER_RAY_DIFFUSE : LANCER_RAY_GLOSSY;
  place(lamp.matrix, -3.0, 1.0, 2.5);
  studio.add(lamp);
  lamp.radius = 0.0f;
  studio.add(lamp);
  lamp.hidden_from = random() % 2 ? uint32_t(LANCER_RAY_TRANSMISSION) : 0u;
  lamp.kind = LANCER_SPOT;
  lamp.radius = 0.3f;
  lamp.spot_angle = 1.5f;
  lamp.spot_blend = 0.4f;
  place(lamp.matrix, 2.0, 2.0, 4.0);
  lamp.no_shadow = random() % 2;
  studio.add(lamp);
  lamp = studio.sun({0.5, -0.3, 1.0}, 0.7f);
  lamp.sun_angle = random() % 2 ? 0.3f : 0.0f;
  if (!few)
    studio.add(lamp);
  lamp = studio.sun({-0.5, 0.3, 1.0}, 8.0f);
  lamp.kind = LANCER_AREA;
  lamp.size[0] = 2.0f;
  lamp.size[1] = 1.0f;
  lamp.spread = random() % 2 ? float(std::numbers::pi) : 1.0f;
  lamp.shape = random() % 2 ? LANCER_RECTANGLE : LANCER_ELLIPSE;
  lamp.hidden_from = random() % 2 ? 0u : uint32_t(LANCER_RAY_GLOSSY);
  lamp.matrix[3] = -2.0;
  lamp.matrix[7] = 2.0;
  lamp.matrix[11] = 5.0;
  studio.add(lamp);
}

// So many that the light tree has several levels.
void add_crowd(Studio &studio, Random &random) {
  for (int i = 0; i < 60; ++i) {
    lancer_light lamp = point_light();
    lamp.radius = i % 3 ? 0.1f : 0.0f;
    std::fill(lamp.emission, lamp.emission + 3, 0.05f * float(1 + i % 7));
    place(lamp.matrix, double(number(random, -4.0f, 4.0f)), double(number(random, -4.0f, 4.0f)),
          double(number(random, 1.0f, 3.0f)));
    studio.add(lamp);
  }
}

std::vector<float> picture(uint32_t seed, uint32_t passes) {
  Random random(seed);
  Studio studio;
  studio.settings.passes = passes;
  studio.settings.samples = 4;
  studio.settings.max_bounces = 6;
  studio.settings.clamp_indirect = seed % 3 ? 0.0f : 0.5f;
  studio.settings.seed = seed;
  studio.settings.threads = 2;
  // The film may show things through glass.
  studio.settings.film_transparent = studio.settings.transparent_glass = seed % 5 == 0;
  studio.settings.glass_roughness = 0.5f;
  const bool few = seed % 4 == 2;
  const Ball ball;
  studio.add(ball.mesh(true));
  studio.add(ball.mesh(false));
  place_balls(studio, random, 2, [&] { return add_some_material(studio, random, !few); });
  add_lights(studio, random, few);
  if (seed % 3 == 0)
    add_crowd(studio, random);
  studio.sky(0.1f, 0.2f, 0.3f, 0, seed % 2);
  studio.look({2, -9, 6}, {0, 0, -0.5}, 48, 9.0);
  studio.render();
  return studio.read(LANCER_PASS_COMBINED, 4);
}

TEST(Lanes, ThePictureIsTheSameOneByOne) { expect_the_same_one_by_one(40, 0.01, picture); }

} // namespace
} // namespace lancer_test
