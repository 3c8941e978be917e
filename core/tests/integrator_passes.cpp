// Light passes of pictures: closed forms of small scenes.
#include "picture_lab.h"
#include "roundings.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

// Without metal, glass, sheen, coat and emission.
lancer_principled plain_principled() {
  lancer_principled p = {};
  p.rules = LANCER_RULES_BLENDER_45;
  for (lancer_parameter *input : {&p.metallic,
                                  &p.diffuse_roughness,
                                  &p.specular,
                                  &p.anisotropic,
                                  &p.anisotropic_rotation,
                                  &p.transmission,
                                  &p.transmission_roughness,
                                  &p.coat,
                                  &p.coat_roughness,
                                  &p.coat_normal,
                                  &p.sheen,
                                  &p.emission,
                                  &p.film_thickness,
                                  &p.thin_wall,
                                  &p.wall_scattering,
                                  &p.wall_forward,
                                  &p.subsurface,
                                  &p.subsurface_radius,
                                  &p.subsurface_color,
                                  &p.subsurface_ior,
                                  &p.subsurface_anisotropy})
    *input = constant(0.0f);
  p.base_color = p.sheen_tint = p.coat_tint = p.specular_tint = constant(0.8f);
  p.roughness = p.sheen_roughness = constant(0.5f);
  p.ior = p.coat_ior = p.film_ior = constant(1.5f);
  return p;
}

// At most three scattering events of three factors each, of light up to 1/2; three sums up to 2; the division and the product
// by the pass's colour: 12 roundings of 1.
constexpr float kLight = float_roundings(12);

// Expects only the light of these passes and of environment and emission in the picture.
void expect_light(const Studio &studio, float emission, float environment, const glm::vec3 &direct, const glm::vec3 &indirect,
                  float tolerance = kLight) {
  EXPECT_NEAR(studio.color(LANCER_PASS_EMISSION).x, emission, tolerance);
  EXPECT_NEAR(studio.color(LANCER_PASS_ENVIRONMENT).x, environment, tolerance);
  float sum = emission + environment;
  for (int component = 0; component < 3; ++component) {
    const uint32_t first = LANCER_PASS_DIFFUSE_DIRECT + 3 * uint32_t(component);
    const float color = studio.color(first + 2).x;
    EXPECT_NEAR(color * studio.color(first).x, direct[component], tolerance) << component;
    EXPECT_NEAR(color * studio.color(first + 1).x, indirect[component], tolerance) << component;
    sum += direct[component] + indirect[component];
  }
  EXPECT_NEAR(studio.color().x, sum, tolerance);
}

// Inside a ball that emits and has albedo 1/2.
std::unique_ptr<Studio> furnace(float clamp, bool sampled) {
  auto studio = std::make_unique<Studio>();
  // A single sample is exact as long as no path is random.
  studio->settings.max_bounces = sampled ? 2 : 1;
  studio->settings.clamp_indirect = clamp;
  studio->settings.samples = sampled ? 1u << 14 : 1;
  studio->place(LANCER_SPHERE,
                studio->add({lobe(LANCER_LAMBERT, 0.5f)}, glow(1.0f, sampled ? 0 : LANCER_MATERIAL_NOT_A_LIGHT)));
  studio->look({0, 0, 0.5}, {0, 0, 0});
  studio->render();
  return studio;
}

TEST(Passes, OfAFurnace) {
  // Emission, after one scattering event and after two.
  expect_light(*furnace(0.0f, false), 1.0f, 0.0f, {0.5f, 0, 0}, {0.25f, 0, 0});
  // Clamping removes indirect light only, and removes it from its pass.
  expect_light(*furnace(0.1f, false), 1.0f, 0.0f, {0.5f, 0, 0}, {0.1f, 0, 0});
  // Sampled as a light, with one more bounce, it is the same except for noise: a sample's standard deviation is below its mean,
  // 4 / 128 of 0.5.
  expect_light(*furnace(0.0f, true), 1.0f, 0.0f, {0.5f, 0, 0}, {0.25f + 0.125f, 0, 0}, 0.02f);
}

