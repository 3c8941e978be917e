// Principled: its lobes and frames, their passes, and extreme inputs.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "bsdf/fresnel.h"
#include "bsdf/material_lobes.h"
#include "principled_lab.h"
#include "statistics.h"

namespace lancer {
namespace {

using namespace testing;

// Cycles 3 shows the weights of its closures in the passes, newer versions their albedos.
TEST(Principled, PassesOfBlender3ShowNoFresnel) {
  const glm::vec3 wo = direction(0.6), weight(0.3f, 0.6f, 0.9f);
  PrincipledInputs<float> in = plain(Rules::Blender3);
  in.metallic = 0.4f;
  in.coat = 0.3f;
  Bsdf<float> bsdf;
  look(bsdf, in, wo, weight);
  expect_near(bsdf.shown(Component::Glossy), 2.0f * weight, kRounding, "reflection and coat");
  expect_near(bsdf.shown(Component::Diffuse), 0.6f * in.base_color * weight, kRounding, "diffuse");
  EXPECT_LT(bsdf.albedo().x, weight.x);

  in.metallic = in.coat = 0.0f;
  in.transmission = 1.0f;
  look(bsdf, in, wo, weight);
  const float reflectance = fresnel_dielectric(wo.z, in.ior);
  expect_near(bsdf.shown(Component::Glossy), reflectance * weight, kRounding, "glass");
  expect_near(bsdf.shown(Component::Transmission), (1.0f - reflectance) * in.base_color * weight, kRounding, "through");

  for (const Rules rules : {Rules::Blender4, Rules::Blender45}) {
    PrincipledInputs<float> newer = plain(rules);
    newer.metallic = 0.4f;
    newer.coat = 0.3f;
    look(bsdf, newer, wo, weight);
    const glm::vec3 sum = bsdf.shown(Component::Diffuse) + bsdf.shown(Component::Glossy) + bsdf.shown(Component::Transmission);
    expect_near(sum, bsdf.albedo(), kRounding, "newer");
  }
}

TEST(Principled, GlassKnowsItsInside) {
  PrincipledInputs<float> in = plain(Rules::Blender45);
  in.base_color = glm::vec3(1.0f);
  in.transmission = 1.0f;
  in.roughness = 0.0f;
  // Beyond the critical angle of 41.8 degrees everything is reflected from inside, and not from outside.
  const float cosine = 0.7f;
  Bsdf<float> bsdf;
  look(bsdf, in, direction(-cosine));
  for (const float u : {0.01f, 0.5f, 0.99f}) {
    const BsdfSample<float> sample = bsdf.sample(u, 0.5f, 0.5f);
    EXPECT_TRUE(sample.delta);
    EXPECT_LT(sample.wi.z, 0.0f);
    EXPECT_NEAR(sample.weight.x, 1.0f, 2e-3f);
  }
  look(bsdf, in, direction(cosine));
  const BsdfSample<float> through = bsdf.sample(0.99f, 0.5f, 0.5f);
  EXPECT_LT(through.wi.z, 0.0f);
  EXPECT_TRUE(through.transmitted);
  // Snell: the sine for cosine 0.7 is divided by 1.5.
  EXPECT_NEAR(std::hypot(through.wi.x, through.wi.y), std::sqrt(1.0f - cosine * cosine) / 1.5f, 1e-6f);
}

// Lobes without normals of their own share the shading frame to the bit, so that no bump is detected.
TEST(Principled, HasOneFrameWithoutOtherNormals) {
  Random random(5);
  for (int k = 0; k < 200; ++k) {
    const glm::vec3 n = glm::normalize(direction(0.1 + 0.9 * random.uniform(), 6.28 * random.uniform()));
    for (const Rules rules : kAllRules) {
      PrincipledInputs<float> in = plain(rules);
      in.coat = in.sheen = in.metallic = in.transmission = 0.5f;
      LobeInputs<float> lobe = testing::described(LobeKind::Principled);
      lobe.rules = rules;
      Bsdf<float> bsdf;
      bsdf.begin(n, n, n, false, true);
      add_principled(bsdf, lobe, in);
      EXPECT_EQ(bsdf.frame_count, 1);
    }
  }
}

// Layers planned in advance, with sampled tables, are the same layers.
TEST(Principled, KeptLayersAreThoseMadeInPlace) {
  Random random(11);
  for (int k = 0; k < 2000; ++k) {
    PrincipledInputs<float> in = plain(k % 2 ? Rules::Blender4 : Rules::Blender45);
    in.roughness = random.uniform();
    in.coat_roughness = random.uniform();
    in.ior = 0.8f + random.uniform();
    in.specular = random.uniform();
    in.anisotropic = k % 3 ? 0.0f : random.uniform();
    in.coat = k % 4 ? 0.0f : random.uniform();
    in.metallic = k % 5 ? 0.0f : random.uniform();
    in.transmission = k % 7 ? 0.0f : random.uniform();
    LobeInputs<float> lobe = testing::described(LobeKind::Principled);
    lobe.rules = in.rules;
    lobe.tangent = {1.0f, 0.0f, 0.0f};
    const bool inside = k % 2;
    ReadyLobe ready;
    std::vector<std::unique_ptr<const CachedPlan>> plans;
    float f0;
    for (const LayerRow &row : kLayers)
      for (const bool side : {false, true})
        if (row.facets && (row.layer != PrincipledLayer::Gloss || plastic_ior(in, f0) != 1.0f))
          ready.plans[side][static_cast<int>(row.layer)] =
              plans.emplace_back(cached(plan_layer(row.layer, lobe, in, side))).get();
    const LaneLobes<float> kept{{&ready}, inside};
    const glm::vec3 wo = direction(random.uniform()), wi = direction(random.uniform(), 6.28 * random.uniform()), n(0, 0, 1);
    Bsdf<float> planned, in_place;
    for (Bsdf<float> *bsdf : {&planned, &in_place}) {
      bsdf->begin(wo, n, n, inside, true);
      bsdf == &planned ? add_layers(*bsdf, lobe, in, kept) : add_principled(*bsdf, lobe, in);
      bsdf->complete();
    }
    ASSERT_EQ(planned.count, in_place.count);
    // Tables are interpolated in another order: a product of ten factors, each with a few roundings, times the factor 1 / (1 -
    // albedo) of the layers above.
    const glm::vec3 a = planned.eval(wi).f(), b = in_place.eval(wi).f();
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(a[c], b[c], 64.0f * 0x1p-24f * std::max(b[c], 1.0f)) << k;
  }
}

// Invalid inputs are clamped to their range.
TEST(Principled, StaysFiniteForAnyInput) {
  const glm::vec3 wo = direction(0.6), wi = direction(0.4, 3.0);
  for (const Rules rules : kAllRules)
    for (const float x : {-1.0f, 0.0f, 1.0f, 2.0f, 1e6f}) {
      PrincipledInputs<float> in = plain(rules);
      in.metallic = in.roughness = in.specular = in.transmission = in.coat = in.sheen = in.ior = in.coat_ior = x;
      in.anisotropic = in.coat_roughness = in.sheen_roughness = in.diffuse_roughness = in.transmission_roughness = x;
      const glm::vec3 f = value(in, wo, wi);
      EXPECT_TRUE(std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.z)) << x;
      EXPECT_GE(std::min({f.x, f.y, f.z}), 0.0f) << x;
    }
}

} // namespace
} // namespace lancer
