// Blender's rough lobes: closed forms, limits, energy against exact integrals, reciprocity, finite numbers at every extreme.
#include "bsdf/bsdf.h"

#include <complex>
#include <gtest/gtest.h>
#include <limits>

#include "bsdf/albedo_tables.h"
#include "bsdf/microfacet.h"
#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;
using testing::seen;

constexpr double kUlp = 0x1p-24;
const float kInfinity = std::numeric_limits<float>::infinity();

LobeInputs rough(LobeKind kind, Facets facets, float roughness, float ior = 1.5f) {
  LobeInputs inputs = described(kind, roughness, ior);
  inputs.distribution = facets;
  return inputs;
}

// Integral of f cos over the upper side, by half vectors of slopes about alpha.
double reflected(const Bsdf &bsdf, double alpha) {
  const testing::Domain domain = testing::half_vector_domain(bsdf.wo, alpha);
  return testing::integrate_square(domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).f().x}; }), 16, 4e-7);
}

// The same for what goes through.
double through(const Bsdf &bsdf, double alpha, double ior) {
  const testing::Domain domain = testing::bent_domain(bsdf.wo, alpha, ior);
  return testing::integrate_square(domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).f().x}; }), 16, 4e-7);
}

TEST(Microfacet, GgxMatchesItsTextbookForm) {
  // D = a^2 / (pi ((n.h)^2 (a^2 - 1) + 1)^2) and G = 2 n.o n.i / (n.o sqrt(a^2 + (1 - a^2) (n.i)^2) + the same exchanged), in
  // long double from the same floats. wo + wi rounds by an ulp of 1 and more, which at slopes up to 4 alpha moves D by
  // 16 / alpha of that; the other factors round some 40 times.
  Random random(1);
  for (float alpha : {1e-3f, 0.05f, 0.4f, 1.0f})
    for (int k = 0; k < 200; ++k) {
      const glm::vec3 wo = direction(0.3 + 0.7 * random.uniform());
      const float x = random.uniform(), y = random.uniform();
      const Bsdf bsdf = seen({rough(LobeKind::Glossy, Facets::Ggx, std::sqrt(alpha))}, wo);
      const BsdfSample sample = bsdf.sample(0.5f, {0.9f * x, y});
      if (!(sample.wi.z > 0.1f))
        continue;
      using Long = long double;
      const Long ox = wo.x, oy = wo.y, oz = wo.z, ix = sample.wi.x, iy = sample.wi.y, iz = sample.wi.z;
      const Long hx = ox + ix, hy = oy + iy, hz = oz + iz, length2 = hx * hx + hy * hy + hz * hz;
      const Long a = bsdf.lobes[0].alpha_x, a2 = a * a, sin2 = (hx * hx + hy * hy) / length2, cos2 = hz * hz / length2;
      const Long d = a2 / (std::numbers::pi_v<Long> * (sin2 + a2 * cos2) * (sin2 + a2 * cos2));
      const Long g = 2 * oz * iz / (oz * std::sqrt(a2 + (1 - a2) * iz * iz) + iz * std::sqrt(a2 + (1 - a2) * oz * oz));
      const Long expected = d * g / (4 * oz);
      const double tolerance = (40.0 + 2.0 * 16.0 / alpha) * kUlp;
      ASSERT_NEAR(static_cast<double>(bsdf.eval(sample.wi).f().x / expected), 1.0, tolerance) << alpha << " " << k;
    }
}

TEST(Microfacet, BeckmannOfBlender3IsTheCoatingWithoutFresnel) {
  Random random(2);
  for (float roughness : {0.2f, 0.6f, 1.0f})
    for (int k = 0; k < 500; ++k) {
      LobeInputs inputs = rough(LobeKind::Glossy, Facets::Beckmann, roughness);
      inputs.rules = Rules::Blender3;
      const glm::vec3 wo = direction(0.05 + 0.95 * random.uniform()), wi = direction(0.05 + 0.95 * random.uniform(), 4.0);
      const Bsdf facets = seen({inputs}, wo);
      const Bsdf coating = seen({described(LobeKind::Beckmann, facets.lobes[0].alpha_x, kInfinity)}, wo);
      // The exponent, up to 87, carries three roundings in either; at the joint of the fit G1 jumps by the 6e-5 by which it
      // would pass 1, once for each direction.
      const double expected = coating.eval(wi).f().x;
      ASSERT_NEAR(facets.eval(wi).f().x, expected, (2.0 * 3.0 * 87.0 * kUlp + 2.0 * 1.3e-4) * expected);
    }
}