TEST(Passes, OfWhatAMirrorShows) {
  // Light from a wall of albedo 1/2 under a sun, by a mirror of 0.8, belongs to the mirror's component, not to the wall's.
  Studio studio;
  studio.settings.max_bounces = 1;
  studio.place(LANCER_PLANE, studio.add({newest(LANCER_MIRROR, 0.8f)}), turned(45.0, 0, 1, 0));
  studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 0.5f)}), moved(3, 0, 0) * turned(-90.0, 0, 1, 0));
  studio.add(studio.sun({-1, 0, 3}, std::numbers::pi_v<float>));
  studio.look({0, 0, 1}, {0, 0, 0});
  studio.render();
  expect_light(studio, 0.0f, 0.0f, {0, 0, 0}, {0, 0.8f * 0.5f / std::sqrt(10.0f), 0});
}

TEST(Passes, OfTheSky) {
  Studio seen;
  seen.sky(0.5f, 0.5f, 0.5f);
  seen.render();
  expect_light(seen, 0.0f, 0.5f, {0, 0, 0}, {0, 0, 0});
  // Through a pane it is still emission; scattered it is direct light of the scattering component.
  Studio through;
  through.sky(0.5f, 0.5f, 0.5f);
  through.place(LANCER_PLANE, through.add({}, pane(0.25f)));
  through.render();
  expect_light(through, 0.0f, 0.125f, {0, 0, 0}, {0, 0, 0});
  const std::pair<lancer_lobe, glm::vec3> senders[] = {{lobe(LANCER_LAMBERT, 0.8f), {0.4f, 0, 0}},
                                                       {newest(LANCER_MIRROR, 0.8f), {0, 0.4f, 0}},
                                                       {newest(LANCER_REFRACTION, 0.8f, 0.0f), {0, 0, 0.4f}}};
  for (const auto &[sender, direct] : senders) {
    Studio studio;
    studio.sky(0.5f, 0.5f, 0.5f);
    studio.place(LANCER_PLANE, studio.add({sender}));
    studio.render();
    expect_light(studio, 0.0f, 0.0f, direct, {0, 0, 0});
  }
}

// A pane of transmittance 1/2 at height 2 over a white floor, seen from 10, with mist from 6 that is complete 8 farther.
std::unique_ptr<Studio> pane_over_floor(float mist_depth = 8.0f) {
  auto studio = std::make_unique<Studio>();
  studio->settings.mist_start = 6.0f;
  studio->settings.mist_depth = mist_depth;
  studio->settings.mist_falloff = 1.0f;
  studio->place(LANCER_PLANE, studio->add({}, pane(0.5f)), moved(0, 0, 2));
  studio->place(LANCER_PLANE, studio->add({lobe(LANCER_LAMBERT, 0.8f)}));
  studio->look({0, 0, 10}, {0, 0, 0});
  studio->render();
  return studio;
}

TEST(Passes, CountWhatAPaneLeaves) {
  const auto studio = pane_over_floor();
  EXPECT_FLOAT_EQ(studio->color(LANCER_PASS_DIFFUSE_COLOR).x, 0.4f);
  // 2/8 and 4/8 of mist, half each: the mean of three equal numbers is a sum and a product, the rest is halves.
  EXPECT_NEAR(studio->number(LANCER_PASS_MIST), 0.375f, float_roundings(4));
  EXPECT_EQ(pane_over_floor(0.0f)->number(LANCER_PASS_MIST), 0.0f);
  // Occlusion: nothing is above the pane; the floor is seen through the pane and sees through it. Halves are exact.
  EXPECT_EQ(studio->color(LANCER_PASS_AMBIENT_OCCLUSION).x, 0.5f + 0.5f * 0.5f);
}

