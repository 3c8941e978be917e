// CLASSIC shades surfaces in lanes, with all shapes, shadings and materials: other requested outputs change no bit of the
// picture.
#include "random_scenes.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// Kd, Ks, both, with a mirror, glass or several of them; sometimes with Ka, emission or holes.
uint32_t add_some_material(Studio &studio, Random &random) {
  std::vector<lancer_lobe> lobes;
  const uint32_t kind = random() % 8;
  if (kind != 0)
    lobes.push_back(lobe(LANCER_LAMBERT, number(random)));
  if (kind != 1)
    lobes.push_back(lobe(LANCER_BECKMANN, number(random), random() % 6 ? number(random, 0.02f, 1.0f) : 0.0f));
  for (lancer_lobe &one : lobes) {
    one.color = color(random);
    one.ior = constant(random() % 4   ? number(random, 0.6f, 2.5f)
                       : random() % 2 ? 1.0f
                                      : std::numeric_limits<float>::infinity());
  }
  if (random() % 4 == 0)
    std::reverse(lobes.begin(), lobes.end());
  if (kind == 2)
    lobes.push_back(lobe(random() % 2 ? LANCER_MIRROR : LANCER_DIELECTRIC, 0.7f));
  if (kind == 3)
    lobes.push_back(lobe(random() % 2 ? LANCER_LAMBERT : LANCER_BECKMANN, 0.2f));
  lancer_material material = black();
  if (random() % 3 == 0)
    material.ambient = color(random);
  if (random() % 6 == 0)
    material.emission = constant(0.1f);
  if (random() % 8 == 0)
    material.transmittance = constant(0.3f, 0.2f, 0.5f);
  return studio.add(lobes, material);
}

lancer_light colored(lancer_light lamp, Random &random) {
  for (int i = 0; i < 3; ++i) {
    lamp.ambient_color[i] = random() % 4 ? 1.0f : number(random);
    lamp.diffuse_color[i] = random() % 4 ? 1.0f : number(random);
    lamp.specular_color[i] = random() % 4 ? 1.0f : number(random);
  }
  lamp.hidden_from = random() % 4 ? 0u : random() % 2 ? uint32_t(LANCER_RAY_DIFFUSE) : uint32_t(LANCER_RAY_GLOSSY);
  lamp.no_shadow = random() % 6 == 0;
  return lamp;
}

void add_lights(Studio &studio, Random &random) {
  for (uint32_t i = 0; i < 4; ++i) {
    lancer_light lamp = colored(point_light(), random);
    lamp.radius = i == 3 ? 0.5f : 0.0f;
    lamp.falloff = random() % 3 ? 0 : random() % 6;
    lamp.falloff_radius = 9.0f;
    place(lamp.matrix, number(random, -4.0f, 4.0f), number(random, -4.0f, 4.0f), number(random, 1.0f, 5.0f));
    studio.add(lamp);
  }
  lancer_light spot = colored(point_light(), random);
  spot.kind = LANCER_SPOT;
  spot.radius = 0.0f;
  spot.spot_angle = 1.5f;
  spot.spot_blend = 0.4f;
  place(spot.matrix, 2.0, 2.0, 4.0);
  studio.add(spot);
  lancer_light sun = colored(studio.sun({0.5, -0.3, 1.0}, 0.7f), random);
  sun.sun_angle = random() % 2 ? 0.3f : 0.0f;
  studio.add(sun);
}

// Adds the passes of the first surface.
void add_first_surface(const Studio &studio, std::vector<float> &values) {
  for (const uint32_t pass : {LANCER_PASS_NORMAL, LANCER_PASS_UV})
    for (const float x : studio.read(pass, 3))
      values.push_back(x);
}

std::vector<float> picture(uint32_t seed, uint32_t passes) {
  Random random(seed);
  Studio studio;
  studio.settings.integrator = LANCER_CLASSIC;
  studio.settings.passes = passes;
  studio.settings.samples = seed % 4 ? 2 : 1;
  studio.settings.max_bounces = 4;
  studio.settings.contribution_threshold = seed % 2 ? 0.01f : 0.0f;
  studio.settings.seed = seed;
  studio.settings.threads = 2;
  const Ball ball;
  // Its triangles are halves of quadrilaterals, or polygons of their own.
  std::vector<uint32_t> halves(ball.triangles.size() / 3);
  for (uint32_t i = 0; i < halves.size(); ++i)
    halves[i] = i / 2;
  lancer_mesh smooth = ball.mesh(true);
  smooth.polygons = seed % 5 ? halves.data() : nullptr;
  studio.add(smooth);
  studio.add(ball.mesh(false));
  studio.place(LANCER_PLANE, add_some_material(studio, random), moved(0, 0, -1));
  for (int i = 0; i < 12; ++i) {
    constexpr uint32_t kinds[] = {LANCER_MESH, LANCER_SPHERE, LANCER_SPHERE, LANCER_CYLINDER, LANCER_CONE, LANCER_MESH};
    const glm::dmat4 stretched = glm::scale(turned(number(random, 0.0f, 90.0f), 1, 1, 0), glm::dvec3(1.0, 0.7, 1.3));
    lancer_instance &thing = studio.place(kinds[random() % 6], add_some_material(studio, random),
                                          moved(2.2 * (i % 4) - 3.3, 2.2 * (i / 4) - 2.2, number(random, -0.5f, 0.5f)) *
                                              (random() % 2 ? stretched : glm::dmat4(1.0)));
    thing.mesh = random() % 2;
    thing.shading = random() % 4;
    thing.terminator = random() % 2 ? 0.2f : 0.0f;
    thing.flags = random() % 12 ? 0u : uint32_t(LANCER_INSTANCE_HOLDOUT);
  }
  add_lights(studio, random);
  studio.sky(0.1f, 0.2f, 0.3f, 0, seed % 3 == 0);
  studio.look({2, -9, 6}, {0, 0, -0.5}, 48, 9.0);
  studio.render();
  std::vector<float> values = studio.read(LANCER_PASS_COMBINED, 4);
  if (passes & 1u << LANCER_PASS_NORMAL)
    add_first_surface(studio, values);
  return values;
}

TEST(ClassicLanes, ThePictureIsTheSameWithMist) {
  constexpr uint32_t shown = 1u << LANCER_PASS_COMBINED | 1u << LANCER_PASS_NORMAL | 1u << LANCER_PASS_UV;
  for (uint32_t seed = 1; seed <= 24; ++seed)
    EXPECT_EQ(picture(seed, shown), picture(seed, shown | 1u << LANCER_PASS_MIST)) << "seed " << seed;
}

TEST(ClassicLanes, ThePictureAloneIsTheSameWithMist) {
  constexpr uint32_t alone = 1u << LANCER_PASS_COMBINED;
  for (uint32_t seed = 1; seed <= 24; ++seed)
    EXPECT_EQ(picture(seed, alone), picture(seed, alone | 1u << LANCER_PASS_MIST)) << "seed " << seed;
}

} // namespace
} // namespace lancer_test
