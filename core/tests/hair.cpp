// Hair: densities over the whole sphere, samplers that follow them, and the light of a clear fibre.
#include "bsdf/hair.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

// Directions by the sine of their angle along the x axis and the turn about it: their solid angle is the area of this square.
glm::vec3 at_place(const glm::dvec2 &place) {
  const double sine = 2.0 * place.x - 1.0, cosine = std::sqrt((1.0 - sine) * (1.0 + sine)),
               phi = 2.0 * std::numbers::pi * place.y;
  return glm::vec3(glm::dvec3(sine, cosine * std::cos(phi), cosine * std::sin(phi)));
}
glm::dvec2 place_of(const glm::vec3 &w) {
  const double turn = std::atan2(double{w.z}, double{w.y}) / (2.0 * std::numbers::pi);
  return glm::clamp(glm::dvec2(0.5 * (double{w.x} + 1.0), turn < 0.0 ? turn + 1.0 : turn), 0.0, 1.0);
}

struct Case {
  std::string name;
  std::function<Lobe<float>(const glm::vec3 &wo)> make;
  glm::vec3 wo;
  // Cycles leaves out that tilted cones are wider or narrower: the largest tilt, two of the scales', times the tangent of wo.
  double unnormalised = 0.0;

  double density(const Lobe<float> &lobe, const glm::vec3 &wi) const {
    if (is_hair(lobe, Hair::Chiang))
      return double{chiang_eval(lobe, wo, wi).pdf};
    const HairDensity<float> r = hair_density(lobe, wo, wi);
    // The Lorentzian of transmission goes on beyond the quarter turns that its sampler reaches.
    const bool reached = is_hair(lobe, Hair::Reflection) || r.cos_phi <= 0.0f;
    return r.defined && reached ? double{r.along} * double{r.around} : 0.0;
  }
  glm::vec3 drawn(const Lobe<float> &lobe, Random &random) const {
    const float part = random.uniform(), u = random.uniform(), v = random.uniform();
    bool first = false;
    return is_hair(lobe, Hair::Chiang) ? chiang_sample(lobe, wo, part, u, v, first) : hair_sample(lobe, wo, u, v);
  }
};

// In the frame of a fibre: the tangent is x, and wo has no z.
glm::vec3 beside(float sine) { return {sine, -std::sqrt((1.0f - sine) * (1.0f + sine)), 0.0f}; }

std::vector<Case> cases() {
  const glm::vec3 white(1.0f), x(1.0f, 0.0f, 0.0f);
  std::vector<Case> all;
  for (const float along : {0.2f, 0.7f})
    for (const float around : {0.3f, 1.0f})
      for (const float tilt : {0.0f, 0.3f}) {
        const std::string name = std::to_string(along) + " " + std::to_string(around) + " " + std::to_string(tilt);
        for (const Hair variant : {Hair::Reflection, Hair::Transmission})
          all.push_back({(variant == Hair::Reflection ? "reflection " : "transmission ") + name,
                         [=](const glm::vec3 &) { return make_hair(white, along, around, tilt, x, variant); },
                         glm::normalize(glm::vec3(0.4f, 0.3f, 0.8f))});
        // Before Blender 4.2 the scales tilt wi, which folds directions at the ends of the fibre.
        for (const float sine : {0.1f, -0.6f})
          for (const Rules rules : {Rules::Blender3, Rules::Blender52})
            if (rules == Rules::Blender52 || tilt == 0.0f || along == 0.2f)
              all.push_back(
                  {"fibre " + name,
                   [=](const glm::vec3 &) {
                     const glm::vec3 ng = glm::normalize(glm::vec3(0.0f, -0.8f, 0.5f));
                     return make_chiang(white, along, around, 0.8f, 1.55f, 0.1f * tilt, {0.1f, 0.4f, 1.0f}, ng, rules);
                   },
                   beside(sine),
                   rules == Rules::Blender3
                       ? double{2.0f * 0.1f * tilt} * std::abs(double{sine}) / std::sqrt(1.0 - double{sine * sine})
                       : 0.0});
      }
  return all;
}

// Midpoints by the angle along the x axis, whose cosine the densities of cones divide by. Edges of cones end within a row: the
// error is a part of a row of the 400.
constexpr int kSteps = 400;
double over_sphere(const std::function<double(const glm::vec3 &)> &f) {
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double theta = std::numbers::pi * ((i + 0.5) / kSteps - 0.5), weight = std::cos(theta);
    for (int j = 0; j < kSteps; ++j)
      sum += weight * f(at_place({0.5 * (std::sin(theta) + 1.0), (j + 0.5) / kSteps}));
  }
  return sum * 2.0 * std::numbers::pi * std::numbers::pi / (double{kSteps} * kSteps);
}

