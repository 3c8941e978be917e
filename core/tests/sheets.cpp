// Principled with thin walls: sheets of glass and of dense matter.
#include <cmath>
#include <gtest/gtest.h>

#include "principled_lab.h"

namespace lancer {
namespace {

using namespace testing;

PrincipledInputs<float> sheet(float roughness) {
  PrincipledInputs<float> in = plain(Rules::Blender52);
  in.base_color = glm::vec3(1.0f);
  in.roughness = roughness;
  in.transmission = in.thin_wall = 1.0f;
  return in;
}

// The series of reflections between the sides of clear glass: 2 r / (1 + r) are returned, and the rest passes.
TEST(Sheets, ClearGlassReturnsTheSeriesOfReflections) {
  for (const float roughness : {0.0f, 0.5f})
    for (const double cosine : {1.0, 0.6, 0.1}) {
      const glm::vec3 wo = direction(cosine);
      Bsdf<float> bsdf;
      look(bsdf, sheet(roughness), wo);
      const float r = fresnel_dielectric(wo.z, 1.5f), returned = 2.0f * r / (1.0f + r);
      ASSERT_EQ(bsdf.count, 2);
      // Lobes of several bounces return what facets lose.
      expect_near(bsdf.lobes[0].color, glm::vec3(returned), 4.0f * kRounding, "returned");
      expect_near(bsdf.lobes[1].color, glm::vec3(1.0f - returned), 4.0f * kRounding, "through");
      expect_near(bsdf.shown(Component::Glossy), glm::vec3(returned), 4.0f * kRounding, "glossy");
      expect_near(bsdf.shown(Component::Transmission), glm::vec3(1.0f - returned), 4.0f * kRounding, "transmission");
    }
}

// By quadrature: the lobes send back what their closed forms say.
TEST(Sheets, LobesScatterTheirShares) {
  for (const double cosine : {1.0, 0.5, 0.1}) {
    const glm::vec3 wo = direction(cosine);
    Bsdf<float> bsdf;
    look(bsdf, sheet(0.7f), wo);
    double sides[2] = {0.0, 0.0};
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        for (const bool beyond : {false, true}) {
          const double z = (i + 0.5) / kSteps, phi = 2.0 * std::numbers::pi * (j + 0.5) / kSteps;
          sides[beyond] +=
              double{bsdf.eval(direction(beyond ? -z : z, phi)).f().x} * 2.0 * std::numbers::pi / (kSteps * kSteps);
        }
    // The table of the light that facets lose has an error of up to 1 %.
    const double r = double{fresnel_dielectric(wo.z, 1.5f)}, returned = 2.0 * r / (1.0 + r);
    EXPECT_NEAR(sides[0], returned, 0.01 * returned + 1e-3) << cosine;
    EXPECT_NEAR(sides[1], 1.0 - returned, 0.01) << cosine;
  }
}

// Beer's law: along the normal the tint is the transmittance, and on a slanted way its power.
TEST(Sheets, TintIsOfTheWayThroughTheGlass) {
  PrincipledInputs<float> in = sheet(0.0f);
  in.ior = 1.0f + 1e-4f; // reflects almost nothing
  in.base_color = {0.8f, 0.5f, 0.2f};
  for (const double cosine : {1.0, 0.5}) {
    Bsdf<float> bsdf;
    look(bsdf, in, direction(cosine));
    const auto expected = [&](float tint) { return float(std::pow(double{tint}, 1.0 / cosine)); };
    expect_near(bsdf.shown(Component::Transmission), {expected(0.8f), expected(0.5f), expected(0.2f)}, 1e-3f, "tint");
  }
}

TEST(Sheets, SmoothGlassLetsRaysPassStraight) {
  const glm::vec3 wo = direction(0.6);
  Bsdf<float> bsdf;
  look(bsdf, sheet(0.0f), wo);
  for (const float u : {0.001f, 0.5f, 0.99f}) {
    const BsdfSample<float> sample = bsdf.sample(u, 0.3f, 0.7f);
    EXPECT_TRUE(sample.delta);
    const glm::vec3 expected = sample.transmitted ? -wo : glm::vec3(-wo.x, -wo.y, wo.z);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(sample.wi[i], expected[i], 1e-6f);
  }
  // To other rays than the camera's the light that passes is no lobe.
  const glm::vec3 n(0.0f, 0.0f, 1.0f);
  const glm::vec3 through = bsdf.lobes[1].color;
  bsdf.begin(wo, n, n, false, true);
  bsdf.seen_by_camera = false;
  LobeInputs<float> lobe = described(LobeKind::Principled);
  lobe.rules = Rules::Blender52;
  add_principled(bsdf, lobe, sheet(0.0f));
  bsdf.complete();
  EXPECT_EQ(bsdf.count, 1);
  EXPECT_EQ(bsdf.straight, through);
}

// Dense matter sends its light to both sides by wall_forward, and loses none.
TEST(Sheets, DenseMatterSharesItsLight) {
  for (const float roughness : {0.0f, 0.8f}) {
    PrincipledInputs<float> in = sheet(0.5f);
    in.transmission = in.specular = 0.0f;
    in.ior = 1.0f;
    in.wall_scattering = 1.0f;
    in.wall_forward = 0.3f;
    in.diffuse_roughness = roughness;
    const glm::vec3 wo = direction(0.4);
    Bsdf<float> bsdf;
    look(bsdf, in, wo);
    double sides[2] = {0.0, 0.0};
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double z = (i + 0.5) / kSteps, phi = 2.0 * std::numbers::pi * (j + 0.5) / kSteps;
        for (const bool beyond : {false, true})
          sides[beyond] +=
              double{bsdf.eval(direction(beyond ? -z : z, phi)).f().x} * 2.0 * std::numbers::pi / (kSteps * kSteps);
      }
    // The midpoint rule errs by the square of a step, and along the kinks of Oren-Nayar by a part of a step.
    EXPECT_NEAR(sides[0], 0.7, 2e-3) << roughness;
    EXPECT_NEAR(sides[1], 0.3, 2e-3) << roughness;
  }
}

} // namespace
} // namespace lancer
