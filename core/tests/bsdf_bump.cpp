// Different normals: the surface's, the shading normal and a lobe's own.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>
#include <limits>

#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;

constexpr double kUlp = 0x1p-24;

glm::vec3 tilted(double degrees, double phi) { return direction(std::cos(degrees / 180.0 * std::numbers::pi), phi); }

struct Place {
  glm::vec3 wo, ns, ng;
  bool correction = true;
};

Bsdf<float> at(const Place &place, const LobeInputs<float> &lobe, bool with_translucent = false) {
  Bsdf<float> bsdf;
  bsdf.begin(place.wo, place.ns, place.ng, false, place.correction);
  add_lobe(bsdf, lobe);
  if (with_translucent)
    add_lobe(bsdf, described(LobeKind::Translucent));
  bsdf.complete();
  return bsdf;
}

LobeInputs<float> about(LobeKind kind, const glm::vec3 &n, Rules rules = Rules::Blender45) {
  LobeInputs<float> inputs = described(kind, 0.5f);
  inputs.normal = n;
  inputs.rules = rules;
  return inputs;
}

const glm::vec3 kUp(0.0f, 0.0f, 1.0f);

// If the interpolated normal faces away from the viewer, wide lobes keep it, and reflecting lobes tilt it until it is visible.
TEST(BsdfBump, FromBehindTheSmoothNormal) {
  const glm::vec3 wo = direction(0.1, 0.0), ns = tilted(40.0, std::numbers::pi);
  const Place place{wo, ns, kUp};
  ASSERT_LT(glm::dot(wo, ns), 0.0f);
  const LobeInputs<float> clay = about(LobeKind::Diffuse, glm::vec3(0.0f));
  const double a = 1.0 / (std::numbers::pi + 0.5 * (0.5 * std::numbers::pi - 2.0 / 3.0)), b = 0.5 * a;
  // On the far side of the viewer, and on the near side.
  for (const glm::vec3 &wi : {direction(0.9, 2.0), direction(0.9, 0.3)}) {
    const double cos_i = glm::dot(glm::dvec3(wi), glm::dvec3(ns));
    // The cosine: at most 3 roundings of 1 in a product, over pi; and 2 of the result, which is below 0.3.
    EXPECT_NEAR(at(place, about(LobeKind::Lambert, glm::vec3(0.0f))).eval(wi).f().x, cos_i / std::numbers::pi, 2.0 * kUlp);
    // t is the product of two directions in the lobe's frame: 18 roundings of its axes, 12 of the components, 3 of the product.
    // Each counts b, also where t is divided by cos_i, which returns as a factor: 33 * 0.14. The cosine's 3 count at most 0.28,
    // which is a; and the factors' 8 count the result, which is below 0.22. Together 7.3.
    const double t = glm::dot(glm::dvec3(wi), glm::dvec3(wo)), term = t > 0.0 ? t / cos_i : t;
    EXPECT_NEAR(at(place, clay).eval(wi).f().x, cos_i * (a + b * term), 8.0 * kUlp);
  }
  const Bsdf<float> gloss = at(place, about(LobeKind::Glossy, glm::vec3(0.0f)));
  ASSERT_EQ(gloss.count, 1);
  EXPECT_GT(gloss.wo_local[gloss.lobes[0].frame].z, 0.0f);
  EXPECT_GT(gloss.albedo().x, 0.0f);
}

