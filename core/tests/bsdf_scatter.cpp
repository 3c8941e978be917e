// Lobes that may transmit, anisotropic and tilted ones: samples are distributed as the pdf, and weights sum to the integral.
#include "bsdf/bsdf.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;

constexpr int kDraws = 32000, kSide = 16, kCells = kSide * kSide;

LobeInputs<float> rough(LobeKind kind, Facets facets, float roughness, float ior = 1.5f, float anisotropy = 0.0f) {
  LobeInputs<float> inputs = described(kind, roughness, ior, 0.0f, {0.9f, 0.6f, 0.3f});
  inputs.distribution = facets;
  inputs.anisotropy = anisotropy;
  inputs.rotation = 0.1f;
  inputs.tangent = {1.0f, 0.0f, 0.0f};
  return inputs;
}

struct Case {
  std::string name;
  std::vector<LobeInputs<float>> lobes;
  double width = 0.0; // of the narrowest lobe, in slopes of the half vector; 0: wide
  float ior = 1.5f;   // index of refraction from outside
  // The shading normal and a lobe's own normal, relative to the surface.
  glm::vec3 ns{0.0f, 0.0f, 1.0f};
  // The lobe that keeps its own samples beyond ns: above the surface, and below.
  int beyond = -1, beneath = -1;
  // Some directions cross the surface to the wrong side.
  bool strays = false;

  int drawn(const glm::vec3 &wi) const { return wi.z > 0.0f ? beyond : beneath; }

  // Only lobes with an index of refraction distinguish the inside.
  bool has_inside() const {
    return std::ranges::any_of(
        lobes, [](const LobeInputs<float> &lobe) { return lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Refraction; });
  }
};

// Directions above and below the plane, each side parametrised by its own square.
struct Sides {
  testing::Domain above, below;

  Sides(const Case &c, const glm::vec3 &wo, float eta)
      : above(c.width > 0.0 ? testing::half_vector_domain(wo, c.width) : testing::direction_domain()),
        below(c.width > 0.0 && eta != 1.0f ? testing::bent_domain(wo, c.width, eta) : testing::below_domain()) {}

  std::size_t cell(const glm::vec3 &wi) const {
    const glm::dvec2 place = wi.z > 0.0f ? above.place(wi) : below.place(wi);
    const auto index = [](double x) { return static_cast<std::size_t>(std::clamp(x * kSide, 0.0, kSide - 1.0)); };
    return (wi.z > 0.0f ? 0 : kCells) + index(place.x) * kSide + index(place.y);
  }
};

struct Verdict {
  double p = 0.0;        // chi-square of directions and rejected samples
  double weight_p = 0.0; // z-test of the mean weight against the part of the integral of f cos that samples find
};

