// Every lobe and their mixtures: samples are distributed as the pdf, and weights sum to the albedo.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>
#include <limits>
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
using testing::seen;

struct Case {
  std::string name;
  std::vector<LobeInputs<float>> lobes;
  double width = 0.0; // of the narrowest microfacet lobe, in slopes of the half vector; 0: none
  double delta = 0.0; // probability of the delta lobes, known from the construction

  testing::Domain domain(const glm::vec3 &wo) const {
    return width > 0.0 ? testing::half_vector_domain(wo, width) : testing::direction_domain();
  }
};

LobeInputs<float> lobe(LobeKind kind, float color, float alpha = 0.0f, float ior = 1.5f, float shininess = 0.0f) {
  return described(kind, alpha, ior, shininess, glm::vec3(color, 0.5f * color, 0.25f * color));
}

std::vector<Case> cases() {
  const float infinity = std::numeric_limits<float>::infinity();
  const LobeInputs<float> diffuse = lobe(LobeKind::Lambert, 0.6f);
  std::vector<Case> all{{"Lambert", {diffuse}}};
  for (float alpha : {1e-3f, 1e-2f, 0.1f, 0.5f, 1.0f})
    all.push_back({"Beckmann " + std::to_string(alpha), {lobe(LobeKind::Beckmann, 1.0f, alpha, infinity)}, alpha});
  for (float n : {0.0f, 3.0f, 100.0f}) {
    all.push_back({"Phong " + std::to_string(n), {lobe(LobeKind::Phong, 0.9f, 0, 1, n)}});
    all.push_back({"Blinn-Phong " + std::to_string(n), {lobe(LobeKind::BlinnPhong, 0.9f, 0, 1, n)}});
  }
  for (float k : {0.0f, 0.5f, 2.0f, 20.0f})
    all.push_back({"Minnaert " + std::to_string(k), {lobe(LobeKind::Minnaert, 0.5f, 0, 1, k)}});
  for (float ior : {0.9f, 1.5f, 4.0f})
    all.push_back({"coated " + std::to_string(ior), {diffuse, lobe(LobeKind::Beckmann, 0.8f, 0.05f, ior)}, 0.05});
  all.push_back(
      {"two coats", {lobe(LobeKind::Beckmann, 0.8f, 0.3f), diffuse, lobe(LobeKind::Beckmann, 0.5f, 0.01f, 2.4f)}, 0.01});
  all.push_back({"everything smooth",
                 {lobe(LobeKind::Phong, 0.2f, 0, 1, 50.0f), diffuse, lobe(LobeKind::BlinnPhong, 0.3f, 0, 1, 20.0f),
                  lobe(LobeKind::Beckmann, 0.5f, 0.2f)},
                 0.2});
  // Colours 0.6, 0.3 and 0.3: half of the samples are of delta lobes.
  all.push_back({"with mirror and glass", {diffuse, lobe(LobeKind::Mirror, 0.3f), lobe(LobeKind::Dielectric, 0.3f)}, 0.0, 0.5});
  return all;
}

constexpr double kCosines[] = {1.0, 0.7, 0.1, 0.01};
constexpr int kDraws = 100000, kSide = 16;

struct Verdict {
  double p;        // chi-square of directions, including rejected and delta ones
  double weight_p; // z-test of the mean weight of smooth samples against the integral of f cos
};