TEST(BsdfBump, NothingIsSampledThroughTheSurface) {
  Random random(1);
  for (LobeKind kind : {LobeKind::Lambert, LobeKind::Diffuse, LobeKind::Beckmann, LobeKind::Phong, LobeKind::BlinnPhong,
                        LobeKind::Mirror, LobeKind::Dielectric, LobeKind::Glossy, LobeKind::Glass, LobeKind::Refraction,
                        LobeKind::Conductor, LobeKind::Sheen, LobeKind::Translucent, LobeKind::Minnaert})
    for (int k = 0; k < 500; ++k) {
      const glm::vec3 ns = tilted(40.0 * random.uniform(), 7.0 * random.uniform());
      LobeInputs<float> lobe = about(kind, tilted(60.0 * random.uniform(), 7.0 * random.uniform()));
      lobe.shininess = 5.0f;
      lobe.roughness = k % 3 == 0 ? 0.0f : 0.6f;
      const Place place{direction(0.05 + 0.95 * random.uniform(), 7.0 * random.uniform()), ns, kUp};
      // A transmitting lobe must not contribute density to a reflecting one.
      const Bsdf<float> bsdf = at(place, lobe), mixed = at(place, lobe, true);
      for (int i = 0; i < 20; ++i) {
        const float u = random.uniform(), x = random.uniform(), y = random.uniform();
        for (const BsdfSample<float> &sample : {bsdf.sample(u, x, y), mixed.sample(u, x, y)})
          if (sample.pdf > 0.0f) {
            ASSERT_EQ(sample.transmitted, sample.wi.z < 0.0f) << static_cast<int>(kind);
          }
        // The density agrees: 0 where a reflecting lobe would have to transmit.
        const glm::vec3 wi = direction(2.0 * x - 1.0, 7.0 * y);
        const bool through = kind == LobeKind::Translucent || kind == LobeKind::Refraction;
        if (kind != LobeKind::Glass && (wi.z < 0.0f) != through) {
          ASSERT_EQ(bsdf.eval(wi).pdf, 0.0f) << static_cast<int>(kind);
        }
      }
    }
}

// Cycles 3 does not check the samples of refracting lobes against the geometric normal; samples, densities and values agree.
TEST(BsdfBump, WhatRefractsInBlender3MayPassTheWrongWay) {
  const Place place{direction(0.6, 0.0), tilted(120.0, 0.5), kUp};
  for (const auto &[kind, facets] :
       {std::pair{LobeKind::Refraction, Facets::Ggx}, std::pair{LobeKind::Glass, Facets::MultiGgx}})
    for (const Rules rules : {Rules::Blender3, Rules::Blender4}) {
      LobeInputs<float> lobe = about(kind, glm::vec3(0.0f), rules);
      lobe.distribution = facets;
      lobe.roughness = 0.9f;
      const Bsdf<float> bsdf = at(place, lobe);
      Random random(5);
      int strays = 0;
      for (int k = 0; k < 1000; ++k) {
        const float u = random.uniform(), x = random.uniform(), y = random.uniform();
        const BsdfSample<float> sample = bsdf.sample(u, x, y);
        if (sample.pdf > 0.0f && sample.transmitted != (sample.wi.z < 0.0f)) {
          ++strays;
          // The sampler knows its half vector; the evaluation reconstructs it from directions that may nearly cancel: of 100000
          // samples none deviates by more than 1.5e-5.
          EXPECT_NEAR(bsdf.eval(sample.wi).pdf / sample.pdf, 1.0, 2e-5);
        }
      }
      EXPECT_EQ(strays > 0, rules == Rules::Blender3) << static_cast<int>(kind);
    }
}

TEST(BsdfBump, InterpolatedNormalsMeetLightsAsTheSmoothSurfaceWould) {
  // 5 degrees below the surface, 25 above the horizon of the shading normal.
  const Place place{direction(0.8, 0.0), tilted(30.0, 0.0), kUp};
  const glm::vec3 wi = tilted(95.0, 0.0);
  const BsdfValue<float> value = at(place, described(LobeKind::Lambert)).eval(wi);
  EXPECT_NEAR(value.f().x, std::cos(65.0 / 180.0 * std::numbers::pi) / std::numbers::pi, 8.0 * kUlp);
  EXPECT_EQ(value.pdf, 0.0f);
}