// wo is above the plane, in the case's own frame: inside flips the surface.
Verdict judge(const Case &c, const glm::vec3 &wo, bool inside, uint64_t seed, const Case *expected_case = nullptr) {
  const auto look = [&](Bsdf<float> &bsdf, const Case &as) {
    const glm::vec3 ng(0.0f, 0.0f, 1.0f);
    bsdf.begin(wo, as.ns, ng, inside, true);
    for (const LobeInputs<float> &lobe : as.lobes)
      add_lobe(bsdf, lobe);
    bsdf.complete();
  };
  Bsdf<float> bsdf, other;
  look(bsdf, c);
  look(other, expected_case ? *expected_case : c);
  const Sides sides(c, wo, inside ? 1.0f / c.ior : c.ior);
  std::vector<double> observed(2 * kCells + 1, 0.0), expected(2 * kCells + 1, 0.0);
  const double tolerance = 0.2 / kDraws;
  double inside_mass = 0.0, albedo = 0.0;
  for (const testing::Domain *domain : {&sides.above, &sides.below}) {
    const testing::SquareFunction pdf =
        domain->density([&](const glm::vec3 &wi) { return double{other.eval(wi, c.drawn(wi)).pdf}; });
    for (std::size_t i = 0; i < kSide; ++i)
      for (std::size_t j = 0; j < kSide; ++j) {
        const glm::dvec2 low = glm::dvec2(i, j) / double{kSide}, high = glm::dvec2(i + 1, j + 1) / double{kSide};
        const double mass = testing::integrate_square(pdf, 2, tolerance, low, high);
        expected[(domain == &sides.above ? 0 : kCells) + i * kSide + j] = std::max(kDraws * mass, 1e-3);
        inside_mass += mass;
      }
    const auto value = domain->density([&](const glm::vec3 &wi) {
      const BsdfValue<float> drawn = bsdf.eval(wi, c.drawn(wi));
      // Directions that no facet connects have weight if another lobe samples them, and are part of the density by which this
      // weight is divided.
      const BsdfValue<float> lit = bsdf.eval_lit(wi), facets = bsdf.eval(wi);
      const double f = drawn.f().x + lit.f().x - facets.f().x, density = drawn.pdf + lit.pdf - facets.pdf;
      return drawn.pdf > 0.0f ? f * drawn.pdf / density : 0.0;
    });
    albedo += testing::integrate_square(value, 16, 1e-6);
  }
  expected.back() = std::max(1e-3, kDraws * (1.0 - inside_mass));
  Random random(seed);
  double sum = 0.0, sum2 = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    const BsdfSample<float> sample = bsdf.sample(u, x, y);
    if (!(sample.pdf > 0.0f)) {
      observed.back() += 1.0;
      continue;
    }
    EXPECT_FALSE(sample.delta);
    EXPECT_TRUE(c.strays || sample.transmitted == (sample.wi.z < 0.0f));
    observed[sides.cell(sample.wi)] += 1.0;
    sum += sample.weight.x;
    sum2 += static_cast<double>(sample.weight.x) * sample.weight.x;
  }
  const double mean = sum / kDraws, variance = std::max(0.0, sum2 / kDraws - mean * mean) / kDraws;
  // The errors of quadrature and floats, 1e-5 each per side, add to the noise.
  const double z = (mean - albedo) / std::sqrt(variance + 4e-10);
  return {testing::chi_square_test(observed, expected), testing::normal_p_value(z)};
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (float roughness : {0.1f, 0.5f, 1.0f}) {
    const double width = roughness * roughness;
    const std::string r = std::to_string(roughness);
    all.push_back({"GGX " + r, {rough(LobeKind::Glossy, Facets::Ggx, roughness)}, width});
    all.push_back({"Beckmann " + r, {rough(LobeKind::Glossy, Facets::Beckmann, roughness)}, width});
    all.push_back({"glass GGX " + r, {rough(LobeKind::Glass, Facets::MultiGgx, roughness)}, width});
    all.push_back({"glass Beckmann " + r, {rough(LobeKind::Glass, Facets::Beckmann, roughness)}, width});
    all.push_back({"refraction GGX " + r, {rough(LobeKind::Refraction, Facets::Ggx, roughness)}, width});
  }
  all.push_back({"glass 1.02", {rough(LobeKind::Glass, Facets::Ggx, 0.5f, 1.02f)}, 0.25, 1.02f});
  all.push_back({"glass 0.7", {rough(LobeKind::Glass, Facets::Ggx, 0.5f, 0.7f)}, 0.25, 0.7f});
  for (Facets facets : {Facets::MultiGgx, Facets::Beckmann}) {
    all.push_back({"along", {rough(LobeKind::Glossy, facets, 0.5f, 1.5f, 0.7f)}, 0.2});
    all.push_back({"across", {rough(LobeKind::Glossy, facets, 0.4f, 1.5f, -0.5f)}, 0.1});
  }
  LobeInputs<float> metal = rough(LobeKind::Conductor, Facets::MultiGgx, 0.4f, 1.5f, 0.8f);
  metal.edge = {0.5f, 0.7f, 0.9f};
  all.push_back({"metal", {metal}, 0.1});
  metal.option = 1;
  metal.color = {0.2f, 0.9f, 1.4f};
  metal.edge = {3.9f, 2.4f, 2.1f};
  all.push_back({"gold", {metal}, 0.1});
  LobeInputs<float> old = rough(LobeKind::Glass, Facets::Ggx, 0.5f);
  old.rules = Rules::Blender3;
  all.push_back({"glass of Blender 3", {old}, 0.25});
  // With a normal that faces away from its face it samples both sides.
  old.roughness = 0.9f;
  const glm::vec3 away = glm::normalize(glm::vec3(0.5f, 0.3f, -0.8f));
  all.push_back({.name = "glass of Blender 3 away", .lobes = {old}, .ns = away, .strays = true});
  old.distribution = Facets::MultiGgx;
  all.push_back({.name = "multiple glass of Blender 3 away", .lobes = {old}, .ns = away, .strays = true});
  LobeInputs<float> shirley = rough(LobeKind::Glossy, Facets::AshikhminShirley, 0.6f, 1.5f, 0.4f);
  LobeInputs<float> cloth = rough(LobeKind::Sheen, Facets::Ggx, 0.4f);
  LobeInputs<float> leaf = described(LobeKind::Translucent, 0.0f, 1.5f, 0.0f, {0.2f, 0.6f, 0.1f});
  LobeInputs<float> clay = described(LobeKind::Diffuse, 0.7f, 1.5f, 0.0f, {0.7f, 0.5f, 0.4f});
  clay.option = 1;
  all.push_back({"wide", {leaf, clay, cloth, shirley}});
  all.push_back({"everything", {leaf, clay, rough(LobeKind::Glass, Facets::MultiGgx, 0.8f), cloth}});
  // Bumped: the shading normal is tilted, and two lobes have normals of their own.
  LobeInputs<float> bumped = clay;
  bumped.normal = glm::normalize(glm::vec3(0.5f, -0.2f, 1.0f));
  LobeInputs<float> bumped_gloss = rough(LobeKind::Glossy, Facets::MultiGgx, 0.7f);
  bumped_gloss.normal = glm::normalize(glm::vec3(-0.4f, 0.3f, 1.0f));
  all.push_back({"bumped", {bumped, bumped_gloss, leaf}, 0.0, 1.5f, glm::normalize(glm::vec3(0.2f, 0.3f, 1.0f)), 1});
  LobeInputs<float> bent_leaf = leaf;
  bent_leaf.normal = bumped.normal;
  all.push_back({"bumped leaf", {bent_leaf, clay}, 0.0, 1.5f, glm::normalize(glm::vec3(-0.2f, 0.3f, 1.0f)), -1, 0});
  // A normal map that does not flip with the surface: the lobe faces inwards and is 0 above, where it is still sampled.
  LobeInputs<float> turned = clay;
  turned.normal = glm::normalize(glm::vec3(0.9f, 0.1f, -0.4f));
  all.push_back({"turned away", {turned, rough(LobeKind::Glossy, Facets::MultiGgx, 0.7f)}});
  // A coarse mesh: at a grazing angle the interpolated normal faces away from the viewer.
  all.push_back({"behind", {clay, cloth}, 0.0, 1.5f, glm::normalize(glm::vec3(-0.5f, -0.5f, 1.0f))});
  return all;
}

