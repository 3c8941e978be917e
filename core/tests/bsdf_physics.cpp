// Laws of every surface: no energy from nothing, reciprocity, both sides alike, finite numbers at every extreme.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>
#include <limits>

#include "bsdf/lobe.h"
#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;
using testing::seen;
using testing::turned_over;

const float kInfinity = std::numeric_limits<float>::infinity();

using Lobes = std::vector<LobeInputs<float>>;

Lobes single(LobeKind kind, float alpha = 0.0f, float ior = 1.5f, float shininess = 0.0f) {
  return {described(kind, alpha, ior, shininess)};
}

// width: of a microfacet lobe, in slopes; 0 for other lobes.
double albedo(const Lobes &lobes, const glm::vec3 &wo, double width) {
  const Bsdf<float> bsdf = seen(lobes, wo);
  const testing::Domain domain = width > 0.0 ? testing::half_vector_domain(wo, width) : testing::direction_domain();
  return testing::integrate_square(domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).f().x}; }), 16, 4e-7);
}

constexpr double kCosines[] = {1.0, 0.9, 0.5, 0.1, 0.02};

TEST(BsdfPhysics, NoLobeReflectsMoreThanItGets) {
  // 1e-5 covers the quadrature (16 cells along a line end unresolved at 4e-7) and float rounding (6e-8 some 20 times).
  for (double cosine : kCosines) {
    const glm::vec3 wo = direction(cosine);
    EXPECT_NEAR(albedo(single(LobeKind::Lambert), wo, 0.0), 1.0, 1e-5) << cosine;
    for (float n : {0.0f, 1.0f, 10.0f, 200.0f}) {
      EXPECT_LE(albedo(single(LobeKind::Phong, 0, 1, n), wo, 0.0), 1.0 + 1e-5) << "Phong " << n << " " << cosine;
      EXPECT_LE(albedo(single(LobeKind::BlinnPhong, 0, 1, n), wo, 0.0), 1.0 + 1e-5) << "Blinn-Phong " << n << " " << cosine;
    }
    for (float ior : {1.5f, kInfinity})
      for (float alpha : {1e-3f, 1e-2f, 0.1f, 0.4f, 0.7f, 1.0f})
        EXPECT_LE(albedo(single(LobeKind::Beckmann, alpha, ior), wo, alpha), 1.0 + 1e-5)
            << "Beckmann " << alpha << " " << cosine;
  }
}

TEST(BsdfPhysics, BothPhongsReflectAllAtNormalIncidence) {
  // Their factors are defined by this. Floats: the power's exponent n log(cos) rounds by its mean of about 1 ulp.
  for (float n : {0.0f, 1.0f, 10.0f, 200.0f}) {
    EXPECT_NEAR(albedo(single(LobeKind::Phong, 0, 1, n), direction(1.0), 0.0), 1.0, 1e-5) << n;
    EXPECT_NEAR(albedo(single(LobeKind::BlinnPhong, 0, 1, n), direction(1.0), 0.0), 1.0, 1e-5) << n;
  }
}

TEST(BsdfPhysics, SingleDirectionsCarryAtMostTheirColour) {
  Random random(2);
  for (double cosine : {1.0, 0.5, 0.02, -0.02, -0.5, -1.0})
    for (const Lobes &lobes : {single(LobeKind::Mirror), single(LobeKind::Dielectric), single(LobeKind::Beckmann, 1e-6f)}) {
      const Bsdf<float> bsdf = seen(lobes, direction(cosine));
      for (int k = 0; k < 100; ++k) {
        const float u = random.uniform(), x = random.uniform(), y = random.uniform();
        const BsdfSample<float> sample = bsdf.sample(u, x, y);
        ASSERT_TRUE(sample.delta);
        ASSERT_LE(sample.weight.x, 1.0f);
        ASSERT_EQ(bsdf.eval(sample.wi).pdf, 0.0f);
        ASSERT_EQ(bsdf.eval(sample.wi).f(), glm::vec3(0.0f));
        if (lobes[0].kind != LobeKind::Dielectric) {
          ASSERT_EQ(sample.wi, reflect_local(direction(cosine)));
        }
      }
    }
  EXPECT_EQ(seen(single(LobeKind::Beckmann, 1e-6f), {0, 0, 1}).sample(0.5f, 0.5f, 0.5f).weight.x,
            fresnel_dielectric(1.0f, 1.5f));
}

TEST(BsdfPhysics, GlassOfIndexOneIsNotThere) {
  const glm::vec3 wo = direction(0.3);
  const BsdfSample<float> sample = seen(single(LobeKind::Dielectric, 0, 1.0f), wo).sample(0.5f, 0.0f, 0.5f);
  EXPECT_EQ(sample.wi, -wo);
  EXPECT_EQ(sample.weight.x, 1.0f);
  EXPECT_EQ(sample.pdf, 1.0f);
}