TEST(Microfacet, ConductorMatchesComplexArithmetic) {
  Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const float c = random.uniform(), n = 3.0f * random.uniform(), kappa = 6.0f * random.uniform();
    const std::complex<double> index(n, kappa), sin2(1.0 - double{c} * c), g = std::sqrt(index * index - sin2);
    const std::complex<double> rs = (double{c} - g) / (double{c} + g),
                               rp = (index * index * double{c} - g) / (index * index * double{c} + g);
    // Differences of numbers up to n^2 + k^2 = 45 next to results of 1e-2 and more in float.
    ASSERT_NEAR(fresnel_conductor(c, n, kappa), 0.5 * (std::norm(rs) + std::norm(rp)), 2e-4) << c << " " << n << " " << kappa;
  }
}

TEST(Microfacet, F82HoldsItsTintAtTheEdge) {
  Lobe lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), 0.1f, 0.1f, Rules::Blender45);
  const glm::vec3 f0(0.9f, 0.5f, 0.1f), tint(1.0f, 0.5f, 0.25f);
  set_f82(lobe, f0, tint);
  const float c = 1.0f / 7.0f, fifth = std::pow(6.0f / 7.0f, 5.0f);
  const glm::vec3 at_edge = facet_response(lobe, c).reflected;
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(at_edge[i], tint[i] * (f0[i] + (1.0f - f0[i]) * fifth), 16.0 * kUlp);
  EXPECT_EQ(facet_response(lobe, 1.0f).reflected, f0);
}

TEST(Microfacet, AlbedoTablesHoldExactIntegrals) {
  // Entries are rounded to 2^-17; the quadrature and the floats leave 2e-5 for each side of the surface.
  for (int y : {1, 8, 20, 31})
    for (int x : {6, 15, 31}) {
      const float cosine = static_cast<float>(y) / 31.0f, roughness = static_cast<float>(x) / 31.0f;
      const Bsdf bsdf = seen({rough(LobeKind::Glossy, Facets::Ggx, roughness)}, direction(cosine));
      EXPECT_NEAR(ggx_albedo(roughness, cosine), reflected(bsdf, roughness * roughness), 3e-5) << cosine << " " << roughness;
    }
  for (int y : {3, 9, 15})
    for (int x : {5, 10, 15})
      for (int z : {3, 7, 11}) {
        const float cosine = static_cast<float>(y) / 15.0f, roughness = static_cast<float>(x) / 15.0f;
        const float r = static_cast<float>(z * z) / 225.0f, ior = (1.0f + r) / (1.0f - r);
        const Bsdf outside = seen({rough(LobeKind::Glass, Facets::Ggx, roughness, ior)}, direction(cosine));
        EXPECT_NEAR(glass_albedo(roughness, cosine, ior),
                    reflected(outside, roughness * roughness) + through(outside, roughness * roughness, ior), 5e-5)
            << cosine << " " << roughness << " " << ior;
      }
}

TEST(Microfacet, MeanAlbedoIsThatOfAWhiteSky) {
  for (int x : {6, 18, 31}) {
    const float roughness = static_cast<float>(x) / 31.0f;
    double sum = 0.0;
    // Midpoints of 256 cosines; the albedo is smooth but for its last bend at the horizon, which weighs 1 / 256^2.
    for (int i = 0; i < 256; ++i) {
      const double c = (i + 0.5) / 256.0;
      sum += 2.0 * c / 256.0 * ggx_albedo(roughness, static_cast<float>(c));
    }
    // Straight lines between the table's 32 cosines stay below the curve by up to 1e-3.
    EXPECT_NEAR(ggx_mean_albedo(roughness), sum, 1e-3) << roughness;
  }
}

TEST(Microfacet, MixIsTheMeanOverFacetsThatReflect) {
  // Drawn facets, of which those that send light below the surface count 0.
  Random random(4);
  constexpr int draws = 200000;
  for (int y : {2, 8, 15})
    for (int x : {4, 9, 15})
      for (int z : {4, 8}) {
        const float cosine = static_cast<float>(y) / 15.0f, roughness = static_cast<float>(x) / 15.0f;
        const float r = static_cast<float>(z * z) / 225.0f, ior = (1.0f + r) / (1.0f - r), alpha = roughness * roughness;
        const glm::vec3 wo = direction(cosine);
        double sum = 0.0, sum2 = 0.0;
        for (int k = 0; k < draws; ++k) {
          const float u = random.uniform(), v = random.uniform();
          const glm::vec3 h = ggx_sample_visible(wo, alpha, alpha, {u, v});
          const float f0 = f0_of_ior(ior), f = fresnel_dielectric(glm::dot(wo, h), ior);
          const double s = reflect_about(wo, h).z > 0.0f ? (f - f0) / (1.0f - f0) : 0.0;
          sum += s;
          sum2 += s * s;
        }
        const double mean = sum / draws, deviation = std::sqrt((sum2 / draws - mean * mean) / draws + 1e-12);
        // The table's rounding stands beside the noise.
        const double p = testing::normal_p_value((mean - dielectric_mix(roughness, cosine, ior)) / (deviation + 0x1p-17));
        EXPECT_GT(p, testing::sidak_level(testing::kSignificance, 18)) << cosine << " " << roughness << " " << ior;
      }
}