TEST(BsdfBump, ABumpIsDarkBehindTheShadingNormal) {
  const Place place{direction(0.8, 0.0), kUp, kUp};
  const glm::vec3 n = tilted(40.0, 0.0), below = tilted(95.0, 0.0);
  ASSERT_GT(glm::dot(n, below), 0.5f);
  for (LobeKind kind : {LobeKind::Lambert, LobeKind::Diffuse, LobeKind::Glossy, LobeKind::Conductor, LobeKind::Sheen})
    EXPECT_EQ(at(place, about(kind, n)).eval(below).f(), glm::vec3(0.0f)) << static_cast<int>(kind);
}

TEST(BsdfBump, TheLitSideEndsSmoothly) {
  const glm::vec3 n = tilted(40.0, 0.0);
  const double tilt = 40.0 / 180.0 * std::numbers::pi;
  for (double degrees : {-60.0, 0.0, 30.0, 60.0, 80.0, 89.0}) {
    const glm::vec3 wi = direction(std::cos(degrees / 180.0 * std::numbers::pi), degrees < 0.0 ? std::numbers::pi : 0.0);
    const double cos_n = glm::dot(glm::dvec3(n), glm::dvec3(wi)), c = wi.z;
    const Place smooth{direction(0.8, 0.0), kUp, kUp, true}, hard{direction(0.8, 0.0), kUp, kUp, false};
    // Smith's term of GGX with alpha^2 = tan^2(tilt) / 8. The tilt's cosine rounds, and then its tan^2: 20 roundings.
    const double alpha2 = std::min(1.0, 0.125 * std::pow(std::tan(tilt), 2.0));
    const double g = 2.0 / (1.0 + std::sqrt(1.0 + alpha2 * (1.0 - c * c) / (c * c)));
    const double plain = std::max(0.0, cos_n) / std::numbers::pi;
    EXPECT_NEAR(at(smooth, about(LobeKind::Lambert, n)).eval(wi).f().x, g * plain, 20.0 * kUlp) << degrees;
    EXPECT_NEAR(at(hard, about(LobeKind::Lambert, n)).eval(wi).f().x, plain, 8.0 * kUlp) << degrees;
    // Before Blender 4.5: a cubic in the ratio of cosines, 1 on the unshadowed side.
    const double ratio = cos_n > 0.0 ? std::min(1.0, c / (cos_n * std::cos(tilt))) : 1.0;
    const double cubic = ratio * (1.0 + ratio - ratio * ratio);
    EXPECT_NEAR(at(smooth, about(LobeKind::Lambert, n, Rules::Blender4)).eval(wi).f().x, cubic * plain, 20.0 * kUlp) << degrees;
    // Glossy lobes are not softened.
    const float gloss = at(smooth, about(LobeKind::Glossy, n)).eval(wi).f().x;
    EXPECT_EQ(gloss, at(hard, about(LobeKind::Glossy, n)).eval(wi).f().x) << degrees;
  }
}

TEST(BsdfBump, ReflectionsRiseAboveTheSurface) {
  Random random(3);
  for (int k = 0; k < 20000; ++k) {
    const glm::vec3 wo = direction(1e-3 + random.uniform() * (1.0 - 1e-3), 7.0 * random.uniform());
    const glm::vec3 n = tilted(85.0 * random.uniform(), 7.0 * random.uniform());
    Bsdf<float> bsdf;
    bsdf.begin(wo, kUp, kUp, false, true);
    const glm::vec3 m = reflecting_normal(bsdf, n);
    const double height = 2.0 * glm::dot(glm::dvec3(m), glm::dvec3(wo)) * m.z - wo.z;
    const double least = std::min(0.9 * wo.z, 0.01);
    const double before = 2.0 * glm::dot(glm::dvec3(n), glm::dvec3(wo)) * n.z - wo.z;
    // Some ten roundings of unit vectors; the argument of the root may be small, but then the root is nearly 0: an error of
    // 2^-22 in it moves the cosine by the root of that if the tilt is nearly 0 or 90 degrees.
    constexpr double tolerance = 1e-3;
    ASSERT_NEAR(glm::length(m), 1.0, 8.0 * kUlp);
    if (before >= least + 1e-6) {
      ASSERT_NEAR(glm::distance(m, n), 0.0f, 4.0 * kUlp);
    } else {
      ASSERT_NEAR(height, least, tolerance) << k;
      // The normal stays between both: in their plane, and no farther from the geometric normal than before.
      ASSERT_NEAR(glm::dot(glm::cross(n, kUp), m), 0.0f, tolerance);
      ASSERT_GE(m.z, n.z - tolerance);
    }
    bsdf.begin(wo, kUp, kUp, false, false);
    ASSERT_NEAR(glm::distance(reflecting_normal(bsdf, n), n), 0.0f, 4.0 * kUlp);
  }
}

