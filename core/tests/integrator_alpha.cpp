// Holdouts and transparent film: closed forms of small scenes.
#include "picture_lab.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

TEST(Holdout, OfAnObject) {
  for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC}) {
    const auto studio = [&](bool hole, float veil, float clear, bool mirrored) {
      auto result = std::make_unique<Studio>();
      result->settings.integrator = integrator;
      result->settings.max_bounces = 1;
      result->sky(0.5f, 0.5f, 0.5f);
      // The object emits and is white; another emitting object is below it.
      lancer_material thing = glow(1.0f);
      thing.transmittance = constant(clear);
      lancer_instance &instance =
          result->place(LANCER_PLANE, result->add({lobe(LANCER_LAMBERT, 1.0f)}, thing), moved(0, 0, mirrored ? 2 : 0));
      instance.flags = hole ? LANCER_INSTANCE_HOLDOUT : 0;
      if (mirrored)
        result->place(LANCER_PLANE, result->add({newest(LANCER_MIRROR, 1.0f)}));
      else
        result->place(LANCER_PLANE, result->add({}, glow(8.0f)), moved(0, 0, -1));
      if (veil < 1.0f)
        result->place(LANCER_PLANE, result->add({}, pane(veil)), moved(0, 0, 0.5));
      result->render();
      return result;
    };
    const auto solid = studio(true, 1.0f, 0.0f, false), veiled = studio(true, 0.25f, 0.0f, false);
    EXPECT_EQ(solid->alpha(), 0.0f);
    EXPECT_EQ(solid->color().x, 0.0f);
    EXPECT_EQ(veiled->alpha(), 0.75f);
    EXPECT_EQ(veiled->color().x, 0.0f);
    // Transmitted light is visible, and opaque.
    const auto clear = studio(true, 1.0f, 0.25f, false);
    EXPECT_EQ(clear->alpha(), 0.25f);
    EXPECT_EQ(clear->color().x, 2.0f);
    EXPECT_EQ(studio(false, 1.0f, 0.0f, false)->alpha(), 1.0f);
    // A mirror shows it like any other object.
    const auto mirrored = studio(true, 1.0f, 0.0f, true);
    EXPECT_EQ(mirrored->alpha(), 1.0f);
    EXPECT_GE(mirrored->color().x, 1.0f);
  }
}

TEST(Holdout, OfAMaterial) {
  for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC})
    for (const float veil : {1.0f, 0.5f})
      for (const float share : {0.25f, 1.0f}) {
        Studio studio;
        studio.settings.integrator = integrator;
        lancer_material thing = glow(1.0f - share);
        thing.holdout = constant(share);
        studio.place(LANCER_PLANE, studio.add({}, thing));
        if (veil < 1.0f)
          studio.place(LANCER_PLANE, studio.add({}, pane(veil)), moved(0, 0, 0.5));
        studio.render();
        EXPECT_FLOAT_EQ(studio.alpha(), 1.0f - veil * share);
        EXPECT_FLOAT_EQ(studio.color().x, veil * (1.0f - share));
      }
}

TEST(Film, TransparentWhereTheSkyIsSeen) {
  const auto studio = [](uint32_t integrator, std::vector<lancer_lobe> lobes, float transmittance, bool glass,
                         float roughness) {
    auto result = std::make_unique<Studio>();
    result->settings.integrator = integrator;
    result->settings.max_bounces = 1;
    result->settings.film_transparent = 1;
    result->settings.transparent_glass = glass;
    result->settings.glass_roughness = roughness;
    result->sky(0.5f, 0.5f, 0.5f);
    result->place(LANCER_PLANE, result->add(std::move(lobes), pane(transmittance)));
    result->render();
    return std::pair(result->alpha(), result->color().x);
  };
  for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC}) {
    EXPECT_EQ(studio(integrator, {}, 0.75f, false, 0.0f), std::pair(0.25f, 0.0f));
    // In a mirror the sky is ordinary light.
    EXPECT_EQ(studio(integrator, {newest(LANCER_MIRROR, 1.0f)}, 0.0f, true, 1.0f), std::pair(1.0f, 0.5f));
  }
  // Glass up to a roughness counts as transparent, if the setting is on.
  const auto glass = [&](float roughness, bool asked, float limit) {
    return studio(LANCER_PATH, {newest(LANCER_REFRACTION, 1.0f, roughness)}, 0.0f, asked, limit);
  };
  EXPECT_EQ(glass(0.0f, false, 1.0f), std::pair(1.0f, 0.5f));
  EXPECT_EQ(glass(0.0f, true, 0.0f), std::pair(0.0f, 0.0f));
  // alpha is the square of the lobe's roughness.
  EXPECT_EQ(glass(0.5f, true, 0.24f).first, 1.0f);
  EXPECT_LT(glass(0.5f, true, 0.26f).first, 0.1f);
}

TEST(Film, SolidBlackBesideAPanorama) {
  for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC, LANCER_NORMALS})
    for (const uint32_t transparent : {0u, 1u}) {
      Studio studio;
      studio.settings.integrator = integrator;
      studio.settings.film_transparent = transparent;
      studio.sky(1, 1, 1);
      studio.look({0, 0, 1}, {0, 0, 0}, 2);
      studio.camera.kind = LANCER_FISHEYE_EQUIDISTANT;
      studio.camera.panorama[0] = 0.1;
      // Four pixels outside the circle.
      const double window[4] = {-1, 2, -1, 2};
      std::copy(window, window + 4, studio.camera.window);
      studio.render();
      EXPECT_EQ(studio.color(), glm::vec3(0.0f));
      EXPECT_EQ(studio.alpha(), 1.0f);
    }
}

} // namespace
} // namespace lancer_test