TEST(Hair, DensitiesAreNormalised) {
  for (const Case &c : cases()) {
    const Lobe<float> lobe = c.make(c.wo);
    EXPECT_NEAR(over_sphere([&](const glm::vec3 &wi) { return c.density(lobe, wi); }), 1.0, 2.5e-3 + c.unnormalised) << c.name;
  }
}

TEST(Hair, FallsAsItsDensitySays) {
  constexpr int kDraws = 40000, kSide = 10, kFine = 40;
  const std::vector<Case> all = cases();
  const double level = testing::sidak_level(testing::kSignificance, all.size());
  uint64_t seed = 1;
  for (const Case &c : all) {
    const Lobe<float> lobe = c.make(c.wo);
    std::vector<double> expected(kSide * kSide, 0.0), observed(kSide * kSide, 0.0);
    const auto cell = [](const glm::dvec2 &place) {
      const auto index = [](double at) { return std::min(static_cast<std::size_t>(at * kSide), std::size_t{kSide - 1}); };
      return index(place.x) * kSide + index(place.y);
    };
    double all_expected = 0.0;
    for (int i = 0; i < kSide * kFine; ++i)
      for (int j = 0; j < kSide * kFine; ++j) {
        const glm::dvec2 place = glm::dvec2(i + 0.5, j + 0.5) / double(kSide * kFine);
        const double share = c.density(lobe, at_place(place));
        expected[cell(place)] += share;
        all_expected += share;
      }
    for (double &count : expected)
      count = std::max(1e-3, count * kDraws / all_expected);
    Random random(seed++);
    for (int k = 0; k < kDraws; ++k)
      observed[cell(place_of(c.drawn(lobe, random)))] += 1.0;
    EXPECT_GT(testing::chi_square_test(observed, expected), level) << c.name;
  }
}

// A fibre that absorbs nothing returns all light: F, (1 - F)^2 and the series of further reflections. Cycles' series of the
// Bessel function lacks up to 2 % of it, which along most of the fibre is less than half.
TEST(Hair, AClearFibreReturnsAllLight) {
  for (const float sine : {0.0f, 0.5f, -0.9f})
    for (const float across : {0.0f, 0.6f, 0.95f}) {
      const glm::vec3 ng(0.0f, -std::sqrt(1.0f - across * across), across);
      const Lobe<float> lobe =
          make_chiang(glm::vec3(1.0f), 0.3f, 0.4f, 1.0f, 1.55f, 0.0f, glm::vec3(0.0f), ng, Rules::Blender52);
      const Fibre<float> parts = fibre(lobe, beside(sine));
      float sum = 0.0f;
      for (const glm::vec3 &share : parts.share)
        sum += share.x;
      EXPECT_NEAR(sum, 1.0f, 1e-6f) << sine << " " << across;
      EXPECT_NEAR(over_sphere([&](const glm::vec3 &wi) { return double{chiang_eval(lobe, beside(sine), wi).f.x}; }), 1.0, 0.01);
    }
}

// The density along a smooth fibre, against its limit for small variances in double. Sines and cosines of 1e-7 relative error
// move the exponent by its slope, at most 1e-7 / sqrt(variance) per standard deviation: 2e-3 at 1e-8.
TEST(Hair, SmoothFibresKeepTheDigitsOfTheirDensity) {
  for (const double variance : {1e-3, 1e-6, 1e-8})
    for (const double theta : {0.0, 0.4, 1.1})
      for (const double deviations : {0.0, 0.7, -1.5}) {
        const double i = -theta + deviations * std::sqrt(variance);
        const float si = float(std::sin(i)), so = float(std::sin(theta)), ci = float(std::cos(i)), co = float(std::cos(theta));
        const double sum = double{si} + double{so}, apart = double{ci} - double{co}, x = double{ci} * double{co} / variance;
        const double expected = std::exp(-0.5 * (sum * sum + apart * apart) / variance + 1.0 / (16.0 * x)) /
                                (variance * std::sqrt(2.0 * std::numbers::pi * x));
        EXPECT_NEAR(double{along_fibre(si, ci, so, co, float(variance))} / expected, 1.0, 2e-3) << variance << " " << theta;
      }
}

