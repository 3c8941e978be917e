// Blender's rough lobes: closed forms, tables against exact integrals, and limits.
#include "bsdf/bsdf.h"

#include <complex>
#include <gtest/gtest.h>
#include <limits>

#include "bsdf/albedo_tables.h"
#include "bsdf/microfacet.h"
#include "bsdf_facets.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::kUlp;
using testing::Random;
using testing::reflected;
using testing::rough;
using testing::seen;
using testing::through;

const float kInfinity = std::numeric_limits<float>::infinity();

TEST(Microfacet, GgxMatchesItsTextbookForm) {
  // D = a^2 / (pi ((n.h)^2 (a^2 - 1) + 1)^2) and G = 2 n.o n.i / (n.o sqrt(a^2 + (1 - a^2) (n.i)^2) + the same exchanged), in
  // long double from the same floats. wo + wi rounds by an ulp of 1 and more, which at slopes up to 4 alpha moves D by 16 /
  // alpha of this; the other factors round some 40 times.
  Random random(1);
  for (float alpha : {1e-3f, 0.05f, 0.4f, 1.0f})
    for (int k = 0; k < 200; ++k) {
      const glm::vec3 wo = direction(0.3 + 0.7 * random.uniform());
      const float x = random.uniform(), y = random.uniform();
      const Bsdf<float> bsdf = seen({rough(LobeKind::Glossy, Facets::Ggx, std::sqrt(alpha))}, wo);
      const BsdfSample<float> sample = bsdf.sample(0.5f, 0.9f * x, y);
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
      LobeInputs<float> inputs = rough(LobeKind::Glossy, Facets::Beckmann, roughness);
      inputs.rules = Rules::Blender3;
      const glm::vec3 wo = direction(0.05 + 0.95 * random.uniform()), wi = direction(0.05 + 0.95 * random.uniform(), 4.0);
      const Bsdf<float> facets = seen({inputs}, wo);
      const Bsdf<float> coating = seen({described(LobeKind::Beckmann, facets.lobes[0].alpha_x, kInfinity)}, wo);
      // Facets visible from both directions are at most those visible from either, exactly.
      float fitted = 1.0f, exact = 1.0f;
      for (const glm::vec3 &w : {wo, wi}) {
        const float at = beckmann_a(w, facets.lobes[0].alpha_x);
        fitted *= beckmann_g1(at);
        exact = std::min(exact, beckmann_g1_exact(at));
      }
      const double expected = double{coating.eval(wi).f().x} * std::min(1.0, double{exact} / double{fitted});
      // The exponent, up to 87, has three roundings in either; at the joint of the fit G1 jumps by the 6e-5 by which it would
      // exceed 1, once for each direction.
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
    // Differences of numbers up to n^2 + k^2 = 45 next to results of at least 1e-2 in float.
    ASSERT_NEAR(fresnel_conductor(c, n, kappa), 0.5 * (std::norm(rs) + std::norm(rp)), 2e-4) << c << " " << n << " " << kappa;
  }
}

TEST(Microfacet, StrongConductorIsExactAtNormalIncidenceAndForStrongAbsorption) {
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const float c = random.uniform(), n = 3.0f * random.uniform(), kappa = 6.0f * random.uniform();
    ASSERT_NEAR(fresnel_strong_conductor(1.0f, n, kappa), fresnel_conductor(1.0f, n, kappa), 2e-4) << n << " " << kappa;
    // The approximation leaves out sin^2 beside (n + i k)^2, at most a share 1 / (n^2 + k^2) of it, to first order of the
    // reflectance's distance from 1.
    const float strong = 40.0f + kappa, size = n * n + strong * strong;
    ASSERT_NEAR(fresnel_strong_conductor(c, n, strong), fresnel_conductor(c, n, strong), 4.0f / size) << n << " " << strong;
  }
}

