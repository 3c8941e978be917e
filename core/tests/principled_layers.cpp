// Principled: effects of its inputs on light, in the layers of Blender 4 and in the sum of Blender 3.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "bsdf/ashikhmin.h"
#include "bsdf/sheen.h"
#include "principled_lab.h"
#include "statistics.h"

namespace lancer {
namespace {

using namespace testing;

struct Mean {
  glm::dvec3 value{0.0}, error{0.0};
};

// Returns the albedo under a white sky, by the sampler, with its standard error from rows of a jittered grid.
Mean under_sky(const PrincipledInputs<float> &in, const glm::vec3 &wo, uint64_t seed) {
  constexpr int kRows = 32, kSide = 24;
  Bsdf<float> bsdf;
  look(bsdf, in, wo);
  Random random(seed);
  Mean mean;
  glm::dvec3 squares(0.0);
  for (int row = 0; row < kRows; ++row) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const auto within = [&](int cell) {
          return std::min((static_cast<float>(cell) + random.uniform()) / kSide, 1.0f - 0x1p-24f);
        };
        const float u = within(i), v = within(j);
        sum += glm::dvec3(bsdf.sample(random.uniform(), u, v).weight);
      }
    sum /= kSide * kSide;
    mean.value += sum / double{kRows};
    squares += sum * sum / double{kRows};
  }
  mean.error = glm::sqrt(glm::max(squares - mean.value * mean.value, 0.0) / double{kRows - 1});
  return mean;
}

TEST(Principled, WeightScalesAll) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0), weight(0.3f, 0.6f, 0.9f);
  for (const Rules rules : kAllRules) {
    PrincipledInputs<float> in = plain(rules);
    in.metallic = 0.3f;
    in.coat = 0.5f;
    in.transmission = 0.2f;
    expect_near(value(in, wo, wi, glm::vec3(0.5f)), 0.5f * value(in, wo, wi), kRounding, "half");
    // Blender 4 removes from all colours the largest loss of any; without layers each colour is separate.
    if (rules == Rules::Blender3)
      expect_near(value(in, wo, wi, weight), weight * value(in, wo, wi), kRounding, "coloured");
  }
}

TEST(Principled, WithoutGlossIsLambert) {
  const glm::vec3 wo = direction(0.3), wi = direction(0.7, 2.0);
  PrincipledInputs<float> in = plain(Rules::Blender45);
  const glm::vec3 lambert = in.base_color * (wi.z * std::numbers::inv_pi_v<float>);
  in.ior = 1.0f;
  expect_near(value(in, wo, wi), lambert, kRounding, "IOR 1");
  in.ior = 1.5f;
  in.specular = 0.0f;
  expect_near(value(in, wo, wi), lambert, kRounding, "level 0");
}

// Inputs of a layer with weight 0 have no effect.
TEST(Principled, AbsentLayersCostNothing) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0);
  for (const Rules rules : kAllRules) {
    PrincipledInputs<float> in = plain(rules), odd = in;
    odd.coat_roughness = 0.9f;
    odd.coat_tint = {0.1f, 0.2f, 0.3f};
    odd.sheen_roughness = 0.1f;
    odd.coat_ior = 3.0f;
    EXPECT_EQ(value(in, wo, wi), value(odd, wo, wi));
    Bsdf<float> bsdf;
    look(bsdf, odd, wo);
    EXPECT_EQ(bsdf.count, 2);
    in.metallic = 1.0f;
    look(bsdf, in, wo);
    EXPECT_EQ(bsdf.count, 1);
  }
}

TEST(Principled, MetalAndPlasticMixByTheirShare) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0);
  for (const Rules rules : kAllRules) {
    PrincipledInputs<float> in = plain(rules);
    in.roughness = 0.4f;
    const glm::vec3 plastic = value(in, wo, wi);
    in.metallic = 1.0f;
    const glm::vec3 metal = value(in, wo, wi);
    in.metallic = 0.25f;
    expect_near(value(in, wo, wi), 0.25f * metal + 0.75f * plastic, kRounding, "a quarter");
  }
}

// A white metal with multiple scattering reflects all light. The tables of its loss are exact to 0.1 %.
TEST(Principled, WhiteMetalLosesNothing) {
  uint64_t seed = 1;
  for (const Rules rules : {Rules::Blender4, Rules::Blender45})
    for (const float roughness : {0.05f, 0.5f, 1.0f})
      for (const double cosine : {0.95, 0.5, 0.2}) {
        PrincipledInputs<float> in = plain(rules);
        in.base_color = glm::vec3(1.0f);
        in.metallic = 1.0f;
        in.roughness = roughness;
        const Mean mean = under_sky(in, direction(cosine), seed++);
        EXPECT_NEAR(mean.value.x, 1.0, 1e-3 + 5.0 * mean.error.x) << roughness << " " << cosine;
      }
}

