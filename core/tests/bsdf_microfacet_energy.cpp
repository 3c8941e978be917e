// Blender's rough lobes: energy is neither created nor lost, reciprocity, finite numbers at every extreme.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>
#include <limits>

#include "bsdf/albedo_tables.h"
#include "bsdf_facets.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Random;
using testing::reflected;
using testing::rough;
using testing::seen;
using testing::through;

const float kInfinity = std::numeric_limits<float>::infinity();

TEST(Microfacet, NoLobeScattersMoreThanItGets) {
  for (double cosine : {1.0, 0.5, 0.1})
    for (float roughness : {0.1f, 0.5f, 1.0f}) {
      const double alpha = roughness * roughness;
      for (Facets facets : {Facets::Ggx, Facets::Beckmann})
        for (Rules rules : {Rules::Blender3, Rules::Blender45}) {
          LobeInputs<float> glossy = rough(LobeKind::Glossy, facets, roughness);
          glossy.rules = rules;
          // Quadrature and floats; Beckmann's rational masking may deviate from the exact one by 0.35 %.
          const double slack = facets == Facets::Ggx ? 2e-5 : 0.0035;
          EXPECT_LE(reflected(seen({glossy}, direction(cosine)), alpha), 1.0 + slack) << cosine << " " << roughness;
        }
      for (float ior : {1.5f, 0.8f}) {
        const Bsdf<float> glass = seen({rough(LobeKind::Glass, Facets::Ggx, roughness, ior)}, direction(cosine));
        EXPECT_LE(reflected(glass, alpha) + through(glass, alpha, ior), 1.0 + 2e-5) << cosine << " " << roughness << " " << ior;
      }
    }
}

TEST(Microfacet, MultipleScatteringLosesNothing) {
  // Between its nodes the table is linear: for roughness below 0.25 and at the horizon the albedo deviates by more than 1 %
  // within a cell, elsewhere by less than 0.3 %. At the nodes only rounding remains.
  for (int y : {4, 16, 31})
    for (int x : {8, 16, 31}) {
      const float cosine = static_cast<float>(y) / 31.0f, roughness = static_cast<float>(x) / 31.0f;
      const Bsdf<float> bsdf = seen({rough(LobeKind::Glossy, Facets::MultiGgx, roughness)}, direction(cosine));
      EXPECT_NEAR(reflected(bsdf, roughness * roughness), 1.0, 6e-5) << cosine << " " << roughness;
    }
  Random random(8);
  for (int k = 0; k < 40; ++k) {
    const float roughness = 0.3f + 0.7f * random.uniform(), cosine = 0.15f + 0.85f * random.uniform();
    const Bsdf<float> bsdf = seen({rough(LobeKind::Glossy, Facets::MultiGgx, roughness)}, direction(cosine));
    EXPECT_NEAR(reflected(bsdf, roughness * roughness), 1.0, 3e-3) << cosine << " " << roughness;
  }
}

TEST(Microfacet, FurtherBouncesTakeTheColour) {
  LobeInputs<float> inputs = rough(LobeKind::Glossy, Facets::MultiGgx, 1.0f);
  inputs.color = glm::vec3(0.5f);
  const Bsdf<float> bsdf = seen({inputs}, direction(1.0));
  const double e = ggx_albedo(1.0f, 1.0f), mean = ggx_mean_albedo(1.0f), f = 0.5;
  // The first bounce f E, all further ones f (1 - E) times f mean / (1 - f (1 - mean)).
  const double expected = f * (e + (1.0 - e) * f * mean / (1.0 - f * (1.0 - mean)));
  EXPECT_NEAR(reflected(bsdf, 1.0), expected, 5e-5);
}