TEST(BsdfBump, SeveralFramesAreKeptApart) {
  Bsdf<float> bsdf;
  bsdf.begin(direction(0.5), kUp, kUp, false, true);
  EXPECT_EQ(add_frame(bsdf, glm::vec3(0.0f), glm::vec3(0.0f)), 0);
  EXPECT_EQ(add_frame(bsdf, 2.0f * kUp, glm::vec3(0.0f)), 0);
  const uint8_t stretched = add_frame(bsdf, kUp, {0.0f, 3.0f, 1.0f});
  EXPECT_EQ(stretched, 1);
  EXPECT_EQ(bsdf.frames[1].t, glm::vec3(0.0f, 1.0f, 0.0f));
  EXPECT_EQ(bsdf.frames[1].b, glm::vec3(-1.0f, 0.0f, 0.0f));
  EXPECT_EQ(add_frame(bsdf, kUp, {0.0f, 1.0f, 0.0f}), 1);
  // Without room for a frame, the shading frame replaces it.
  for (int i = 0; i < 2 * kMaxFrames; ++i)
    add_frame(bsdf, tilted(10.0 + i, 1.0), glm::vec3(0.0f));
  EXPECT_EQ(bsdf.frame_count, kMaxFrames);
  EXPECT_EQ(add_frame(bsdf, tilted(70.0, 1.0), glm::vec3(0.0f)), 0);
}

TEST(BsdfBump, TangentsTurnCounterClockwise) {
  const glm::vec3 quarter = turn_about({1.0f, 0.0f, 0.0f}, kUp, 0.25f);
  // The angle's cosine at pi/2 rounds to 4e-8.
  EXPECT_NEAR(glm::distance(quarter, glm::vec3(0.0f, 1.0f, 0.0f)), 0.0f, 2.0 * kUlp);
}

// Light above ns, at a lobe whose normal leans away from ns and sees it: wide lobes reject it by all rules, narrow lobes and
// velvet since 5.0.
TEST(BsdfBump, NormalsThatLeanAwayRejectLightByTheRulesOfAVersion) {
  const auto factor = [](LobeShape shape, Matte variant, Rules rules) {
    Lobe<float> lobe;
    lobe.shape = shape;
    lobe.variant = static_cast<uint8_t>(variant);
    lobe.rules = rules;
    const glm::vec3 n = glm::normalize(glm::vec3(1.0f, 0.0f, -0.25f)), ns(0, 0, 1), wi = glm::normalize(glm::vec3(1, 0, 1));
    return bump_acts(lobe, false) ? bump_factor(lobe, n, ns, wi.z, glm::dot(n, wi), false) : 1.0f;
  };
  for (const Rules rules : {Rules::Blender3, Rules::Blender4, Rules::Blender45, Rules::Blender50, Rules::Blender52}) {
    const float narrow = rules < Rules::Blender50 ? 1.0f : 0.0f;
    EXPECT_EQ(factor(LobeShape::Lambert, Matte::OrenNayar, rules), 0.0f);
    EXPECT_EQ(factor(LobeShape::Microfacet, Matte::OrenNayar, rules), narrow);
    EXPECT_EQ(factor(LobeShape::Matte, Matte::Velvet, rules), narrow);
  }
}

} // namespace
} // namespace lancer
