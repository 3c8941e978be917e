// Microfacet lobes over a grid of heights, roughnesses and indices: none has an albedo above 1, and the density of a direction
// is that of the facet that sends light there, which integrates to one.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "bsdf/microfacet_eval.h"
#include "bsdf_catalogue.h"
#include "bsdf_facets.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Known;
using testing::Random;

// Interpolates from low to high by equal factors.
double between(double low, double high, int i, int count) { return low * std::pow(high / low, i / (count - 1.0)); }

// Indices alternately above and below 1, from hardly refracting to hardly transmitting.
std::vector<float> indices(int count) {
  std::vector<float> all;
  for (int i = 0; i < count / 2; ++i) {
    const double beyond = 1.0 + between(0x1p-23, 1e19, i, count / 2);
    all.push_back(static_cast<float>(beyond));
    all.push_back(static_cast<float>(1.0 / beyond));
  }
  return all;
}

// Returns the albedo of a white lobe for wo: the integral of sample weights over the sampler's numbers. The integrand is
// bounded, and smooth except at the horizon.
double given_back(const Bsdf<float> &bsdf) {
  constexpr int kSide = 16;
  double sum = 0.0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      // Side numbers by the golden ratio, which are uniform over any range.
      const double side = std::fmod(0.5 + 0.6180339887498949 * (i * kSide + j), 1.0);
      const BsdfSample<float> sample =
          bsdf.sample(float(side), (float(i) + 0.5f) / float(kSide), (float(j) + 0.5f) / float(kSide));
      if (sample.pdf > 0.0f)
        sum += double{std::max({sample.weight.x, sample.weight.y, sample.weight.z})};
    }
  return sum / (kSide * kSide);
}

struct Kind {
  const char *name;
  LobeKind kind;
  Facets facets;
  bool bends = false; // depends on the index
  float anisotropy = 0.0f;
};
constexpr Kind kKinds[] = {{"coating", LobeKind::Beckmann, Facets::Beckmann, true},
                           {"glass", LobeKind::Glass, Facets::Ggx, true},
                           {"Beckmann glass", LobeKind::Glass, Facets::Beckmann, true},
                           {"refraction", LobeKind::Refraction, Facets::Ggx, true},
                           {"Beckmann refraction", LobeKind::Refraction, Facets::Beckmann, true},
                           {"GGX", LobeKind::Glossy, Facets::Ggx},
                           {"Beckmann", LobeKind::Glossy, Facets::Beckmann},
                           {"stretched GGX", LobeKind::Glossy, Facets::Ggx, false, 0.5f},
                           {"stretched Beckmann", LobeKind::Glossy, Facets::Beckmann, false, 0.5f},
                           {"Ashikhmin-Shirley", LobeKind::Glossy, Facets::AshikhminShirley},
                           {"metal", LobeKind::Conductor, Facets::Ggx},
                           {"Beckmann metal", LobeKind::Conductor, Facets::Beckmann}};

LobeInputs<float> inputs_of(const Kind &kind, double alpha, float ior) {
  LobeInputs<float> inputs = testing::at_alpha(kind.kind, kind.facets, alpha, ior);
  inputs.anisotropy = kind.anisotropy;
  if (kind.kind == LobeKind::Conductor)
    inputs.edge = glm::vec3(1.0f);
  return inputs;
}

TEST(BsdfGrid, FacetsGiveBackNoMoreThanTheyGet) {
  const int side = testing::slow() ? 64 : 12;
  for (const Kind &kind : kKinds)
    for (const float ior : kind.bends ? indices(testing::slow() ? 32 : 8) : std::vector<float>{1.5f})
      for (int a = 0; a < side; ++a)
        for (int c = 0; c < side; ++c) {
          const double alpha = between(2e-5, 1.0, a, side), cosine = between(1e-3, 1.0, c, side);
          const Bsdf<float> bsdf = testing::seen({inputs_of(kind, alpha, ior)}, direction(cosine));
          EXPECT_LE(given_back(bsdf), 1.0 + 1e-5) << kind.name << " " << ior << ", alpha " << alpha << " from " << cosine;
        }
}