TEST(BsdfPhysics, GlassReflectsTotallyFromInside) {
  // Beyond asin(1 / 1.5) = 41.8 degrees every choice is the mirror.
  const glm::vec3 wo = -direction(0.7);
  for (float u : {0.0f, 0.5f, 1.0f - 0x1p-24f}) {
    const BsdfSample<float> sample = seen(single(LobeKind::Dielectric), wo).sample(u, 0.5f, 0.5f);
    EXPECT_EQ(sample.wi, reflect_local(wo));
    EXPECT_EQ(sample.pdf, 1.0f);
  }
}

std::vector<Lobes> smooth_bsdfs() {
  std::vector<Lobes> all{single(LobeKind::Lambert), single(LobeKind::Phong, 0, 1, 30.0f),
                         single(LobeKind::BlinnPhong, 0, 1, 30.0f)};
  for (float alpha : {0.05f, 0.3f, 1.0f})
    for (float ior : {0.9f, 1.0f + 0x1p-23f, 1.5f, kInfinity})
      all.push_back(single(LobeKind::Beckmann, alpha, ior));
  return all;
}

TEST(BsdfPhysics, IsReciprocal) {
  Random random(3);
  for (const Lobes &lobes : smooth_bsdfs())
    for (int k = 0; k < 2000; ++k) {
      const double a = 0.1 + 0.9 * random.uniform(), b = 0.1 + 0.9 * random.uniform();
      const glm::vec3 wo = direction(a, 7.0 * random.uniform()), wi = direction(b, 7.0 * random.uniform());
      const glm::vec3 forth = seen(lobes, wo).eval(wi).f() / wi.z, back = seen(lobes, wi).eval(wo).f() / wo.z;
      // wo.h and wi.h >= 0.1 are equal except for the rounding of h and of the product, 2^-22; F falls at most with c^-4 near
      // ior 1: 4 * 2^-22 / 0.1, and a few roundings of the other factors. At the critical angle of ior 0.9 F has a square-root
      // edge, where 2^-23 moves it by sqrt(2^-23) = 3e-4 times its slope there, about 5.
      const double tolerance = lobes[0].ior == 0.9f ? 2e-3 : 40.0 * 0x1p-22 + 12.0 * 0x1p-24;
      // Below the smallest normal float numbers lose digits.
      ASSERT_NEAR(forth.x, back.x, tolerance * forth.x + std::numeric_limits<float>::min()) << k;
    }
}

TEST(BsdfPhysics, BothSidesAreAlike) {
  Random random(4);
  for (const Lobes &lobes : smooth_bsdfs())
    for (int k = 0; k < 500; ++k) {
      const glm::vec3 wo = direction(random.uniform(), 7.0 * random.uniform()),
                      wi = direction(random.uniform(), 7.0 * random.uniform());
      const Bsdf<float> up = seen(lobes, wo), down = seen(lobes, turned_over(wo));
      const BsdfValue<float> above = up.eval(wi), below = down.eval(turned_over(wi));
      ASSERT_EQ(above.f(), below.f());
      ASSERT_EQ(above.pdf, below.pdf);
      const glm::vec3 other_side = wi * glm::vec3(1.0f, 1.0f, -1.0f);
      ASSERT_EQ(up.eval(other_side).pdf, 0.0f);
      ASSERT_EQ(up.eval(other_side).f(), glm::vec3(0.0f));
      const float u = random.uniform(), x = random.uniform(), y = random.uniform();
      const BsdfSample<float> over = up.sample(u, x, y), under = down.sample(u, x, y);
      ASSERT_EQ(turned_over(over.wi), under.wi);
      ASSERT_EQ(over.weight, under.weight);
    }
}