// White materials gain no energy with any setting. Layers subtract Cycles' averages of Fresnel curves, which are slightly wrong
// for each direction: 2 %. Blender 3 adds its gloss on top and does gain energy; so does IOR below 1.
TEST(Principled, MakesNoLight) {
  Random random(3);
  const auto any = [&] { return random.uniform() < 0.3f ? std::floor(2.0f * random.uniform()) : random.uniform(); };
  for (int k = 0; k < 120; ++k) {
    PrincipledInputs<float> in = plain(random.uniform() < 0.5f ? Rules::Blender4 : Rules::Blender45);
    in.base_color = glm::vec3(1.0f);
    in.metallic = any();
    in.roughness = any();
    in.ior = 1.0f + random.uniform();
    in.diffuse_roughness = any();
    in.anisotropic = any();
    in.transmission = any();
    in.coat = any();
    in.coat_roughness = any();
    in.sheen = any();
    in.sheen_roughness = any();
    const glm::vec3 wo = direction((random.uniform() < 0.3f ? -1.0 : 1.0) * (0.1 + 0.9 * random.uniform()));
    const Mean mean = under_sky(in, wo, 100 + static_cast<uint64_t>(k));
    EXPECT_LE(mean.value.x, 1.02 + 5.0 * mean.error.x)
        << "metallic " << in.metallic << " roughness " << in.roughness << " ior " << in.ior << " transmission "
        << in.transmission << " coat " << in.coat << ", " << in.coat_roughness << " sheen " << in.sheen << ", "
        << in.sheen_roughness << " anisotropic " << in.anisotropic << " from " << wo.z;
  }
}

TEST(Principled, ClothTakesWhatItScatters) {
  const glm::vec3 wo = direction(0.3), wi = direction(0.7, 2.0);
  PrincipledInputs<float> in = plain(Rules::Blender45);
  in.emission = {1.0f, 2.0f, 3.0f};
  const glm::vec3 bare = value(in, wo, wi);
  in.sheen = 0.7f;
  in.sheen_roughness = 0.6f;
  const Lobe<float> cloth = make_sheen(glm::vec3(0.7f), 0.6f, wo.z);
  const float left = 1.0f - cloth.albedo.x;
  expect_near(emitted(in, wo), left * in.emission, kRounding, "emission");
  expect_near(value(in, wo, wi), left * bare + cloth.color * sheen_eval(cloth, wo, wi).f, kRounding, "value");
}

// A coat that bends no light reflects none, and tints by Beer's law along the straight path.
TEST(Principled, CoatColoursByBeersLaw) {
  PrincipledInputs<float> in = plain(Rules::Blender45);
  in.emission = glm::vec3(1.0f);
  in.coat = 1.0f;
  in.coat_ior = 1.0f;
  in.coat_tint = {0.9f, 0.5f, 0.1f};
  for (const double cosine : {1.0, 0.6, 0.2}) {
    const glm::vec3 wo = direction(cosine);
    expect_near(emitted(in, wo), glm::pow(in.coat_tint, glm::vec3(1.0f / wo.z)), 1e-5f, "coated");
  }
  in.coat_ior = 1.5f;
  // At an index of 1.5 a direction of cosine 0.5 continues with sin = sqrt(3) / 3, cos = sqrt(6) / 3.
  const glm::vec3 wo = direction(0.5);
  const glm::vec3 coloured = emitted(in, wo);
  in.coat_tint = glm::vec3(1.0f);
  expect_near(coloured / emitted(in, wo), glm::pow(glm::vec3(0.9f, 0.5f, 0.1f), glm::vec3(std::sqrt(1.5f))), 1e-5f, "bent");
}

TEST(Principled, CoatOfBlender3IsAdded) {
  const glm::vec3 wo = direction(0.6, 0.0), wi = direction(0.5, std::numbers::pi);
  PrincipledInputs<float> in = plain(Rules::Blender3);
  const glm::vec3 bare = value(in, wo, wi);
  in.coat = 0.8f;
  in.coat_roughness = 0.3f;
  const Lobe<float> coat = make_clear_coat(glm::vec3(0.8f), 0.09f, wo.z);
  expect_near(value(in, wo, wi) - bare, coat.color * gloss_eval(coat, wo, wi).f, 2e-5f, "coat");
}

// The specular level scales the reflection at the normal through the index: level 1 doubles F0, up to 99 %.
TEST(Principled, LevelScalesTheReflectionAtTheNormal) {
  const glm::vec3 n(0.0f, 0.0f, 1.0f);
  PrincipledInputs<float> in = plain(Rules::Blender45);
  in.base_color = glm::vec3(0.0f);
  in.roughness = 0.02f;
  for (const float level : {0.25f, 0.5f, 1.0f}) {
    in.specular = level;
    const Mean mean = under_sky(in, n, 9);
    EXPECT_NEAR(mean.value.x, 0.04 * 2.0 * level, 1e-3 * level + 5.0 * mean.error.x) << level;
  }
}

} // namespace
} // namespace lancer