TEST(Passes, OcclusionIsOfWhatTheCameraSees) {
  // A lid at height 10 occludes within a distance of a million, or any distance if the setting is 0.
  for (const float distance : {5.0f, 1e6f, 0.0f}) {
    Studio studio;
    studio.settings.max_bounces = 2;
    studio.settings.occlusion_distance = distance;
    // The mirror's own occlusion, and not that of the lid in it.
    studio.place(LANCER_PLANE, studio.add({newest(LANCER_MIRROR, 1.0f)}));
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}), moved(0, 0, 10));
    studio.look({0, 0, 1}, {0, 0, 0});
    studio.render();
    EXPECT_EQ(studio.color(LANCER_PASS_AMBIENT_OCCLUSION).x, distance == 5.0f ? 1.0f : 0.0f);
  }
}

TEST(Passes, NormalsAreWeightedByColor) {
  Studio studio;
  lancer_lobe red = newest(LANCER_LAMBERT, 0.3f), blue = newest(LANCER_LAMBERT, 0.6f);
  red.normal = constant(0.6f, 0.0f, 0.8f);
  blue.normal = constant(0.0f, 0.0f, 1.0f);
  studio.place(LANCER_PLANE, studio.add({red, blue}));
  studio.render();
  expect_near(studio.color(LANCER_PASS_NORMAL), glm::normalize(glm::vec3(0.6f, 0.0f, 0.8f + 2.0f)));
}

TEST(Passes, ALampUnderACoatIsSampledAsItShines) {
  // The emission of a layered material lights a floor equally whether it is sampled or found by scattered rays.
  const auto level = [](uint32_t flags) {
    Studio studio;
    lancer_principled principled = plain_principled();
    principled.emission = constant(4.0f);
    principled.coat = constant(1.0f);
    principled.coat_tint = constant(0.25f);
    lancer_lobe layered = newest(LANCER_PRINCIPLED, 1.0f);
    layered.principled = &principled;
    studio.settings.samples = 1u << 14;
    studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
    studio.place(LANCER_SPHERE, studio.add({layered}, glow(0.0f, flags)), moved(0, 0, 1.5));
    studio.look({2, 0, 1}, {0, 0, 0});
    studio.render();
    return studio.color().x;
  };
  // Scattered rays find the ball with half of the samples: their standard deviation is the mean, 4 / 128 of it.
  EXPECT_NEAR(level(0) / level(LANCER_MATERIAL_NOT_A_LIGHT), 1.0, 4.0 / 128.0);
}

TEST(Kernels, HaveTheLayersThatAPrincipledHas) {
  // A specialised kernel omits impossible cases; the picture equals that of the general one.
  const auto picture = [](float diffuse_roughness, float sheen, uint32_t features) {
    Studio studio;
    lancer_principled principled = plain_principled();
    principled.diffuse_roughness = constant(diffuse_roughness);
    principled.sheen = constant(sheen);
    lancer_lobe layered = newest(LANCER_PRINCIPLED, 1.0f);
    layered.principled = &principled;
    studio.settings.features = features;
    studio.settings.samples = 64;
    studio.settings.max_bounces = 2;
    studio.sky(0.5f, 0.7f, 0.9f);
    studio.place(LANCER_SPHERE, studio.add({layered}));
    studio.add(studio.sun({1, 1, 2}));
    studio.look({0, 0, 3}, {0, 0, 0}, 8, 2.0);
    studio.render();
    return studio.read(LANCER_PASS_COMBINED, 4);
  };
  for (const float diffuse_roughness : {0.0f, 0.5f})
    for (const float sheen : {0.0f, 0.5f})
      EXPECT_EQ(picture(diffuse_roughness, sheen, LANCER_FEATURES_SCENE),
                picture(diffuse_roughness, sheen, LANCER_FEATURES_ALL));
}

} // namespace
} // namespace lancer_test
