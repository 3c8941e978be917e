// Evaluation for light samples: the value, and the transmission of rough boundaries between directions that no facet connects.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>
#include <numbers>

#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::look;
using testing::Random;

constexpr float kAlpha = 0.36f;

LobeInputs<float> boundary(LobeKind kind, float ior) {
  LobeInputs<float> inputs = described(kind, 0.6f, ior, 0.0f, {0.9f, 0.6f, 0.3f});
  inputs.distribution = Facets::Ggx;
  return inputs;
}

// Cosines of wo and wi to the half vector of a boundary with index eta, h on the side of wo's normal.
struct Facet {
  glm::dvec3 h;
  double cos_o, cos_i;

  Facet(const glm::dvec3 &wo, const glm::dvec3 &wi, double eta) : h(glm::normalize(-(wo + eta * wi))) {
    if (h.z < 0.0)
      h = -h;
    cos_o = glm::dot(wo, h);
    cos_i = glm::dot(wi, h);
  }
  bool connects() const { return cos_o > 0.0 && cos_i < 0.0; }
};

// Walter et al. 2007, equation 21, with its absolute cosines, times |cos wi|, without Fresnel; Smith's height-correlated
// masking.
double refracted(const glm::dvec3 &wo, const glm::dvec3 &wi, double eta) {
  const Facet facet(wo, wi, eta);
  const double a2 = double{kAlpha} * kAlpha, cos2 = facet.h.z * facet.h.z, slope = 1.0 + (a2 - 1.0) * cos2;
  const double d = a2 / (std::numbers::pi * slope * slope);
  const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 - c * c) / (c * c)) - 1.0); };
  const double g = 1.0 / (1.0 + lambda(wo.z) + lambda(wi.z));
  const double length = facet.cos_o + eta * facet.cos_i;
  return std::abs(facet.cos_o * facet.cos_i) * eta * eta * g * d / (length * length * wo.z);
}

TEST(BsdfLit, IsTheValueWhereAFacetConnects) {
  Random random(31);
  for (LobeKind kind : {LobeKind::Refraction, LobeKind::Glass, LobeKind::Glossy, LobeKind::Diffuse, LobeKind::Translucent})
    for (float ior : {1.45f, 0.7f}) {
      int connected = 0;
      for (int k = 0; k < 2000; ++k) {
        const glm::vec3 wo = direction(0.02 + 0.98 * random.uniform());
        const glm::vec3 wi = direction(2.0 * random.uniform() - 1.0, 7.0 * random.uniform());
        if (wi.z < 0.0f && kind != LobeKind::Translucent && !Facet(wo, wi, ior).connects())
          continue;
        Bsdf<float> bsdf;
        look(bsdf, {boundary(kind, ior)}, wo);
        const BsdfValue<float> value = bsdf.eval(wi), lit = bsdf.eval_lit(wi);
        EXPECT_EQ(lit.f(), value.f());
        EXPECT_EQ(lit.pdf, value.pdf);
        connected += value.pdf > 0.0f;
      }
      EXPECT_GT(connected, 100) << static_cast<int>(kind) << " " << ior;
    }
}

TEST(BsdfLit, PassesLightWhereNoFacetConnects) {
  Random random(32);
  for (float ior : {1.45f, 0.7f}) {
    int apart = 0;
    for (int k = 0; k < 500; ++k) {
      const glm::vec3 wo = direction(0.1 + 0.9 * random.uniform());
      const glm::vec3 wi = direction(-0.1 - 0.9 * random.uniform(), 7.0 * random.uniform());
      const Facet facet(wo, wi, ior);
      // Near these cosines the float half vector may be on the other side.
      if (facet.connects() || std::min(std::abs(facet.cos_o), std::abs(facet.cos_i)) < 1e-3)
        continue;
      ++apart;
      Bsdf<float> bsdf;
      look(bsdf, {boundary(LobeKind::Refraction, ior)}, wo);
      EXPECT_EQ(bsdf.eval(wi).f(), glm::vec3(0.0f));
      const BsdfValue<float> lit = bsdf.eval_lit(wi);
      const double expected = refracted(wo, wi, ior);
      // The inputs' roundings move wo + eta wi, which is at least |1 - eta| = 0.3 long, by 2 ulp, multiplied by D's slope of at
      // most 8 in the angle (1 / alpha^2) and by the square of the length; cosines of 1e-3 lose three digits.
      const double tolerance = 40.0 * 0x1p-24 / 0.3 + 4.0 * 0x1p-24 / std::min(std::abs(facet.cos_o), std::abs(facet.cos_i));
      EXPECT_NEAR(lit.f().x / (double{0.9f} * expected), 1.0, tolerance) << wo.z << " " << wi.z;
      EXPECT_NEAR(lit.f().z / lit.f().x, 0.3f / 0.9f, 4.0 * 0x1p-24);
    }
    EXPECT_GT(apart, 100) << ior;
  }
}

} // namespace
} // namespace lancer