// Before 5.0 Cycles checks no side of the shading normal for fibres, whose own normal is across it.
TEST(Hair, FibresKnowNoSideBeforeBlender50) {
  const glm::vec3 wo = direction(0.7);
  for (const Rules rules : {Rules::Blender3, Rules::Blender4, Rules::Blender45}) {
    LobeInputs<float> inputs = testing::described(LobeKind::HairFibre, 0.4f, 1.55f, 0.0f, glm::vec3(0.2f));
    inputs.rules = rules;
    inputs.roughness_across = 0.6f;
    inputs.tangent = glm::vec3(1.0f, 0.0f, 0.0f);
    const Bsdf<float> bsdf = testing::seen({inputs}, wo);
    for (int k = 0; k < 16; ++k) {
      const glm::vec3 wi = direction(0.9 - 0.11 * k, 0.7 * k);
      const glm::vec3 alone =
          chiang_eval(bsdf.lobes[0], bsdf.wo_local[bsdf.lobes[0].frame], bsdf.frames[bsdf.lobes[0].frame].to_local(wi)).f;
      EXPECT_NEAR(bsdf.eval_lit(wi).f().x, alone.x, 1e-5f * alone.x) << int(rules) << " " << k;
    }
  }
}

TEST(Hair, ReflectionAndTransmissionHaveTheirSides) {
  const glm::vec3 x(1.0f, 0.0f, 0.0f), wo = direction(0.8);
  const Lobe<float> back = make_hair(glm::vec3(1.0f), 0.3f, 0.6f, 0.0f, x, Hair::Reflection),
                    through = make_hair(glm::vec3(1.0f), 0.3f, 0.6f, 0.0f, x, Hair::Transmission);
  EXPECT_GT(hair_eval(back, wo, wo, false).f.x, 0.0f);
  EXPECT_EQ(hair_eval(back, wo, -wo, false).f.x, 0.0f);
  EXPECT_GT(hair_eval(through, wo, -wo, false).f.x, 0.0f);
  EXPECT_EQ(hair_eval(through, wo, wo, false).f.x, 0.0f);
}

// A direction that the lobe has sampled weighs the light by 1, with a density of its own.
TEST(Hair, SamplesHaveTheDensityOfCycles) {
  const glm::vec3 x(1.0f, 0.0f, 0.0f), wo = direction(0.8);
  const Lobe<float> lobe = make_hair(glm::vec3(1.0f), 0.3f, 0.4f, 0.0f, x, Hair::Reflection);
  const glm::vec3 wi = hair_sample(lobe, wo, 0.4f, 0.1f);
  const ColorValue<float> drawn = hair_eval(lobe, wo, wi, true), lit = hair_eval(lobe, wo, wi, false);
  const HairDensity<float> density = hair_density(lobe, wo, wi);
  EXPECT_EQ(drawn.f.x, drawn.pdf);
  EXPECT_NEAR(drawn.pdf / lit.pdf, std::cos(0.5 * double{density.phi}) / std::cos(0.5 * double{density.phi} / 0.4), 1e-4);
}

TEST(Hair, IsFiniteAtTheEndsOfItsInputs) {
  for (const float along : {0.0f, 1.0f})
    for (const float around : {0.0f, 1.0f})
      for (const glm::vec3 &wo : {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 0.0f, 1.0f), beside(0.3f)})
        for (const glm::vec3 &wi : {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 0.0f, -1.0f), beside(-0.3f)})
          for (const float ior : {1e-5f, 1.0f, 1.55f, 1e10f}) {
            const Rules rules = ior > 1.0f ? Rules::Blender3 : Rules::Blender52;
            const glm::vec3 white(1.0f), x(1.0f, 0.0f, 0.0f);
            for (const Hair variant : {Hair::Reflection, Hair::Transmission})
              EXPECT_NEAR(glm::length(hair_sample(make_hair(white, along, around, 0.2f, x, variant), wo, 0.3f, 0.6f)), 1.0f,
                          1e-5f);
            const ColorValue<float> fibre = chiang_eval(
                make_chiang(white, along, around, 0.0f, ior, 0.2f, glm::vec3(1e30f), {0.0f, 1.0f, 0.0f}, rules), wo, wi);
            const ColorValue<float> hair = hair_eval(make_hair(white, along, around, 0.2f, x, Hair::Reflection), wo, wi, true);
            for (const ColorValue<float> &value : {fibre, hair})
              EXPECT_TRUE(value.f.x >= 0.0f && value.f.x < 1e12f) << along << " " << around << " " << ior;
          }
}

} // namespace
} // namespace lancer