// Samples one Bsdf and compares with the pdf of another.
Verdict judge(const Bsdf<float> &drawn, const Bsdf<float> &expected_of, const Case &c, const glm::vec3 &wo, uint64_t seed) {
  const testing::Domain domain = c.domain(wo);
  const testing::SquareFunction pdf = domain.density([&](const glm::vec3 &wi) { return double{expected_of.eval(wi).pdf}; });
  constexpr std::size_t rejected = kSide * kSide, delta = rejected + 1;
  std::vector<double> observed(delta + 1, 0.0), expected(delta + 1, 0.0);
  // The error of a cell's expectation must be a small part of its noise, which is 3 for the rarest cell that counts.
  const double tolerance = 0.2 / kDraws;
  double inside = 0.0;
  for (std::size_t i = 0; i < kSide; ++i)
    for (std::size_t j = 0; j < kSide; ++j) {
      const glm::dvec2 low = glm::dvec2(i, j) / double{kSide}, high = glm::dvec2(i + 1, j + 1) / double{kSide};
      const double mass = testing::integrate_square(pdf, 2, tolerance, low, high);
      // A sliver of a cell above the horizon can fall between the nodes: no cell counts as impossible.
      expected[i * kSide + j] = std::max(kDraws * mass, 1e-3);
      inside += mass;
    }
  expected[delta] = kDraws * c.delta;
  expected[rejected] = std::max(1e-3, kDraws * (1.0 - inside - c.delta));

  Random random(seed);
  double sum = 0.0, sum2 = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    const BsdfSample<float> sample = drawn.sample(u, x, y);
    if (sample.delta) {
      observed[delta] += 1.0;
    } else if (!(sample.pdf > 0.0f)) {
      observed[rejected] += 1.0;
    } else {
      const glm::dvec2 place = domain.place(sample.wi);
      const auto i = static_cast<std::size_t>(std::clamp(place.x * kSide, 0.0, kSide - 1.0));
      const auto j = static_cast<std::size_t>(std::clamp(place.y * kSide, 0.0, kSide - 1.0));
      observed[i * kSide + j] += 1.0;
      sum += sample.weight.x;
      sum2 += static_cast<double>(sample.weight.x) * sample.weight.x;
    }
  }
  const double albedo = testing::integrate_square(
      domain.density([&](const glm::vec3 &wi) { return double{expected_of.eval(wi).f().x}; }), 16, 1e-6);
  const double mean = sum / kDraws, variance = std::max(0.0, sum2 / kDraws - mean * mean) / kDraws;
  // The errors of quadrature and floats, 1e-5 each, add to the noise; a constant weight has no noise.
  const double z = (mean - albedo) / std::sqrt(variance + 2e-10);
  return {testing::chi_square_test(observed, expected), testing::normal_p_value(z)};
}

TEST(BsdfSampling, DirectionsFollowThePdfAndWeightsTheAlbedo) {
  const std::vector<Case> all = cases();
  const double level = testing::sidak_level(testing::kSignificance, 2 * all.size() * std::size(kCosines));
  uint64_t seed = 100;
  for (const Case &c : all)
    for (double cosine : kCosines) {
      const Bsdf<float> bsdf = seen(c.lobes, direction(cosine));
      const Verdict verdict = judge(bsdf, bsdf, c, direction(cosine), ++seed);
      EXPECT_GT(verdict.p, level) << c.name << ", cos " << cosine;
      EXPECT_GT(verdict.weight_p, level) << c.name << ", cos " << cosine;
    }
}

TEST(BsdfSampling, AWrongRoughnessIsSeen) {
  // Two percent of the width moves some 2 % of the mass: with 100 000 samples many times the noise of any cell.
  for (float alpha : {1e-3f, 0.1f})
    for (double cosine : {1.0, 0.1}) {
      const Case wrong{"", {lobe(LobeKind::Beckmann, 1.0f, 1.02f * alpha)}, alpha};
      const Bsdf<float> right = seen({lobe(LobeKind::Beckmann, 1.0f, alpha)}, direction(cosine));
      EXPECT_LT(judge(right, seen(wrong.lobes, direction(cosine)), wrong, direction(cosine), 1).p, 1e-6)
          << alpha << " " << cosine;
    }
}