TEST(Microfacet, F82HoldsItsTintAtTheEdge) {
  Lobe<float> lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), 0.1f, 0.1f, Rules::Blender45);
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
      const Bsdf<float> bsdf = seen({rough(LobeKind::Glossy, Facets::Ggx, roughness)}, direction(cosine));
      EXPECT_NEAR(ggx_albedo(roughness, cosine), reflected(bsdf, roughness * roughness), 3e-5) << cosine << " " << roughness;
    }
  for (int y : {3, 9, 15})
    for (int x : {5, 10, 15})
      for (int z : {3, 7, 11}) {
        const float cosine = static_cast<float>(y) / 15.0f, roughness = static_cast<float>(x) / 15.0f;
        const float r = static_cast<float>(z * z) / 225.0f, ior = (1.0f + r) / (1.0f - r);
        const Bsdf<float> outside = seen({rough(LobeKind::Glass, Facets::Ggx, roughness, ior)}, direction(cosine));
        EXPECT_NEAR(glass_albedo(roughness, cosine, ior),
                    reflected(outside, roughness * roughness) + through(outside, roughness * roughness, ior), 5e-5)
            << cosine << " " << roughness << " " << ior;
      }
}

TEST(Microfacet, MeanAlbedoIsThatOfAWhiteSky) {
  for (int x : {6, 18, 31}) {
    const float roughness = static_cast<float>(x) / 31.0f;
    double sum = 0.0;
    // Midpoints of 256 cosines; the albedo is smooth except for its bend at the horizon, which has a weight of 1 / 256^2.
    for (int i = 0; i < 256; ++i) {
      const double c = (i + 0.5) / 256.0;
      sum += 2.0 * c / 256.0 * ggx_albedo(roughness, static_cast<float>(c));
    }
    // Linear interpolation between the table's 32 cosines is below the curve by up to 1e-3.
    EXPECT_NEAR(ggx_mean_albedo(roughness), sum, 1e-3) << roughness;
  }
}

TEST(Microfacet, MixIsTheMeanOverFacetsThatReflect) {
  // Sampled facets; those that send light below the surface count 0.
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
          const glm::vec3 h = ggx_sample_visible(wo, alpha, alpha, u, v);
          const float f0 = f0_of_ior(ior), f = fresnel_dielectric(glm::dot(wo, h), ior);
          const double s = reflect_about(wo, h).z > 0.0f ? (f - f0) / (1.0f - f0) : 0.0;
          sum += s;
          sum2 += s * s;
        }
        const double mean = sum / draws, deviation = std::sqrt((sum2 / draws - mean * mean) / draws + 1e-12);
        // The table's rounding adds to the noise.
        const double p = testing::normal_p_value((mean - dielectric_mix(roughness, cosine, ior)) / (deviation + 0x1p-17));
        EXPECT_GT(p, testing::sidak_level(testing::kSignificance, 18)) << cosine << " " << roughness << " " << ior;
      }
}

TEST(Microfacet, SmoothGlassIsTheDielectric) {
  for (float ior : {0.8f, 1.0f, 1.0f + 0x1p-23f, 1.5f, 3.0f})
    for (double cosine : {1.0, 0.4, -0.4, -0.9})
      for (float u : {0.0f, 0.3f, 0.9f}) {
        const Bsdf<float> facets = seen({rough(LobeKind::Glass, Facets::MultiGgx, 0.0f, ior)}, direction(cosine));
        const Bsdf<float> smooth = seen({described(LobeKind::Dielectric, 0.0f, ior)}, direction(cosine));
        const BsdfSample<float> a = facets.sample(u, 0.5f, 0.5f), b = smooth.sample(u, 0.5f, 0.5f);
        EXPECT_EQ(a.wi, b.wi);
        EXPECT_TRUE(a.delta && !facets.smooth);
        EXPECT_EQ(a.transmitted, b.transmitted);
        EXPECT_EQ(a.component, b.component);
        // F is converted to the mix of f0 and f90 and back.
        EXPECT_NEAR(a.weight.x, 1.0f, 8.0 * kUlp);
        EXPECT_NEAR(a.pdf, b.pdf, 8.0 * kUlp);
      }
}

