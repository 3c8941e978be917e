// Principled: which lobes its sliders make, with which shares, in the layers of Blender 4 and in the sum of Blender 3.
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

#include "bsdf/ashikhmin.h"
#include "bsdf/principled.h"
#include "bsdf/sheen.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

constexpr Rules kAllRules[] = {Rules::Blender3, Rules::Blender4, Rules::Blender45};

PrincipledInputs plain(Rules rules) {
  PrincipledInputs in;
  in.rules = rules;
  in.base_color = {0.8f, 0.5f, 0.2f};
  if (rules == Rules::Blender3) {
    in.distribution = Facets::Ggx;
    in.specular_tint = in.sheen_tint = glm::vec3(0.0f);
  }
  return in;
}

void look(Bsdf &bsdf, const PrincipledInputs &in, const glm::vec3 &wo, const glm::vec3 &weight = glm::vec3(1.0f)) {
  const bool inside = wo.z < 0.0f;
  const glm::vec3 n(0.0f, 0.0f, inside ? -1.0f : 1.0f);
  bsdf.begin(wo, n, n, inside, true);
  LobeInputs lobe = testing::described(LobeKind::Principled);
  lobe.rules = in.rules;
  lobe.weight = weight;
  lobe.tangent = {1.0f, 0.0f, 0.0f};
  add_principled(bsdf, lobe, in);
  bsdf.complete();
}

glm::vec3 value(const PrincipledInputs &in, const glm::vec3 &wo, const glm::vec3 &wi,
                const glm::vec3 &weight = glm::vec3(1.0f)) {
  Bsdf bsdf;
  look(bsdf, in, wo, weight);
  return bsdf.eval(wi).f();
}

glm::vec3 emitted(const PrincipledInputs &in, const glm::vec3 &wo) {
  Bsdf bsdf;
  look(bsdf, in, wo);
  return bsdf.emission;
}

struct Mean {
  glm::dvec3 value{0.0}, error{0.0};
};

// Light from a white sky, by the sampler, with its standard error from rows of a jittered grid.
Mean under_sky(const PrincipledInputs &in, const glm::vec3 &wo, uint64_t seed) {
  constexpr int kRows = 32, kSide = 24;
  Bsdf bsdf;
  look(bsdf, in, wo);
  Random random(seed);
  Mean mean;
  glm::dvec3 squares(0.0);
  for (int row = 0; row < kRows; ++row) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const glm::vec2 u((static_cast<float>(i) + random.uniform()) / kSide,
                          (static_cast<float>(j) + random.uniform()) / kSide);
        sum += glm::dvec3(bsdf.sample(random.uniform(), glm::min(u, glm::vec2(1.0f - 0x1p-24f))).weight);
      }
    sum /= kSide * kSide;
    mean.value += sum / double{kRows};
    squares += sum * sum / double{kRows};
  }
  mean.error = glm::sqrt(glm::max(squares - mean.value * mean.value, 0.0) / double{kRows - 1});
  return mean;
}

void expect_near(const glm::vec3 &a, const glm::vec3 &b, float relative, const char *what) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(a[i], b[i], relative * std::max(std::abs(a[i]), std::abs(b[i]))) << what << " channel " << i;
}

// A few dozen float roundings.
constexpr float kRounding = 4e-6f;

TEST(Principled, WeightScalesAll) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0), weight(0.3f, 0.6f, 0.9f);
  for (const Rules rules : kAllRules) {
    PrincipledInputs in = plain(rules);
    in.metallic = 0.3f;
    in.coat = 0.5f;
    in.transmission = 0.2f;
    expect_near(value(in, wo, wi, glm::vec3(0.5f)), 0.5f * value(in, wo, wi), kRounding, "half");
    // Blender 4 takes from all colours what the most reflecting one loses; without layers each goes its own way.
    if (rules == Rules::Blender3)
      expect_near(value(in, wo, wi, weight), weight * value(in, wo, wi), kRounding, "coloured");
  }
}

TEST(Principled, WithoutGlossIsLambert) {
  const glm::vec3 wo = direction(0.3), wi = direction(0.7, 2.0);
  PrincipledInputs in = plain(Rules::Blender45);
  const glm::vec3 lambert = in.base_color * (wi.z * std::numbers::inv_pi_v<float>);
  in.ior = 1.0f;
  expect_near(value(in, wo, wi), lambert, kRounding, "IOR 1");
  in.ior = 1.5f;
  in.specular = 0.0f;
  expect_near(value(in, wo, wi), lambert, kRounding, "level 0");
}