TEST(BsdfSampling, VisibleNormalsIntegrateToOne) {
  // Exactly 1 for the exact G1. Floats: the exponent's rounding is weighted by its mean, 1; G1 / cos and alpha^2 have some 20
  // roundings of 6e-8 in total; the quadrature adds less.
  for (float alpha : {1e-3f, 1e-2f, 0.1f, 0.5f, 1.0f})
    for (double cosine : {1.0, 0.9, 0.5, 0.1, 1e-2, 1e-3}) {
      const glm::vec3 wo = direction(cosine);
      const double g1 = beckmann_g1_exact(beckmann_a(wo, alpha));
      const auto visible = [&](const glm::dvec2 &place) {
        double jacobian;
        const glm::dvec3 h = testing::half_vector_at(place, alpha, jacobian);
        const double tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
        return jacobian * g1 * std::max(0.0, glm::dot(glm::dvec3(wo), h)) / wo.z * coating_d(static_cast<float>(tan2), alpha);
      };
      // Small initial cells: at the edge of visibility a corner can fall between the nodes.
      const double sum = testing::integrate_square(visible, 64, 1e-9);
      EXPECT_NEAR(sum, 1.0, 3e-6) << alpha << " " << cosine;
    }
}

TEST(BsdfSampling, ThePdfIntegratesToWhatIsNotRejected) {
  // If almost nothing is sampled below the horizon, the pdf integrates to the whole probability: at normal incidence with
  // slopes that reach it (tan 45 degrees) only beyond exp(-1 / alpha^2) < 1e-10. Tolerance as for visible normals, times wi's
  // own rounding.
  for (float alpha : {1e-2f, 0.1f, 0.2f}) {
    const glm::vec3 wo = direction(1.0);
    const Bsdf<float> bsdf = seen({lobe(LobeKind::Beckmann, 1.0f, alpha)}, wo);
    const testing::Domain domain = testing::half_vector_domain(wo, alpha);
    const auto pdf = domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).pdf}; });
    EXPECT_NEAR(testing::integrate_square(pdf, 16, 1e-7), 1.0, 1e-5) << alpha;
  }
  for (double cosine : kCosines) {
    const Bsdf<float> diffuse = seen({lobe(LobeKind::Lambert, 1.0f)}, direction(cosine));
    const auto pdf = testing::direction_domain().density([&](const glm::vec3 &wi) { return double{diffuse.eval(wi).pdf}; });
    EXPECT_NEAR(testing::integrate_square(pdf, 16, 1e-7), 1.0, 1e-5) << cosine;
  }
}

TEST(BsdfSampling, WeightPdfAndValueAgree) {
  // A sample's weight times its pdf equals the evaluated f cos. The half vector from wo + wi has an error of up to 2^-23 (and
  // as much from wi's own rounding) over |wo + wi| >= s, the sum of heights. Slopes reach 4 widths: 2 * 4 * 2^-22 / (width s)
  // of the value (no lobe without microfacets is narrower than 0.1); and wo.h >= s / 2 divides the pdf of Blinn-Phong: 2^-21 /
  // s^2.
  Random random(5);
  for (const Case &c : cases())
    for (double cosine : kCosines) {
      const glm::vec3 wo = direction(cosine);
      const Bsdf<float> bsdf = seen(c.lobes, wo);
      for (int k = 0; k < 1000; ++k) {
        const float u = random.uniform(), x = random.uniform(), y = random.uniform();
        const BsdfSample<float> sample = bsdf.sample(u, x, y);
        if (sample.delta || !(sample.pdf > 0.0f))
          continue;
        const BsdfValue<float> value = bsdf.eval(sample.wi);
        const double s = std::min(1.0, double{sample.wi.z} + wo.z);
        const double tolerance = 1e-5 + 8.0 * 0x1p-22 / ((c.width > 0.0 ? c.width : 0.1) * s) + 0x1p-21 / (s * s);
        ASSERT_NEAR(value.pdf / sample.pdf, 1.0, tolerance) << c.name << " " << cosine;
        const float product = sample.weight.y * sample.pdf;
        ASSERT_NEAR(value.f().y / product, 1.0, 2.0 * tolerance) << c.name << " " << cosine;
      }
    }
}

