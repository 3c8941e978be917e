// Toon: brightness and density of its cone, in closed form.
#include "bsdf/toon.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

Lobe<float> toon(float size, float smooth, Toon variant = Toon::Diffuse, Rules rules = Rules::Blender52) {
  return make_toon(glm::vec3(1.0f), size, smooth, variant, rules);
}

// The mean brightness over the solid angle of the cone: the edge falls linearly from full angle s by m, down to a.
double albedo(const Lobe<float> &lobe) {
  const double s = lobe.alpha_x, m = lobe.alpha_y, a = lobe.energy;
  double sum = 1.0 - std::cos(std::min(s, a));
  if (a > s)
    sum += std::cos(s) - std::cos(a) * (1.0 - (a - s) / m) - (std::sin(a) - std::sin(s)) / m;
  return sum / (1.0 - std::cos(a));
}

TEST(Toon, SamplesAreUniformInTheConeAndWeighItsBrightness) {
  constexpr int kDraws = 20000;
  struct Shape {
    float size, smooth;
  };
  const std::vector<Shape> shapes{{0.5f, 0.0f}, {0.3f, 0.4f}, {0.0f, 0.5f}, {0.05f, 0.02f}, {0.8f, 0.7f}, {1.0f, 1.0f}};
  std::vector<double> p_values;
  Random random(5);
  for (const Shape &shape : shapes)
    for (const Toon variant : {Toon::Diffuse, Toon::Glossy}) {
      const Lobe<float> lobe = toon(shape.size, shape.smooth, variant);
      const glm::vec3 wo = direction(0.9), axis = toon_axis(lobe, wo);
      std::vector<double> heights, turns;
      double sum = 0.0, sum2 = 0.0;
      for (int k = 0; k < kDraws; ++k) {
        const float u = random.uniform(), v = random.uniform();
        const glm::vec3 wi = toon_sample(lobe, wo, u, v);
        const glm::dvec3 apart = glm::dvec3(wi) - glm::dvec3(axis);
        heights.push_back(std::min(0.5 * glm::dot(apart, apart) / double{lobe.shininess}, 1.0));
        turns.push_back(double{v});
        // Below the horizon the lobe is black, and the samples are lost.
        const ColorValue<float> value = toon_eval(lobe, wo, wi, false);
        const double weight = value.pdf > 0.0f ? double{value.f.x / value.pdf} : 0.0;
        const double above = wi.z > 0.0f ? weight : double{toon_brightness(lobe, std::acos(glm::dot(wi, axis)))};
        sum += above;
        sum2 += above * above;
      }
      p_values.push_back(testing::uniformity_p_value(heights));
      const double mean = sum / kDraws, variance = std::max(0.0, sum2 / kDraws - mean * mean) / kDraws;
      // The rounding of the angle adds 1e-5.
      p_values.push_back(testing::normal_p_value((mean - albedo(lobe)) / std::sqrt(variance + 1e-10)));
    }
  const double level = testing::sidak_level(testing::kSignificance, p_values.size());
  for (size_t i = 0; i < p_values.size(); ++i)
    EXPECT_GT(p_values[i], level) << "shape " << i / 4 << ", test " << i % 4;
}

TEST(Toon, DensityIsThatOfTheCone) {
  const Lobe<float> lobe = toon(0.3f, 0.2f);
  const double a = 0.5 * std::numbers::pi * 0.5, pdf = 1.0 / (2.0 * std::numbers::pi * (1.0 - std::cos(a)));
  const glm::vec3 wo = direction(0.4);
  for (const double angle : {0.0, 0.3, 0.6, 0.7, 0.78}) {
    const ColorValue<float> value = toon_eval(lobe, wo, direction(std::cos(angle), 2.0), false);
    const double edge = 0.5 * std::numbers::pi * 0.3,
                 bright = angle < edge ? 1.0 : 1.0 - (angle - edge) / (0.1 * std::numbers::pi);
    // Some ten roundings of float directions.
    EXPECT_NEAR(value.pdf, pdf, 2e-6 * pdf);
    EXPECT_NEAR(value.f.x, pdf * bright, 4e-6 * pdf) << angle;
  }
  EXPECT_EQ(toon_eval(lobe, wo, direction(std::cos(0.8), 2.0), false).pdf, 0.0f);
}

// The diffuse cone does not depend on the viewer, even behind the normal; the glossy one needs both above.
TEST(Toon, SidesFollowTheVariant) {
  const glm::vec3 up(0.0f, 0.0f, 1.0f), behind = direction(-0.2);
  EXPECT_GT(toon_eval(toon(0.5f, 0.0f), behind, up, false).f.x, 0.0f);
  EXPECT_EQ(toon_eval(toon(0.9f, 0.0f, Toon::Glossy), behind, up, false).f.x, 0.0f);
  const Lobe<float> glossy = toon(0.9f, 0.0f, Toon::Glossy);
  EXPECT_EQ(toon_eval(glossy, direction(0.1), direction(-0.05, 0.8 + std::numbers::pi), false).f.x, 0.0f);
  EXPECT_GT(toon_eval(glossy, direction(0.1), direction(0.1, 0.8 + std::numbers::pi), false).f.x, 0.0f);
}

// A cone without width is the narrowest one; in Blender 3 it is black.
TEST(Toon, WithoutSize) {
  EXPECT_GT(toon(0.0f, 0.0f).shininess, 0.0f);
  EXPECT_EQ(toon(0.0f, 0.0f).color, glm::vec3(1.0f));
  EXPECT_EQ(toon(0.0f, 0.0f, Toon::Glossy, Rules::Blender3).color, glm::vec3(0.0f));
}

// Cycles 3 takes the brightness of a sample at the share of the angle by which it lies within the edge of the solid angle.
TEST(Toon, SamplesOfBlender3AreAtAnotherAngle) {
  const Lobe<float> lobe = toon(0.2f, 0.6f, Toon::Diffuse, Rules::Blender3);
  const glm::vec3 wo = direction(0.7);
  for (const float u : {0.1f, 0.4f, 0.9f}) {
    const glm::vec3 wi = toon_sample(lobe, wo, u, 0.3f);
    const ColorValue<float> drawn = toon_eval(lobe, wo, wi, true), lit = toon_eval(lobe, wo, wi, false);
    EXPECT_NEAR(drawn.f.x / drawn.pdf, toon_brightness(lobe, (1.0f - u) * lobe.energy), 1e-5) << u;
    EXPECT_NE(lit.f.x, drawn.f.x) << u;
  }
}

} // namespace
} // namespace lancer
