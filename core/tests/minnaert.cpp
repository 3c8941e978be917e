// Minnaert's lobe: its formula, its closed forms, and the bound of its energy.
#include "bsdf/matte.h"

#include <gtest/gtest.h>
#include <numbers>

#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;
using testing::seen;

constexpr double kPiExact = std::numbers::pi;

Bsdf<float> minnaert(float k, const glm::vec3 &color, const glm::vec3 &wo) {
  return seen({described(LobeKind::Minnaert, 0.0f, 1.5f, k, color)}, wo);
}

// f without the cosine, of the first channel.
double value(float k, const glm::vec3 &color, const glm::vec3 &wo, const glm::vec3 &wi) {
  return double{minnaert(k, color, wo).eval(wi).f().x} / wi.z;
}

// The formula of lancer.h, in double.
double expected(double k, double rho, double cos_o, double cos_i) {
  const double m = k < 1.0 ? std::pow(rho, 1.0 / (1.0 - k)) : 0.0, q = std::pow(m, k + 1.0);
  const double area = 2.0 * kPiExact * ((1.0 - q) / (k + 1.0) + 0.5 * q);
  return rho / area * std::pow(std::max(cos_o, m) * std::max(cos_i, m), k - 1.0);
}

TEST(Minnaert, IsTheFormulaOfTheHeader) {
  // log1p, exp and the products have some ten roundings of 6e-8; the exponent k - 1 multiplies the rounding of both logarithms,
  // which are at most 7 here.
  for (const float k : {0.0f, 0.3f, 0.7f, 0.99f, 1.0f, 1.5f, 2.0f, 10.0f})
    for (const float rho : {0.02f, 0.5f, 1.0f})
      for (const double cos_o : {1.0, 0.6, 0.05, 1e-3})
        for (const double cos_i : {1.0, 0.4, 1e-2}) {
          const double want = expected(k, rho, cos_o, cos_i);
          const double got = value(k, glm::vec3(rho, 0.5f * rho, 0.0f), direction(cos_o), direction(cos_i, 2.0));
          // Skip values that float does not represent to all digits.
          if (want * cos_i < 1e-37)
            continue;
          EXPECT_NEAR(got / want, 1.0, 1e-6 + std::abs(k - 1.0) * 14.0 * 0x1p-23) << k << " " << rho << " " << cos_o;
        }
}

TEST(Minnaert, IsThePlainLawWhereItKeepsEnergyByItself) {
  // From k = 1 on no cosine is too small: (k + 1) / (2 pi) (cos cos)^(k - 1).
  for (const float k : {1.0f, 1.7f, 3.0f}) {
    const double want = 0.8 * (k + 1.0) / (2.0 * kPiExact) * std::pow(0.1 * 0.3, k - 1.0);
    EXPECT_NEAR(value(k, glm::vec3(0.8f), direction(0.1), direction(0.3)) / want, 1.0, 2e-6) << k;
  }
}

TEST(Minnaert, OneIsLambert) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 wo = direction(0.01 + 0.99 * random.uniform()), wi = direction(0.01 + 0.99 * random.uniform(), 3.0);
    const Bsdf<float> lambert = seen({described(LobeKind::Lambert, 0, 1.5f, 0, glm::vec3(0.7f))}, wo);
    const BsdfValue<float> one = minnaert(1.0f, glm::vec3(0.7f), wo).eval(wi), other = lambert.eval(wi);
    // A handful of roundings of 6e-8.
    EXPECT_NEAR(one.f().x / other.f().x, 1.0, 5e-7);
    EXPECT_NEAR(one.pdf / other.pdf, 1.0, 5e-7);
  }
}

TEST(Minnaert, AWhiteSurfaceOfSmallKIsLambert) {
  for (const float k : {0.0f, 0.5f, 0.9f})
    EXPECT_NEAR(value(k, glm::vec3(1.0f), direction(0.2), direction(0.7)), 1.0 / kPiExact, 1e-7) << k;
}

TEST(Minnaert, SmallKMakesAFullMoonFlat) {
  // k = 1/2 seen from the light's direction: radiance f cos does not depend on the angle, until the cosine falls to m = rho^2.
  const double middle = value(0.5f, glm::vec3(0.1f), direction(1.0), direction(1.0));
  for (const double cosine : {0.9, 0.5, 0.1, 0.011})
    EXPECT_NEAR(value(0.5f, glm::vec3(0.1f), direction(cosine), direction(cosine)) * cosine / middle, 1.0, 2e-6) << cosine;
  EXPECT_LT(value(0.5f, glm::vec3(0.1f), direction(5e-3), direction(5e-3)) * 5e-3 / middle, 0.51);
}

double albedo(float k, const glm::vec3 &color, const glm::vec3 &wo, int channel) {
  const Bsdf<float> bsdf = minnaert(k, color, wo);
  return testing::integrate_square(
      testing::direction_domain().density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).f()[channel]}; }), 16, 1e-7);
}

