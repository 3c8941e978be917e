// Guides for denoisers: from the first surface that is not mostly a mirror, as in Cycles before 5.2; or blended over all
// surfaces by their matt share, as in 5.2.
#include "picture_lab.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

const glm::vec3 kWall(0.8f, 0.4f, 0.2f), kMetal(0.9f, 0.6f, 0.3f), kSky(0.6f, 0.8f, 1.0f);

lancer_lobe colored(uint32_t kind, const glm::vec3 &color, float roughness = 0.3f) {
  lancer_lobe result = lobe(kind, 1.0f, roughness);
  result.color = constant(color.x, color.y, color.z);
  result.rules = LANCER_RULES_BLENDER_45;
  return result;
}

glm::vec3 albedo(const Studio &studio) { return studio.color(LANCER_PASS_ALBEDO); }
glm::vec3 normal(const Studio &studio) { return studio.color(LANCER_PASS_DENOISING_NORMAL); }
float depth(const Studio &studio) { return studio.number(LANCER_PASS_DENOISING_DEPTH); }

// Rooms are seen from (0, 0, 4) straight down. Small rotations of matrices cost a few units in the last place of float.
constexpr float kTurned = 1e-6f;

void look_down(Studio &studio) {
  studio.settings.max_bounces = 4;
  studio.sky(kSky.x, kSky.y, kSky.z);
  studio.look({0, 0, 4}, {0, 0, 0});
}

TEST(DenoisingGuides, OfADiffusePlane) {
  for (const bool behind : {false, true}) {
    Studio studio;
    look_down(studio);
    studio.place(LANCER_PLANE, studio.add({colored(LANCER_LAMBERT, kWall)}), turned(behind ? 210.0 : 30.0, 0, 1, 0));
    studio.render();
    expect_near(albedo(studio), kWall);
    // In camera space, whose z points into the picture: the visible side, whichever it is.
    expect_near(normal(studio), {0.5f, 0.0f, -std::sqrt(0.75f)}, kTurned);
    EXPECT_NEAR(depth(studio), 4.0f, kTurned);
  }
}

// A mirror at 45 degrees that shows a wall three units to the right.
std::unique_ptr<Studio> mirror_and_wall(const lancer_lobe &mirror, bool blended = false) {
  auto studio = std::make_unique<Studio>();
  look_down(*studio);
  studio->settings.blended_features = blended;
  studio->place(LANCER_PLANE, studio->add({mirror}), turned(45.0, 0, 1, 0));
  studio->place(LANCER_PLANE, studio->add({colored(LANCER_LAMBERT, kWall)}), moved(3, 0, 0) * turned(-90.0, 0, 1, 0));
  studio->render();
  return studio;
}

TEST(DenoisingGuides, OfWhatAMirrorShows) {
  for (const lancer_lobe &mirror : {colored(LANCER_MIRROR, kMetal), colored(LANCER_GLOSSY, kMetal, 0.0f)}) {
    const auto studio = mirror_and_wall(mirror);
    expect_near(albedo(*studio), kMetal * kWall, kTurned);
    // The wall's own normal, not the mirrored one.
    expect_near(normal(*studio), {-1, 0, 0}, kTurned);
    // The distance to the mirror, and from there times the reflected share, 0.6 in the mean.
    EXPECT_NEAR(depth(*studio), 4.0f + 0.6f * 3.0f, 4.0f * kTurned);
  }
}

float smooth_step(float x) { return x * x * (3.0f - 2.0f * x); }

TEST(DenoisingGuides, BlendedOverAMirrorAndWhatItShows) {
  const auto mirror = mirror_and_wall(colored(LANCER_MIRROR, kMetal), true);
  expect_near(albedo(*mirror), kMetal * kWall, kTurned);
  // Weighted by the reflected share, 0.6 in the mean.
  expect_near(normal(*mirror), {-0.6f, 0, 0}, kTurned);
  EXPECT_NEAR(depth(*mirror), 4.0f + 0.6f * 3.0f, 4.0f * kTurned);
  // A third of the transition to matt.
  const float matt = smooth_step(0.05f / 0.15f), here = smooth_step(2.0f * matt);
  const auto metal = mirror_and_wall(colored(LANCER_GLOSSY, kMetal, std::sqrt(0.05f)), true);
  // Self-shadowing of such a smooth metal at 45 degrees is below a thousandth; its lobe still hits the wall.
  expect_near(albedo(*metal), here * matt * kMetal + (1.0f - here) * (1.0f - matt) * kMetal * kWall, 1e-3f);
}

TEST(DenoisingGuides, BlendedSkyIsFarthest) {
  Studio studio;
  look_down(studio);
  studio.settings.blended_features = 1;
  studio.render();
  EXPECT_EQ(depth(studio), std::numeric_limits<float>::max());
  expect_near(albedo(studio), kSky);
}