// Nothing that a layer of weight 0 is told matters.
TEST(Principled, AbsentLayersCostNothing) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0);
  for (const Rules rules : kAllRules) {
    PrincipledInputs in = plain(rules), odd = in;
    odd.coat_roughness = 0.9f;
    odd.coat_tint = {0.1f, 0.2f, 0.3f};
    odd.sheen_roughness = 0.1f;
    odd.coat_ior = 3.0f;
    EXPECT_EQ(value(in, wo, wi), value(odd, wo, wi));
    Bsdf bsdf;
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
    PrincipledInputs in = plain(rules);
    in.roughness = 0.4f;
    const glm::vec3 plastic = value(in, wo, wi);
    in.metallic = 1.0f;
    const glm::vec3 metal = value(in, wo, wi);
    in.metallic = 0.25f;
    expect_near(value(in, wo, wi), 0.25f * metal + 0.75f * plastic, kRounding, "a quarter");
  }
}

// A white metal gives back all light where the light of several bounces is kept. The tables of its loss are exact to 0.1 %.
TEST(Principled, WhiteMetalLosesNothing) {
  uint64_t seed = 1;
  for (const Rules rules : {Rules::Blender4, Rules::Blender45})
    for (const float roughness : {0.05f, 0.5f, 1.0f})
      for (const double cosine : {0.95, 0.5, 0.2}) {
        PrincipledInputs in = plain(rules);
        in.base_color = glm::vec3(1.0f);
        in.metallic = 1.0f;
        in.roughness = roughness;
        const Mean mean = under_sky(in, direction(cosine), seed++);
        EXPECT_NEAR(mean.value.x, 1.0, 1e-3 + 5.0 * mean.error.x) << roughness << " " << cosine;
      }
}