TEST(Microfacet, NoLobeScattersMoreThanItGets) {
  for (double cosine : {1.0, 0.5, 0.1})
    for (float roughness : {0.1f, 0.5f, 1.0f}) {
      const double alpha = roughness * roughness;
      for (Facets facets : {Facets::Ggx, Facets::Beckmann})
        for (Rules rules : {Rules::Blender3, Rules::Blender45}) {
          LobeInputs glossy = rough(LobeKind::Glossy, facets, roughness);
          glossy.rules = rules;
          // Quadrature and floats; Beckmann's rational masking may miss the exact one by 0.35 %.
          const double slack = facets == Facets::Ggx ? 2e-5 : 0.0035;
          EXPECT_LE(reflected(seen({glossy}, direction(cosine)), alpha), 1.0 + slack) << cosine << " " << roughness;
        }
      for (float ior : {1.5f, 0.8f}) {
        const Bsdf glass = seen({rough(LobeKind::Glass, Facets::Ggx, roughness, ior)}, direction(cosine));
        EXPECT_LE(reflected(glass, alpha) + through(glass, alpha, ior), 1.0 + 2e-5) << cosine << " " << roughness << " " << ior;
      }
    }
}

TEST(Microfacet, MultipleScatteringLosesNothing) {
  // Between its nodes the table is a straight line: for roughness below 0.25 and at the horizon the albedo bends by more than
  // 1 % within a cell, elsewhere by less than 0.3 %. At the nodes nothing but rounding is left.
  for (int y : {4, 16, 31})
    for (int x : {8, 16, 31}) {
      const float cosine = static_cast<float>(y) / 31.0f, roughness = static_cast<float>(x) / 31.0f;
      const Bsdf bsdf = seen({rough(LobeKind::Glossy, Facets::MultiGgx, roughness)}, direction(cosine));
      EXPECT_NEAR(reflected(bsdf, roughness * roughness), 1.0, 6e-5) << cosine << " " << roughness;
    }
  Random random(8);
  for (int k = 0; k < 40; ++k) {
    const float roughness = 0.3f + 0.7f * random.uniform(), cosine = 0.15f + 0.85f * random.uniform();
    const Bsdf bsdf = seen({rough(LobeKind::Glossy, Facets::MultiGgx, roughness)}, direction(cosine));
    EXPECT_NEAR(reflected(bsdf, roughness * roughness), 1.0, 3e-3) << cosine << " " << roughness;
  }
}

TEST(Microfacet, FurtherBouncesTakeTheColour) {
  LobeInputs inputs = rough(LobeKind::Glossy, Facets::MultiGgx, 1.0f);
  inputs.color = glm::vec3(0.5f);
  const Bsdf bsdf = seen({inputs}, direction(1.0));
  const double e = ggx_albedo(1.0f, 1.0f), mean = ggx_mean_albedo(1.0f), f = 0.5;
  // One bounce f E, all further ones f (1 - E) times f mean / (1 - f (1 - mean)).
  const double expected = f * (e + (1.0 - e) * f * mean / (1.0 - f * (1.0 - mean)));
  EXPECT_NEAR(reflected(bsdf, 1.0), expected, 5e-5);
}

TEST(Microfacet, IsReciprocal) {
  Random random(5);
  for (float roughness : {0.3f, 0.7f, 1.0f})
    for (Facets facets : {Facets::Ggx, Facets::Beckmann})
      for (int k = 0; k < 1000; ++k) {
        const std::vector<LobeInputs> glossy{rough(LobeKind::Glossy, facets, roughness)};
        const glm::vec3 wo = direction(0.1 + 0.9 * random.uniform(), 7.0 * random.uniform()),
                        wi = direction(0.1 + 0.9 * random.uniform(), 7.0 * random.uniform());
        // |wo + wi| >= 0.2 and |wo + 1.5 wi'| >= 0.5: half vectors carry 2^-22 over that, 1.2e-6 at most. Where they lean by
        // less than 60 degrees that is 4.8e-6 of slope, and Beckmann's exponent s^2, s <= 9.3 widths, moves by 2 s / alpha
        // times it.
        const double tolerance = 2.0 * 9.3 * 4.8e-6 / (roughness * roughness);
        const double forth = seen(glossy, wo).eval(wi).f().x / wi.z, back = seen(glossy, wi).eval(wo).f().x / wo.z;
        if (glm::normalize(wo + wi).z > 0.5f) {
          ASSERT_NEAR(forth, back, tolerance * forth + std::numeric_limits<float>::min());
        }
        // Through glass: f from outside is eta^2 of that from inside, for radiance that is not scaled at the boundary.
        const std::vector<LobeInputs> glass{rough(LobeKind::Glass, facets, roughness)};
        const glm::vec3 under = wi * glm::vec3(1.0f, 1.0f, -1.0f);
        const double in = seen(glass, wo).eval(under).f().x / wi.z, out = seen(glass, under).eval(wo).f().x / wo.z;
        const glm::vec3 h = glm::normalize(-(wo + 1.5f * under));
        // Near total reflection what goes through follows the root of the rounding.
        if (h.z > 0.5f && glm::dot(wo, h) > 0.1f) {
          ASSERT_NEAR(in, 2.25 * out, tolerance * in + std::numeric_limits<float>::min());
        }
      }
}