TEST(DenoisingGuides, OfMetalByItsRoughness) {
  // alpha is the square of the socket: 0.075 is the upper end of mirrors.
  for (const float roughness : {std::sqrt(0.0745f), std::sqrt(0.0755f)}) {
    const bool mirror = roughness < std::sqrt(0.075f);
    const auto studio = mirror_and_wall(colored(LANCER_GLOSSY, kMetal, roughness));
    if (mirror) {
      EXPECT_GT(depth(*studio), 4.5f);
      continue;
    }
    EXPECT_NEAR(depth(*studio), 4.0f, kTurned);
    expect_near(normal(*studio), {std::sqrt(0.5f), 0.0f, -std::sqrt(0.5f)}, kTurned);
    // Self-shadowing of such a smooth metal at 45 degrees is below a thousandth.
    expect_near(albedo(*studio), kMetal, 1e-3f);
  }
}

TEST(DenoisingGuides, OfAMirrorAndPaint) {
  // The limit is a mirror share of three quarters.
  for (const float share : {0.76f, 0.74f}) {
    Studio studio;
    look_down(studio);
    lancer_lobe mirror = colored(LANCER_MIRROR, glm::vec3(1.0f)), paint = colored(LANCER_LAMBERT, glm::vec3(1.0f));
    mirror.weight = constant(share);
    paint.weight = constant(1.0f - share);
    studio.sky(0, 0, 0);
    studio.place(LANCER_PLANE, studio.add({mirror, paint}));
    studio.render();
    const bool through = share > 0.75f;
    expect_near(albedo(studio), through ? glm::vec3(0.0f) : glm::vec3(1.0f - share));
    expect_near(normal(studio), through ? glm::vec3(0.0f) : glm::vec3(0, 0, -1));
    EXPECT_FLOAT_EQ(depth(studio), 4.0f);
  }
}

TEST(DenoisingGuides, OfTheSky) {
  Studio empty;
  look_down(empty);
  empty.render();
  expect_near(albedo(empty), kSky);
  EXPECT_EQ(normal(empty), glm::vec3(0.0f));
  EXPECT_EQ(depth(empty), 0.0f);
  // In a mirror the reflected share counts twice: in the guide, and in the light that arrives.
  Studio studio;
  look_down(studio);
  studio.place(LANCER_PLANE, studio.add({colored(LANCER_MIRROR, kMetal)}));
  studio.render();
  expect_near(albedo(studio), kMetal * kMetal * kSky);
  EXPECT_EQ(normal(studio), glm::vec3(0.0f));
  EXPECT_FLOAT_EQ(depth(studio), 4.0f);
}

TEST(DenoisingGuides, OfTheSkyBehindATransparentFilm) {
  for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC})
    for (const bool with_environment : {false, true}) {
      Studio studio;
      look_down(studio);
      studio.settings.integrator = integrator;
      studio.settings.film_transparent = 1;
      studio.settings.passes &= ~(1u << LANCER_PASS_ENVIRONMENT);
      if (with_environment)
        studio.settings.passes |= 1u << LANCER_PASS_ENVIRONMENT;
      studio.render();
      expect_near(albedo(studio), glm::vec3(0.0f));
    }
}

TEST(DenoisingGuides, OfALamp) {
  Studio studio;
  look_down(studio);
  lancer_material lamp = black();
  lamp.emission = constant(1.5f, 0.75f, 0.375f);
  studio.place(LANCER_PLANE, studio.add({}, lamp));
  studio.render();
  expect_near(albedo(studio), {1.5f, 0.75f, 0.375f});
  EXPECT_EQ(normal(studio), glm::vec3(0.0f));
  EXPECT_FLOAT_EQ(depth(studio), 4.0f);
}

TEST(DenoisingGuides, OfWhatAPaneLetsPass) {
  Studio studio;
  look_down(studio);
  lancer_material pane = black();
  pane.transmittance = constant(0.5f, 0.25f, 0.75f);
  studio.place(LANCER_PLANE, studio.add({}, pane), moved(0, 0, 1));
  studio.place(LANCER_PLANE, studio.add({colored(LANCER_LAMBERT, kWall)}));
  studio.render();
  expect_near(albedo(studio), glm::vec3(0.5f, 0.25f, 0.75f) * kWall);
  expect_near(normal(studio), {0, 0, -1});
  EXPECT_FLOAT_EQ(depth(studio), 3.0f + 0.5f * 1.0f);
}

TEST(DenoisingGuides, DepthBeginsWhereTheCameraDoes) {
  Studio studio;
  look_down(studio);
  studio.camera.clip_start = 0.5;
  studio.place(LANCER_PLANE, studio.add({colored(LANCER_LAMBERT, kWall)}));
  studio.render();
  EXPECT_FLOAT_EQ(depth(studio), 3.5f);
  EXPECT_FLOAT_EQ(studio.number(LANCER_PASS_DEPTH), 4.0f);
}

} // namespace
} // namespace lancer_test