// No setting of white things makes light. Layers take Cycles' averages of Fresnel curves from each other, which are a little
// off for each direction: 2 %. Blender 3 adds its gloss on top and does make light; so does IOR below 1.
TEST(Principled, MakesNoLight) {
  Random random(3);
  const auto any = [&] { return random.uniform() < 0.3f ? std::floor(2.0f * random.uniform()) : random.uniform(); };
  for (int k = 0; k < 120; ++k) {
    PrincipledInputs in = plain(random.uniform() < 0.5f ? Rules::Blender4 : Rules::Blender45);
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
  PrincipledInputs in = plain(Rules::Blender45);
  in.emission = {1.0f, 2.0f, 3.0f};
  const glm::vec3 bare = value(in, wo, wi);
  in.sheen = 0.7f;
  in.sheen_roughness = 0.6f;
  const Lobe cloth = make_sheen(glm::vec3(0.7f), 0.6f, wo.z);
  const float left = 1.0f - cloth.albedo.x;
  expect_near(emitted(in, wo), left * in.emission, kRounding, "emission");
  expect_near(value(in, wo, wi), left * bare + cloth.color * sheen_eval(cloth, wo, wi).f, kRounding, "value");
}

// A coat that bends nothing reflects nothing, and colours by Beer's law along the straight way.
TEST(Principled, CoatColoursByBeersLaw) {
  PrincipledInputs in = plain(Rules::Blender45);
  in.emission = glm::vec3(1.0f);
  in.coat = 1.0f;
  in.coat_ior = 1.0f;
  in.coat_tint = {0.9f, 0.5f, 0.1f};
  for (const double cosine : {1.0, 0.6, 0.2}) {
    const glm::vec3 wo = direction(cosine);
    expect_near(emitted(in, wo), glm::pow(in.coat_tint, glm::vec3(1.0f / wo.z)), 1e-5f, "coated");
  }
  in.coat_ior = 1.5f;
  // At an index of 1.5 a direction of cosine 0.5 goes on with sin = sqrt(3) / 3, cos = sqrt(6) / 3.
  const glm::vec3 wo = direction(0.5);
  const glm::vec3 coloured = emitted(in, wo);
  in.coat_tint = glm::vec3(1.0f);
  expect_near(coloured / emitted(in, wo), glm::pow(glm::vec3(0.9f, 0.5f, 0.1f), glm::vec3(std::sqrt(1.5f))), 1e-5f, "bent");
}

TEST(Principled, CoatOfBlender3IsAdded) {
  const glm::vec3 wo = direction(0.6, 0.0), wi = direction(0.5, std::numbers::pi);
  PrincipledInputs in = plain(Rules::Blender3);
  const glm::vec3 bare = value(in, wo, wi);
  in.coat = 0.8f;
  in.coat_roughness = 0.3f;
  const Lobe coat = make_clear_coat(glm::vec3(0.8f), 0.09f, wo.z);
  expect_near(value(in, wo, wi) - bare, coat.color * gloss_eval(coat, wo, wi).f, 2e-5f, "coat");
}

// The index that bends the level bends the reflection at the normal with it: level 1 doubles F0, at most to 99 %.
TEST(Principled, LevelScalesTheReflectionAtTheNormal) {
  const glm::vec3 n(0.0f, 0.0f, 1.0f);
  PrincipledInputs in = plain(Rules::Blender45);
  in.base_color = glm::vec3(0.0f);
  in.roughness = 0.02f;
  for (const float level : {0.25f, 0.5f, 1.0f}) {
    in.specular = level;
    const Mean mean = under_sky(in, n, 9);
    EXPECT_NEAR(mean.value.x, 0.04 * 2.0 * level, 1e-3 * level + 5.0 * mean.error.x) << level;
  }
}

TEST(Principled, GlassKnowsItsInside) {
  PrincipledInputs in = plain(Rules::Blender45);
  in.base_color = glm::vec3(1.0f);
  in.transmission = 1.0f;
  in.roughness = 0.0f;
  // Beyond the critical angle of 41.8 degrees all is reflected from inside, and not from outside.
  const float cosine = 0.7f;
  Bsdf bsdf;
  look(bsdf, in, direction(-cosine));
  for (const float u : {0.01f, 0.5f, 0.99f}) {
    const BsdfSample sample = bsdf.sample(u, {0.5f, 0.5f});
    EXPECT_TRUE(sample.delta);
    EXPECT_LT(sample.wi.z, 0.0f);
    EXPECT_NEAR(sample.weight.x, 1.0f, 2e-3f);
  }
  look(bsdf, in, direction(cosine));
  const BsdfSample through = bsdf.sample(0.99f, {0.5f, 0.5f});
  EXPECT_LT(through.wi.z, 0.0f);
  EXPECT_TRUE(through.transmitted);
  // Snell: the sine of cosine 0.7 is divided by 1.5.
  EXPECT_NEAR(std::hypot(through.wi.x, through.wi.y), std::sqrt(1.0f - cosine * cosine) / 1.5f, 1e-6f);
}

// Lobes without normals of their own share the shading frame to the bit: no bump is taken for one that is not there.
TEST(Principled, HasOneFrameWithoutOtherNormals) {
  Random random(5);
  for (int k = 0; k < 200; ++k) {
    const glm::vec3 n = glm::normalize(direction(0.1 + 0.9 * random.uniform(), 6.28 * random.uniform()));
    for (const Rules rules : kAllRules) {
      PrincipledInputs in = plain(rules);
      in.coat = in.sheen = in.metallic = in.transmission = 0.5f;
      LobeInputs lobe = testing::described(LobeKind::Principled);
      lobe.rules = rules;
      Bsdf bsdf;
      bsdf.begin(n, n, n, false, true);
      add_principled(bsdf, lobe, in);
      EXPECT_EQ(bsdf.frame_count, 1);
    }
  }
}

// Layers that were planned ahead, with their tables read ahead, are the same layers.
TEST(Principled, KeptLayersAreThoseMadeInPlace) {
  Random random(11);
  for (int k = 0; k < 2000; ++k) {
    PrincipledInputs in = plain(k % 2 ? Rules::Blender4 : Rules::Blender45);
    in.roughness = random.uniform();
    in.coat_roughness = random.uniform();
    in.ior = 0.8f + random.uniform();
    in.specular = random.uniform();
    in.anisotropic = k % 3 ? 0.0f : random.uniform();
    in.coat = k % 4 ? 0.0f : random.uniform();
    in.metallic = k % 5 ? 0.0f : random.uniform();
    in.transmission = k % 7 ? 0.0f : random.uniform();
    LobeInputs lobe = testing::described(LobeKind::Principled);
    lobe.rules = in.rules;
    lobe.tangent = {1.0f, 0.0f, 0.0f};
    LayerPlan kept = plan_layers(lobe, in, Sides::Both);
    keep_rows(kept);
    const bool inside = k % 2;
    const glm::vec3 wo = direction(random.uniform()), wi = direction(random.uniform(), 6.28 * random.uniform()), n(0, 0, 1);
    Bsdf planned, in_place;
    for (Bsdf *bsdf : {&planned, &in_place}) {
      bsdf->begin(wo, n, n, inside, true);
      bsdf == &planned ? add_layers(*bsdf, lobe, in, kept) : add_principled(*bsdf, lobe, in);
      bsdf->complete();
    }
    ASSERT_EQ(planned.count, in_place.count);
    // Tables are read in another order: a product of ten factors, each off by a few roundings, times what 1 / (1 - albedo) of
    // the layers above enlarges them by.
    const glm::vec3 a = planned.eval(wi).f(), b = in_place.eval(wi).f();
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(a[c], b[c], 64.0f * 0x1p-24f * std::max(b[c], 1.0f)) << k;
  }
}

// Bad numbers of sockets are kept within what they mean.
TEST(Principled, StaysFiniteForAnyInput) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0);
  for (const Rules rules : kAllRules)
    for (const float x : {-1.0f, 0.0f, 1.0f, 2.0f, 1e6f}) {
      PrincipledInputs in = plain(rules);
      in.metallic = in.roughness = in.specular = in.transmission = in.coat = in.sheen = in.ior = in.coat_ior = x;
      in.anisotropic = in.coat_roughness = in.sheen_roughness = in.diffuse_roughness = in.transmission_roughness = x;
      const glm::vec3 f = value(in, wo, wi);
      EXPECT_TRUE(std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.z)) << x;
      EXPECT_GE(std::min({f.x, f.y, f.z}), 0.0f) << x;
    }
}

} // namespace
} // namespace lancer