TEST(BsdfGrid, VisibleFacetsIntegrateToOne) {
  for (const bool beckmann : {false, true})
    for (const double aspect : testing::slow() ? std::vector<double>{1.0, 0.25, 4.0} : std::vector<double>{1.0})
      for (const double alpha : {2e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.5, 0.7, 1.0})
        for (const double cosine : {1.0, 0.9, 0.5, 0.1, 1e-2, 1e-3}) {
          const glm::vec3 wo = direction(cosine);
          const float across = static_cast<float>(std::min(1.0, aspect * alpha));
          Lobe<float> lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), float(alpha), across, Rules::Blender45);
          lobe.beckmann = beckmann;
          const auto visible = [&](const glm::dvec2 &place) {
            double jacobian;
            const glm::dvec3 h = testing::half_vector_at(place, alpha, jacobian);
            const double cos_oh = glm::dot(glm::dvec3(wo), h);
            return cos_oh > 0.0 ? jacobian * cos_oh * double{facet_d(lobe, glm::vec3(h))} *
                                      double{facet_g1(lobe, wo, facet_hidden(lobe, wo))}
                                : 0.0;
          };
          EXPECT_NEAR(testing::integrate_square(visible, 32, 1e-8), 1.0, 1e-5)
              << beckmann << " " << alpha << " " << across << " " << cosine;
        }
}

// The density of visible facets integrates to one. If the density of directions is equal, scaled by the solid angle that facets
// span there, then it is the probability of a sample, at any height and index.
TEST(BsdfGrid, DensitiesAreThoseOfTheFacets) {
  const int side = testing::slow() ? 64 : 12, facets = testing::slow() ? 64 : 16;
  Random random(3);
  long reflections = 0, refractions = 0;
  for (const Kind &kind : kKinds) {
    if (kind.kind == LobeKind::Beckmann || kind.facets == Facets::AshikhminShirley)
      continue;
    for (const float ior : kind.bends ? indices(testing::slow() ? 32 : 8) : std::vector<float>{1.5f})
      for (int a = 0; a < side; ++a)
        for (int c = 0; c < side; ++c) {
          const double alpha = between(2e-5, 1.0, a, side), cosine = between(1e-3, 1.0, c, side);
          const Bsdf<float> bsdf = testing::seen({inputs_of(kind, alpha, ior)}, direction(cosine));
          const Lobe<float> &lobe = bsdf.lobes[0];
          const glm::vec3 &wo = bsdf.wo_local[lobe.frame];
          for (int k = 0; k < facets && !lobe.delta; ++k) {
            const float x = random.uniform(), y = random.uniform();
            const glm::vec3 h = lobe.beckmann ? beckmann_sample_visible(wo, lobe.alpha_x, lobe.alpha_y, x, y)
                                              : ggx_sample_visible(wo, lobe.alpha_x, lobe.alpha_y, x, y);
            const double cos_oh = glm::dot(wo, h);
            if (!(cos_oh > 0.0))
              continue;
            const FacetResponse<float> response = facet_response(lobe, float(cos_oh));
            const double visible = cos_oh * double{facet_d(lobe, h)} * double{facet_g1(lobe, wo, facet_hidden(lobe, wo))},
                         share = response.reflected_share();
            const auto what = [&] {
              return ::testing::Message() << kind.name << " " << ior << ", alpha " << alpha << " from " << cosine;
            };
            if (const glm::vec3 wi = reflect_about(wo, h); reflects(lobe) && wi.z > 0.0f) {
              const double spread = 4.0 * cos_oh * double{microfacet_eval_reflected(lobe, wo, wi, h).pdf};
              EXPECT_NEAR(spread, visible * share, 1e-5 * visible * share) << what();
              ++reflections;
            }
            if (!refracts(lobe) || lobe.delta_through || !(response.cos_t > 0.0f))
              continue;
            const glm::vec3 wi = testing::bent_about(wo, h, lobe.ior, response.cos_t);
            if (!(wi.z < 0.0f))
              continue;
            // The solid angle of wi spanned by that of a facet, without the difference of two nearly equal cosines.
            const double eta = lobe.ior, cos_t = response.cos_t,
                         stretch = (eta - 1.0) * (eta + 1.0) / (eta * (eta * cos_t + cos_oh)), per = stretch * stretch / cos_t,
                         got = per * double{microfacet_eval_through(lobe, wo, wi, h).pdf};
            // A float cosine has an error of six roundings: three in the sum of products, one and a half in the length of
            // either direction. By the law of refraction wi has this relative error, and the stretch, a sum of both, that of
            // its terms. The density is proportional to the former and to the square of the latter.
            const double bent = std::max(1.0, 1.0 / eta),
                         known_to = 1e-5 + 6.0 * 0x1p-24 * (bent * bent / (cos_t * cos_t) + 2.0 * bent / std::abs(stretch));
            EXPECT_NEAR(got, visible * (1.0 - share), known_to * visible * (1.0 - share)) << what();
            ++refractions;
          }
        }
  }
  EXPECT_GT(reflections, 10000);
  EXPECT_GT(refractions, 10000);
}

} // namespace
} // namespace lancer