TEST(Microfacet, IsReciprocal) {
  Random random(5);
  for (float roughness : {0.3f, 0.7f, 1.0f})
    for (Facets facets : {Facets::Ggx, Facets::Beckmann})
      for (int k = 0; k < 1000; ++k) {
        const std::vector<LobeInputs<float>> glossy{rough(LobeKind::Glossy, facets, roughness)};
        const glm::vec3 wo = direction(0.1 + 0.9 * random.uniform(), 7.0 * random.uniform()),
                        wi = direction(0.1 + 0.9 * random.uniform(), 7.0 * random.uniform());
        // |wo + wi| >= 0.2 and |wo + 1.5 wi'| >= 0.5: half vectors have an error of 2^-22 over this, at most 1.2e-6. If they
        // tilt by less than 60 degrees this is 4.8e-6 of slope, and Beckmann's exponent s^2, s <= 9.3 widths, moves by 2 s /
        // alpha times it.
        const double tolerance = 2.0 * 9.3 * 4.8e-6 / (roughness * roughness);
        const double forth = seen(glossy, wo).eval(wi).f().x / wi.z, back = seen(glossy, wi).eval(wo).f().x / wo.z;
        if (glm::normalize(wo + wi).z > 0.5f) {
          ASSERT_NEAR(forth, back, tolerance * forth + std::numeric_limits<float>::min());
        }
        // Through glass: f from outside is eta^2 times that from inside, for radiance that is not scaled at the boundary.
        const std::vector<LobeInputs<float>> glass{rough(LobeKind::Glass, facets, roughness)};
        const glm::vec3 under = wi * glm::vec3(1.0f, 1.0f, -1.0f);
        const double in = seen(glass, wo).eval(under).f().x / wi.z, out = seen(glass, under).eval(wo).f().x / wo.z;
        const glm::vec3 h = glm::normalize(-(wo + 1.5f * under));
        // Near total reflection the transmittance follows the square root of the rounding.
        if (h.z > 0.5f && glm::dot(wo, h) > 0.1f) {
          ASSERT_NEAR(in, 2.25 * out, tolerance * in + std::numeric_limits<float>::min());
        }
      }
}

TEST(Microfacet, StaysFiniteAtEveryExtreme) {
  const double cosines[] = {0.0, 1e-38, 1e-20, 1e-7, 1e-3, 0.3, 1.0};
  const float corners[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.9999f, 1.0f - 0x1p-24f};
  const auto finite = [](const glm::vec3 &v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  for (LobeKind kind : {LobeKind::Glossy, LobeKind::Glass, LobeKind::Refraction, LobeKind::Conductor, LobeKind::Translucent,
                        LobeKind::Diffuse, LobeKind::Sheen})
    for (Facets facets : {Facets::Ggx, Facets::Beckmann, Facets::MultiGgx, Facets::AshikhminShirley})
      for (float roughness : {0.0f, 0.0044f, 0.0046f, 0.03f, 0.7f, 1.0f})
        for (float ior : {0.0f, 1.0f, 1.0f + 0x1p-23f, 1.0002f, 0.9f, 1.5f, 1e19f, kInfinity})
          for (float anisotropy : {0.0f, 1.0f, -1.0f}) {
            if (facets == Facets::AshikhminShirley && kind != LobeKind::Glossy)
              continue;
            LobeInputs<float> inputs = rough(kind, facets, roughness, ior);
            inputs.anisotropy = anisotropy;
            inputs.option = 1;
            for (double c : cosines)
              for (double sign : {1.0, -1.0}) {
                const Bsdf<float> bsdf = seen({inputs}, direction(c * sign));
                ASSERT_TRUE(finite(bsdf.albedo())) << static_cast<int>(kind) << " " << roughness << " " << ior << " " << c;
                for (double ci : cosines)
                  for (double side : {1.0, -1.0}) {
                    const BsdfValue<float> value = bsdf.eval(direction(ci * side, 0.8 + std::numbers::pi));
                    ASSERT_TRUE(finite(value.f()) && value.f().x >= 0.0f && value.pdf >= 0.0f && std::isfinite(value.pdf))
                        << static_cast<int>(kind) << " " << static_cast<int>(facets) << " " << roughness << " " << ior << " "
                        << anisotropy << " " << c << " " << ci << " " << side;
                  }
                for (float x : corners)
                  for (float y : corners) {
                    const BsdfSample<float> sample = bsdf.sample(x, y, x);
                    ASSERT_TRUE(finite(sample.weight) && std::isfinite(sample.pdf))
                        << static_cast<int>(kind) << " " << roughness << " " << ior << " " << c << " " << x << " " << y;
                    ASSERT_TRUE(sample.weight.x >= 0.0f && sample.pdf >= 0.0f);
                    if (sample.pdf > 0.0f) {
                      ASSERT_NEAR(glm::length(sample.wi), 1.0f, 12.0f * 0x1p-23f);
                    }
                  }
              }
          }
}

} // namespace
} // namespace lancer