TEST(Microfacet, SmoothGlassIsTheDielectric) {
  for (float ior : {0.8f, 1.0f, 1.0f + 0x1p-23f, 1.5f, 3.0f})
    for (double cosine : {1.0, 0.4, -0.4, -0.9})
      for (float u : {0.0f, 0.3f, 0.9f}) {
        const Bsdf facets = seen({rough(LobeKind::Glass, Facets::MultiGgx, 0.0f, ior)}, direction(cosine));
        const Bsdf smooth = seen({described(LobeKind::Dielectric, 0.0f, ior)}, direction(cosine));
        const BsdfSample a = facets.sample(u, {0.5f, 0.5f}), b = smooth.sample(u, {0.5f, 0.5f});
        EXPECT_EQ(a.wi, b.wi);
        EXPECT_TRUE(a.delta && !facets.smooth);
        EXPECT_EQ(a.transmitted, b.transmitted);
        EXPECT_EQ(a.component, b.component);
        // F passes through the mix of f0 and f90 and back.
        EXPECT_NEAR(a.weight.x, 1.0f, 8.0 * kUlp);
        EXPECT_NEAR(a.pdf, b.pdf, 8.0 * kUlp);
      }
}

TEST(Microfacet, IndexOneIsNotThere) {
  const Bsdf bsdf = seen({rough(LobeKind::Glass, Facets::Ggx, 0.7f, 1.0f)}, direction(0.3));
  const BsdfSample sample = bsdf.sample(0.5f, {0.3f, 0.7f});
  EXPECT_EQ(sample.wi, -direction(0.3));
  EXPECT_EQ(sample.weight.x, 1.0f);
  EXPECT_TRUE(sample.delta && sample.transmitted);
}

TEST(Microfacet, ComponentsTellReflectionFromTransmission) {
  const Bsdf glass = seen({rough(LobeKind::Glass, Facets::Ggx, 0.5f)}, direction(0.5));
  const BsdfValue up = glass.eval(direction(0.6, 4.0)), down = glass.eval(-direction(0.9));
  EXPECT_GT(up.part[1].x, 0.0f);
  EXPECT_EQ(up.part[1], up.f());
  EXPECT_GT(down.part[2].x, 0.0f);
  EXPECT_EQ(down.part[2], down.f());
  EXPECT_GT(glass.shown(Component::Glossy).x, 0.0f);
  EXPECT_NEAR(glass.shown(Component::Glossy).x + glass.shown(Component::Transmission).x, glass.albedo().x, 2.0 * kUlp);
  Random random(9);
  for (int k = 0; k < 200; ++k) {
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    const BsdfSample sample = glass.sample(u, {x, y});
    if (!(sample.pdf > 0.0f))
      continue;
    EXPECT_EQ(sample.component, sample.transmitted ? Component::Transmission : Component::Glossy);
    EXPECT_EQ(sample.share[1].x, sample.transmitted ? 0.0f : 1.0f);
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
            LobeInputs inputs = rough(kind, facets, roughness, ior);
            inputs.anisotropy = anisotropy;
            inputs.option = 1;
            for (double c : cosines)
              for (double sign : {1.0, -1.0}) {
                const Bsdf bsdf = seen({inputs}, direction(c * sign));
                ASSERT_TRUE(finite(bsdf.albedo())) << static_cast<int>(kind) << " " << roughness << " " << ior << " " << c;
                for (double ci : cosines)
                  for (double side : {1.0, -1.0}) {
                    const BsdfValue value = bsdf.eval(direction(ci * side, 0.8 + std::numbers::pi));
                    ASSERT_TRUE(finite(value.f()) && value.f().x >= 0.0f && value.pdf >= 0.0f && std::isfinite(value.pdf))
                        << static_cast<int>(kind) << " " << static_cast<int>(facets) << " " << roughness << " " << ior << " "
                        << anisotropy << " " << c << " " << ci << " " << side;
                  }
                for (float x : corners)
                  for (float y : corners) {
                    const BsdfSample sample = bsdf.sample(x, {y, x});
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