TEST(BsdfSampling, LobesArePickedByTheLightOfAllColours) {
  // A red surface under a grey mirror: a third of 0.9, compared with 0.1.
  const Bsdf<float> bsdf =
      seen({described(LobeKind::Lambert, 0, 1, 0, {0.9f, 0.0f, 0.0f}), described(LobeKind::Mirror, 0, 1, 0, glm::vec3(0.1f))},
           {0, 0, 1});
  Random random(10);
  double mirrored = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    mirrored += bsdf.sample(u, x, y).delta ? 1.0 : 0.0;
  }
  const double p = 0.1 / 0.4, z = (mirrored - kDraws * p) / std::sqrt(kDraws * p * (1.0 - p));
  EXPECT_GT(testing::normal_p_value(z), testing::kSignificance);
}

TEST(BsdfSampling, PhongKeepsItsShapeHoweverNarrow) {
  // Around the mirror direction cos^(n + 1) and the azimuth are uniform; 1 - cos comes from the distance of both, in double.
  for (float n : {10.0f, 1e3f, 1e5f})
    for (double cosine : {0.7, 0.01}) {
      const glm::vec3 wo = direction(cosine);
      const Frame<float> frame(reflect_local(wo));
      const glm::dvec3 t(frame.t), b(frame.b), mirrored(frame.n);
      std::vector<double> observed(16 * 16, 0.0);
      Random random(12);
      for (int k = 0; k < kDraws; ++k) {
        const float x = random.uniform(), y = random.uniform();
        Lobe<float> phong;
        phong.shininess = n;
        const glm::dvec3 wi(phong_sample(phong, wo, x, y));
        const glm::dvec3 difference = wi - mirrored;
        const double level = std::exp((n + 1.0) * std::log1p(-std::min(1.0, 0.5 * glm::dot(difference, difference))));
        const double turn = std::atan2(glm::dot(wi, b), glm::dot(wi, t)) / (2.0 * std::numbers::pi) + 0.5;
        const auto i = static_cast<std::size_t>(std::clamp(level * 16.0, 0.0, 15.0));
        const auto j = static_cast<std::size_t>(std::clamp(turn * 16.0, 0.0, 15.0));
        observed[16 * i + j] += 1.0;
      }
      const double p = testing::chi_square_test(observed, std::vector<double>(256, kDraws / 256.0));
      EXPECT_GT(p, testing::sidak_level(testing::kSignificance, 6)) << n << " " << cosine;
    }
}

TEST(BsdfSampling, GlassReflectsWithProbabilityFresnel) {
  Random random(9);
  // Binomial z-test of reflections, from outside and inside.
  for (float side : {1.0f, -1.0f}) {
    glm::vec3 wo = direction(0.8);
    wo.z *= side;
    const Bsdf<float> glass = seen({lobe(LobeKind::Dielectric, 0.8f, 0, 1.5f)}, wo);
    const float reflectance = fresnel_dielectric(0.8f, side > 0.0f ? 1.5f : 1.0f / 1.5f);
    double reflected = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      const float u = random.uniform(), x = random.uniform(), y = random.uniform();
      const BsdfSample<float> sample = glass.sample(u, x, y);
      ASSERT_TRUE(sample.delta);
      ASSERT_EQ(sample.weight.x, 0.8f);
      const bool same_side = sample.wi.z * side > 0.0f;
      ASSERT_EQ(sample.pdf, same_side ? reflectance : 1.0f - reflectance);
      reflected += same_side ? 1.0 : 0.0;
    }
    const double p = reflectance, z = (reflected - kDraws * p) / std::sqrt(kDraws * p * (1.0 - p));
    EXPECT_GT(testing::normal_p_value(z), testing::sidak_level(testing::kSignificance, 2));
  }
}

} // namespace
} // namespace lancer
