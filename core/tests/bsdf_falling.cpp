// Samplers against densities at every roughness and height: the p-values of chi-square tests must be uniformly distributed.
#include <gtest/gtest.h>
#include <limits>

#include "bsdf/microfacet_eval.h"
#include "bsdf_catalogue.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Known;
using testing::Random;

constexpr int kSide = 16, kCells = kSide * kSide;

std::size_t cell_of(const glm::dvec2 &place) {
  const auto index = [](double x) { return static_cast<std::size_t>(std::clamp(x * kSide, 0.0, kSide - 1.0)); };
  return index(place.x) * kSide + index(place.y);
}

// Computes the expected counts of cells of a square, each to a small part of its own noise, which is 3 for the rarest cell that
// counts.
void expect_cells(const testing::SquareFunction &density, double draws, std::vector<double> &expected) {
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const glm::dvec2 low = glm::dvec2(i, j) / double{kSide}, high = glm::dvec2(i + 1, j + 1) / double{kSide};
      // A sliver of a cell can fall between the nodes: no cell counts as impossible, and a million samples need more nodes,
      // which detect a horizon along a hundredth of a cell.
      const double share = testing::integrate_square(density, testing::slow() ? 8 : 1, 0.2 / draws, low, high);
      expected.push_back(std::max(1e-3, draws * share));
    }
}

// p-values of correct samplers are uniform in 0 ... 1 for any lobe: no single one may be rare, nor all of them too good.
void judge_all(const std::vector<double> &p_values, const std::vector<std::string> &names) {
  const double level = testing::sidak_level(testing::kSignificance, p_values.size());
  for (std::size_t i = 0; i < p_values.size(); ++i)
    EXPECT_GT(p_values[i], level) << names[i];
  EXPECT_GT(testing::uniformity_p_value(p_values), testing::kSignificance);
}

// Facets visible from wo, by slope: resolved at any roughness, like the sampler's own half vector.
struct Facet {
  const char *name;
  bool beckmann;
  double aspect; // alpha_y / alpha_x
};
constexpr Facet kFacets[] = {
    {"GGX", false, 1.0}, {"Beckmann", true, 1.0}, {"stretched GGX", false, 0.25}, {"stretched Beckmann", true, 4.0}};

double p_of_facets(const Facet &facet, double alpha, double cosine, int draws, uint64_t seed, double wrong = 1.0) {
  const glm::vec3 wo = direction(cosine);
  Lobe<float> lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), float(alpha),
                                     float(std::min(1.0, facet.aspect * alpha)), Rules::Blender45);
  lobe.beckmann = facet.beckmann;
  const auto place = [&](const glm::vec3 &h) {
    return glm::dvec2(testing::slope_to_x(std::hypot(double{h.x}, double{h.y}) / h.z, alpha), testing::turn(h.y, h.x));
  };
  const auto density = [&](const glm::dvec2 &at) {
    double jacobian;
    const glm::dvec3 h = testing::half_vector_at(at, alpha, jacobian);
    const double cos_oh = glm::dot(glm::dvec3(wo), h);
    return cos_oh > 0.0
               ? jacobian * cos_oh * double{facet_d(lobe, glm::vec3(h))} * double{facet_g1(lobe, wo, facet_hidden(lobe, wo))}
               : 0.0;
  };
  std::vector<double> expected, observed(kCells, 0.0);
  expect_cells(density, draws, expected);
  Random random(seed);
  const float alpha_x = lobe.alpha_x * float(wrong), alpha_y = lobe.alpha_y;
  for (int k = 0; k < draws; ++k) {
    const float x = random.uniform(), y = random.uniform();
    const glm::vec3 h =
        facet.beckmann ? beckmann_sample_visible(wo, alpha_x, alpha_y, x, y) : ggx_sample_visible(wo, alpha_x, alpha_y, x, y);
    observed[cell_of(place(h))] += 1.0;
  }
  return testing::chi_square_test(observed, expected);
}