constexpr double kCosines[] = {1.0, 0.6, 0.08};

TEST(BsdfScatter, DirectionsFollowThePdfAndWeightsTheValue) {
  const std::vector<Case> all = cases();
  const double level = testing::sidak_level(testing::kSignificance, 4 * all.size() * std::size(kCosines));
  uint64_t seed = 700;
  for (const Case &c : all)
    for (double cosine : kCosines)
      for (bool inside : {false, true}) {
        if (inside && !c.has_inside())
          continue;
        const Verdict verdict = judge(c, direction(cosine), inside, ++seed);
        EXPECT_GT(verdict.p, level) << c.name << ", cos " << cosine << (inside ? " inside" : "");
        EXPECT_GT(verdict.weight_p, level) << c.name << ", cos " << cosine << (inside ? " inside" : "");
      }
}

TEST(BsdfScatter, AWrongIndexIsSeen) {
  const Case right{"", {rough(LobeKind::Glass, Facets::Ggx, 0.5f)}, 0.25};
  const Case wrong{"", {rough(LobeKind::Glass, Facets::Ggx, 0.5f, 1.53f)}, 0.25};
  EXPECT_LT(judge(right, direction(0.6), false, 1, &wrong).p, 1e-6);
}

} // namespace
} // namespace lancer