TEST(Minnaert, AlbedoIsItsClosedFormAndAtMostOne) {
  // rho max(cos_o, m)^(k - 1); 1e-5 covers the quadrature and the roundings of floats.
  for (const float k : {0.0f, 0.5f, 0.9f, 1.0f, 2.0f, 20.0f})
    for (const float rho : {0.05f, 0.5f, 0.9f, 1.0f})
      for (const double cosine : {1.0, 0.7, 0.2, 0.02, 1e-4}) {
        const glm::vec3 wo = direction(cosine), color(rho, 0.3f * rho, 0.0f);
        const double m = k < 1.0f ? std::pow(rho, 1.0 / (1.0 - k)) : 0.0;
        const double want = rho * std::pow(std::max(double{wo.z}, m), k - 1.0);
        const Bsdf<float> bsdf = minnaert(k, color, wo);
        EXPECT_NEAR(albedo(k, color, wo, 0), want, 1e-5 * std::max(want, 0.1)) << k << " " << rho << " " << cosine;
        EXPECT_NEAR(bsdf.albedo().x, want, 2e-6 + 2e-5 * std::abs(k - 1.0) * want) << k << " " << rho << " " << cosine;
        EXPECT_LE(bsdf.albedo().x, 1.0f + 4e-6f) << k << " " << rho << " " << cosine;
        EXPECT_NEAR(bsdf.albedo().y, 0.3f * bsdf.albedo().x, 1e-6f);
      }
}

TEST(Minnaert, AMixtureKeepsTheBoundOfItsColour) {
  // Half of a surface has half of the whole surface's value: the weight is not a colour.
  LobeInputs<float> half = described(LobeKind::Minnaert, 0.0f, 1.5f, 0.5f, glm::vec3(0.6f));
  half.weight = glm::vec3(0.5f);
  const glm::vec3 wo = direction(0.1), wi = direction(0.2);
  EXPECT_FLOAT_EQ(seen({half}, wo).eval(wi).f().x, 0.5f * minnaert(0.5f, glm::vec3(0.6f), wo).eval(wi).f().x);
}

TEST(Minnaert, EverySampleHasTheAlbedoAsItsWeight) {
  // The sampler follows f cos exactly.
  Random random(11);
  for (const float k : {0.0f, 0.4f, 1.0f, 3.0f, 300.0f})
    for (const double cosine : {1.0, 0.3, 0.01}) {
      const glm::vec3 wo = direction(cosine), color(0.4f, 0.2f, 0.1f);
      const Bsdf<float> bsdf = minnaert(k, color, wo);
      for (int i = 0; i < 200; ++i) {
        const float u = random.uniform(), x = random.uniform(), y = random.uniform();
        const BsdfSample<float> sample = bsdf.sample(u, x, y);
        if (bsdf.albedo().x == 0.0f || !(sample.pdf > 0.0f))
          continue;
        EXPECT_NEAR(sample.weight.x / bsdf.albedo().x, 1.0f, 1e-5f) << k << " " << cosine;
      }
    }
}

TEST(Minnaert, ExtremesStayFinite) {
  Random random(5);
  for (const float k : {0.0f, 1e-7f, 0.999999f, 1.0f, 1.000001f, 1e8f})
    for (const float rho : {0.0f, 1e-38f, 1e-10f, 1.0f, 1e30f})
      for (const float z : {-0.3f, 0.0f, 1e-38f, 1e-20f, 1e-7f, 1.0f}) {
        const glm::vec3 wo(std::sqrt(1.0f - z * z), 0.0f, z);
        Bsdf<float> bsdf;
        const glm::vec3 up(0, 0, 1);
        bsdf.begin(wo, up, up, false, true);
        add_lobe(bsdf, described(LobeKind::Minnaert, 0.0f, 1.5f, k, glm::vec3(rho)));
        bsdf.complete();
        for (const float wi_z : {1e-38f, 1e-20f, 1e-3f, 1.0f}) {
          const BsdfValue<float> value = bsdf.eval({std::sqrt(1.0f - wi_z * wi_z), 0.0f, wi_z});
          EXPECT_TRUE(std::isfinite(value.f().x) && value.f().x >= 0.0f) << k << " " << rho << " " << z << " " << wi_z;
          EXPECT_TRUE(std::isfinite(value.pdf)) << k << " " << rho << " " << z;
        }
        for (const float x : {0.0f, 0.3f, 1.0f - 0x1p-24f}) {
          const BsdfSample<float> sample = bsdf.sample(random.uniform(), x, random.uniform());
          EXPECT_TRUE(std::isfinite(sample.wi.x) && std::isfinite(sample.weight.x) && std::isfinite(sample.pdf))
              << k << " " << rho << " " << z << " " << x;
        }
      }
}

} // namespace
} // namespace lancer