TEST(BsdfFalling, FacetsAsTheyAreSeen) {
  const int draws = testing::slow() ? 10000000 : 40000;
  std::vector<double> p_values;
  std::vector<std::string> names;
  uint64_t seed = 1;
  for (const Facet &facet : kFacets)
    for (const double alpha : {2e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.5, 0.7, 1.0})
      for (const double cosine : {1.0, 0.9, 0.5, 0.1, 1e-2, 1e-3}) {
        p_values.push_back(p_of_facets(facet, alpha, cosine, draws, seed++));
        names.push_back(std::string(facet.name) + " " + std::to_string(alpha) + " from " + std::to_string(cosine));
      }
  judge_all(p_values, names);
}

TEST(BsdfFalling, ASmallErrorIsSeenAtEveryRoughness) {
  // Five percent of the width moves some 3 % of the mass: with 100 000 samples ten times the noise of any cell.
  for (const Facet &facet : kFacets)
    for (const double alpha : {2e-5, 1e-3, 0.5})
      for (const double cosine : {0.9, 1e-3})
        EXPECT_LT(p_of_facets(facet, alpha, cosine, 100000, 7, 0.95), 1e-6) << facet.name << " " << alpha << " " << cosine;
}

// Directions of whole surfaces, above and below, each side parametrised by its own square.
struct Sides {
  testing::Domain above, below;

  Sides(const Known &lobe, const glm::vec3 &wo)
      : above(lobe.width > 0.0 ? testing::half_vector_domain(wo, lobe.width) : testing::direction_domain()),
        below(lobe.width > 0.0 && lobe.ior != 1.0f ? testing::bent_domain(wo, lobe.width, lobe.ior) : testing::below_domain()) {
  }
  std::size_t cell(const glm::vec3 &wi) const {
    return wi.z > 0.0f ? cell_of(above.place(wi)) : kCells + cell_of(below.place(wi));
  }
};

// Returns the number of samples that half vectors of float directions allow: their error is 2^-24 over |wo + wi|, and a cell, a
// tenth of the width across, must change by no more than half the noise of its count.
double most_draws(const Known &lobe, double cosine) {
  if (lobe.width == 0.0)
    return std::numeric_limits<double>::infinity();
  const double share = 0x1p-24 / (2.0 * cosine) / (0.1 * lobe.width);
  return kCells * 0.25 / (share * share);
}

double p_of_directions(const Known &lobe, double cosine, int draws, uint64_t seed) {
  const glm::vec3 wo = direction(cosine);
  const Bsdf<float> bsdf = lobe.from(wo);
  const Sides sides(lobe, wo);
  std::vector<double> expected, observed(2 * kCells + 1, 0.0);
  for (const testing::Domain *domain : {&sides.above, &sides.below})
    expect_cells(domain->density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).pdf}; }), draws, expected);
  // Single directions and the loss at the horizon form one more cell.
  double rest = draws;
  for (const double part : expected)
    rest -= part;
  expected.push_back(std::max(1e-3, rest));
  Random random(seed);
  for (int k = 0; k < draws; ++k) {
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    const BsdfSample<float> sample = bsdf.sample(u, x, y);
    observed[sample.delta || !(sample.pdf > 0.0f) ? 2 * kCells : sides.cell(sample.wi)] += 1.0;
  }
  return testing::chi_square_test(observed, expected);
}

TEST(BsdfFalling, EveryLobeAsItsDensitySays) {
  constexpr double kFewest = 30000.0;
  const double wanted = testing::slow() ? 1e6 : kFewest;
  std::vector<double> p_values;
  std::vector<std::string> names;
  uint64_t seed = 1000;
  for (const double alpha : testing::roughnesses())
    for (const Known &lobe : testing::all_lobes(alpha))
      for (const double cosine : testing::heights()) {
        const double draws = std::min(wanted, most_draws(lobe, cosine));
        if (draws < kFewest)
          continue;
        p_values.push_back(p_of_directions(lobe, cosine, int(draws), seed++));
        names.push_back(lobe.name + " from " + std::to_string(cosine));
      }
  judge_all(p_values, names);
}

} // namespace
} // namespace lancer