TEST(Microfacet, RoughnessBeyondItsRange) {
  // Nodes may return any number. Most lobes clamp it; Refraction squares it first.
  const auto alpha = [](LobeKind kind, float roughness) {
    return seen({rough(kind, Facets::Ggx, roughness)}, direction(0.5)).lobes[0].alpha_x;
  };
  for (LobeKind kind : {LobeKind::Glossy, LobeKind::Glass, LobeKind::Conductor, LobeKind::Refraction}) {
    EXPECT_EQ(alpha(kind, -0.5f), kind == LobeKind::Refraction ? 0.25f : 0.0f);
    EXPECT_EQ(alpha(kind, 0.5f), 0.25f);
    EXPECT_EQ(alpha(kind, 1.5f), 1.0f);
  }
}

TEST(Microfacet, IndexOneIsNotThere) {
  const Bsdf<float> bsdf = seen({rough(LobeKind::Glass, Facets::Ggx, 0.7f, 1.0f)}, direction(0.3));
  const BsdfSample<float> sample = bsdf.sample(0.5f, 0.3f, 0.7f);
  EXPECT_EQ(sample.wi, -direction(0.3));
  EXPECT_EQ(sample.weight.x, 1.0f);
  EXPECT_TRUE(sample.delta && sample.transmitted);
}

TEST(Microfacet, ComponentsTellReflectionFromTransmission) {
  const Bsdf<float> glass = seen({rough(LobeKind::Glass, Facets::Ggx, 0.5f)}, direction(0.5));
  const BsdfValue<float> up = glass.eval(direction(0.6, 4.0)), down = glass.eval(-direction(0.9));
  EXPECT_GT(up.part[1].x, 0.0f);
  EXPECT_EQ(up.part[1], up.f());
  EXPECT_GT(down.part[2].x, 0.0f);
  EXPECT_EQ(down.part[2], down.f());
  EXPECT_GT(glass.shown(Component::Glossy).x, 0.0f);
  EXPECT_NEAR(glass.shown(Component::Glossy).x + glass.shown(Component::Transmission).x, glass.albedo().x, 2.0 * kUlp);
  Random random(9);
  for (int k = 0; k < 200; ++k) {
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    const BsdfSample<float> sample = glass.sample(u, x, y);
    if (!(sample.pdf > 0.0f))
      continue;
    EXPECT_EQ(sample.component, sample.transmitted ? Component::Transmission : Component::Glossy);
    EXPECT_EQ(sample.share[1].x, sample.transmitted ? 0.0f : 1.0f);
  }
}

// A black edge colour makes a smooth metal black at cos 1 / 7; since 5.2 the facets' mean is its albedo there, too.
TEST(Microfacet, BlackEdgesOfMetalsReflectInTheMean) {
  const auto albedo = [](Rules rules) {
    LobeInputs<float> metal = rough(LobeKind::Conductor, Facets::Ggx, 0.3f);
    metal.color = glm::vec3(0.05f);
    metal.edge = glm::vec3(0.0f);
    metal.rules = rules;
    return seen({metal}, direction(1.0 / 7.0)).albedo().x;
  };
  EXPECT_EQ(albedo(Rules::Blender50), 0.0f);
  EXPECT_GT(albedo(Rules::Blender52), 0.05f);
}

// Since 5.2 the colour passes of glass show means over the facets, of either side of the same boundary.
TEST(Microfacet, TransmittedColourIsThatOfBothSides) {
  const auto shown = [](float ior, float cosine) {
    LobeInputs<float> glass = rough(LobeKind::Glass, Facets::Ggx, 0.3f, ior);
    glass.rules = Rules::Blender52;
    return seen({glass}, direction(cosine)).shown(Component::Transmission).x;
  };
  for (float cosine : {0.1f, 0.5f, 0.9f})
    EXPECT_NEAR(shown(1.5f, cosine), shown(1.0f / 1.5f, cosine), 8.0 * kUlp) << cosine;
  const Bsdf<float> mirror = seen({rough(LobeKind::Glossy, Facets::Ggx, 0.3f)}, direction(0.5));
  EXPECT_EQ(mirror.shown(Component::Transmission), glm::vec3(0.0f));
}

} // namespace
} // namespace lancer