bool finite(const glm::vec3 &v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

TEST(BsdfPhysics, StaysFiniteAtEveryExtreme) {
  const LobeKind kinds[] = {LobeKind::Lambert,    LobeKind::Beckmann, LobeKind::Mirror,
                            LobeKind::Dielectric, LobeKind::Phong,    LobeKind::BlinnPhong};
  const double cosines[] = {0.0, 1e-38, 1e-20, 1e-7, 1e-3, 0.3, 1.0};
  const float corners[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.9999f, 1.0f - 0x1p-24f};
  for (LobeKind kind : kinds)
    for (float alpha : {0.0f, 1.9e-5f, 2e-5f, 1e-3f, 0.5f, 1.0f})
      for (float ior : {1.0f, 1.0f + 0x1p-23f, 0.9f, 1.5f, 1e19f, kInfinity})
        for (float n : {0.0f, 1.0f, 1e6f}) {
          for (bool with_diffuse : {false, true}) {
            Lobes lobes = single(kind, alpha, ior, n);
            if (with_diffuse)
              lobes.push_back(described(LobeKind::Lambert));
            for (double c : cosines)
              for (double sign : {1.0, -1.0}) {
                const Bsdf<float> bsdf = seen(lobes, direction(c * sign));
                for (double ci : cosines) {
                  const BsdfValue<float> value = bsdf.eval(direction(ci * sign, 0.8 + std::numbers::pi));
                  ASSERT_TRUE(finite(value.f()) && value.f().x >= 0.0f && value.pdf >= 0.0f)
                      << c << " " << ci << " " << alpha << " " << ior;
                }
                for (float x : corners)
                  for (float y : corners) {
                    const BsdfSample<float> sample = bsdf.sample(x, x, y);
                    ASSERT_TRUE(finite(sample.weight) && std::isfinite(sample.pdf))
                        << c << " " << alpha << " " << ior << " " << x << " " << y;
                    ASSERT_TRUE(sample.weight.x >= 0.0f && sample.pdf >= 0.0f);
                    // Reflecting about a unit h rounds some ten times.
                    if (sample.pdf > 0.0f) {
                      ASSERT_NEAR(glm::length(sample.wi), 1.0f, 10.0f * 0x1p-23f);
                    }
                  }
              }
          }
        }
}

TEST(BsdfPhysics, BlackAndEmptySurfacesGiveNothing) {
  for (const Lobes &lobes : {Lobes{}, Lobes{described(LobeKind::Lambert, 0, 1, 0, glm::vec3(0.0f))}}) {
    const Bsdf<float> bsdf = seen(lobes, {0, 0, 1});
    EXPECT_EQ(bsdf.sample(0.5f, 0.5f, 0.5f).pdf, 0.0f);
    EXPECT_FALSE(bsdf.smooth);
    EXPECT_EQ(bsdf.albedo(), glm::vec3(0.0f));
  }
}

TEST(BsdfPhysics, KnowsItsLobes) {
  Lobes lobes = single(LobeKind::Beckmann, 1e-5f);
  EXPECT_TRUE(seen(lobes, {0, 0, 1}).lobes[0].delta);
  EXPECT_FALSE(seen(lobes, {0, 0, 1}).smooth);
  lobes.push_back(described(LobeKind::Lambert, 0, 1, 0, {0.5f, 0.0f, 0.25f}));
  lobes.push_back(described(LobeKind::Mirror, 0, 1, 0, {0.25f, 0.5f, 0.0f}));
  const Bsdf<float> bsdf = seen(lobes, {0, 0, 1});
  EXPECT_TRUE(bsdf.smooth);
  EXPECT_EQ(bsdf.shown(Component::Diffuse), glm::vec3(0.5f, 0.0f, 0.25f));
  EXPECT_EQ(bsdf.shown(Component::Transmission), glm::vec3(0.0f));
  // A coating seen along n reflects F = 0.04, exact except for roundings.
  EXPECT_NEAR(bsdf.shown(Component::Glossy).y, 0.54f, 4.0f * 0x1p-24f);
}

TEST(Frame, IsOrthonormalEverywhere) {
  Random random(8);
  for (int k = 0; k < 100000; ++k) {
    // Every third normal lies within 1e-4 of a pole, where such constructions break.
    const double z = k % 3 == 0 ? (1.0 - 5e-9 * random.uniform()) : 2.0 * random.uniform() - 1.0;
    const glm::vec3 n = direction(k % 2 == 0 ? z : -z, 7.0 * random.uniform());
    const Frame<float> frame(n);
    // Three products of unit vectors, each rounded to an ulp, with n itself rounded.
    const float tolerance = 4.0f * 0x1p-23f;
    ASSERT_NEAR(glm::dot(frame.t, frame.b), 0.0f, tolerance);
    ASSERT_NEAR(glm::dot(frame.t, frame.n), 0.0f, tolerance);
    ASSERT_NEAR(glm::dot(frame.b, frame.n), 0.0f, tolerance);
    ASSERT_NEAR(glm::dot(frame.t, frame.t), 1.0f, tolerance);
    ASSERT_NEAR(glm::dot(frame.b, frame.b), 1.0f, tolerance);
    ASSERT_GT(glm::dot(glm::cross(frame.t, frame.b), frame.n), 0.5f);
    const glm::vec3 w = direction(2.0 * random.uniform() - 1.0, 7.0 * random.uniform());
    ASSERT_NEAR(glm::distance(frame.to_world(frame.to_local(w)), w), 0.0f, 4.0f * tolerance);
  }
}

} // namespace
} // namespace lancer
