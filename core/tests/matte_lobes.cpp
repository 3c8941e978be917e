// The wide lobes and the two glossy ones without a Smith term: samplers follow their density, and values agree with the laws
// and known closed forms.
#include "bsdf/matte.h"

#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "bsdf/ashikhmin.h"
#include "bsdf/sheen.h"
#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

struct Case {
  std::string name;
  std::function<Lobe<float>(const glm::vec3 &wo)> make;
  bool reciprocal = true;
};

ColorValue<float> value_of(const Lobe<float> &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  if (lobe.shape == LobeShape::Matte)
    return matte_eval(lobe, wo, wi);
  return lobe.shape == LobeShape::Sheen ? sheen_eval(lobe, wo, wi) : gloss_eval(lobe, wo, wi);
}

glm::vec3 drawn(const Lobe<float> &lobe, const glm::vec3 &wo, glm::vec2 u) {
  if (lobe.shape == LobeShape::Matte) {
    const glm::vec3 w = is_matte(lobe, Matte::Velvet)     ? velvet_sample(u.x, u.y)
                        : is_matte(lobe, Matte::Minnaert) ? minnaert_sample(lobe, u.x, u.y)
                                                          : glm::vec3(warp_cosine_hemisphere(u.x, u.y));
    return matte_transmits(lobe) ? glm::vec3(w.x, w.y, -w.z) : w;
  }
  return lobe.shape == LobeShape::Sheen ? sheen_sample(lobe, wo, u.x, u.y) : gloss_sample(lobe, wo, u.x, u.y);
}

std::vector<Case> cases() {
  const glm::vec3 white(1.0f), color(0.8f, 0.4f, 0.1f);
  std::vector<Case> all;
  for (const float r : {0.05f, 0.3f, 0.6f, 1.0f}) {
    const std::string name = ", " + std::to_string(r);
    all.push_back({"Oren-Nayar" + name, [=](const glm::vec3 &wo) { return make_diffuse(white, color, r, false, wo.z); }});
    all.push_back({"preserving" + name, [=](const glm::vec3 &wo) { return make_diffuse(white, color, r, true, wo.z); }});
    all.push_back({"Burley" + name, [=](const glm::vec3 &) { return make_burley(white, r); }});
    all.push_back({"velvet" + name, [=](const glm::vec3 &) { return make_velvet(white, r); }});
    all.push_back({"sheen" + name, [=](const glm::vec3 &wo) { return make_sheen(white, r, wo.z); }, false});
    all.push_back({"Ashikhmin-Shirley" + name, [=](const glm::vec3 &) { return make_ashikhmin(white, r, r); }});
    all.push_back({"stretched" + name, [=](const glm::vec3 &) { return make_ashikhmin(white, r, 0.4f * r); }});
    all.push_back({"clear coat" + name, [=](const glm::vec3 &wo) { return make_clear_coat(white, r, wo.z); }});
  }
  all.push_back({"dust", [=](const glm::vec3 &) { return make_matte<float>(Matte::DustSheen, white); }});
  for (const float k : {0.0f, 0.5f, 1.0f, 4.0f})
    for (const float rho : {0.2f, 0.9f})
      all.push_back({"Minnaert " + std::to_string(k) + ", " + std::to_string(rho),
                     [=](const glm::vec3 &wo) { return make_minnaert(glm::vec3(rho), k, rho, wo); }});
  return all;
}

double over_directions(const std::function<double(const glm::vec3 &)> &f) {
  return testing::integrate_square(testing::direction_domain().density(f), 8, 1e-6);
}

double albedo(const Lobe<float> &lobe, const glm::vec3 &wo, int channel = 0) {
  return over_directions([&](const glm::vec3 &wi) { return double{value_of(lobe, wo, wi).f[channel]}; });
}

TEST(MatteLobes, FallAsTheirDensitySays) {
  constexpr int kSide = 12, kDraws = 100000;
  const std::vector<Case> all = cases();
  const std::vector<double> cosines{0.95, 0.5, 0.15};
  const double level = testing::sidak_level(testing::kSignificance, all.size() * cosines.size());
  uint64_t seed = 1;
  for (const Case &c : all)
    for (const double cosine : cosines) {
      const glm::vec3 wo = direction(cosine);
      const Lobe<float> lobe = c.make(wo);
      const testing::Domain domain = testing::direction_domain();
      const testing::SquareFunction pdf =
          domain.density([&](const glm::vec3 &wi) { return double{value_of(lobe, wo, wi).pdf}; });
      std::vector<double> expected, observed(kSide * kSide + 1, 0.0);
      double sum = 0.0;
      for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
          const glm::dvec2 low = glm::dvec2(i, j) / double{kSide}, high = glm::dvec2(i + 1, j + 1) / double{kSide};
          expected.push_back(std::max(1e-3, kDraws * testing::integrate_square(pdf, 2, 0.2 / kDraws, low, high)));
          sum += expected.back();
        }
      // The part below the horizon is one more cell.
      expected.push_back(std::max(1e-3, kDraws - sum));
      Random random(seed++);
      for (int k = 0; k < kDraws; ++k) {
        const float u = random.uniform();
        const glm::vec3 wi = drawn(lobe, wo, {u, random.uniform()});
        std::size_t cell = kSide * kSide;
        if (wi.z > 0.0f) {
          const glm::dvec2 place = glm::clamp(domain.place(wi) * double{kSide}, 0.0, kSide - 1.0);
          cell = static_cast<std::size_t>(place.x) * kSide + static_cast<std::size_t>(place.y);
        }
        observed[cell] += 1.0;
      }
      EXPECT_GT(testing::chi_square_test(observed, expected), level) << c.name << " from " << cosine;
    }
}

TEST(MatteLobes, AnswerAlikeBothWays) {
  Random random(7);
  const auto any = [&] { return direction(0.02 + 0.98 * random.uniform(), 6.28 * random.uniform()); };
  for (const Case &c : cases()) {
    if (!c.reciprocal)
      continue;
    for (int k = 0; k < 200; ++k) {
      const glm::vec3 wo = any(), wi = any();
      const glm::vec3 there = value_of(c.make(wo), wo, wi).f / wi.z, back = value_of(c.make(wi), wi, wo).f / wo.z;
      // A few dozen roundings, some of them before a power of 800 (the exponent of roughness 0.05) or a fourth power of 1/sin.
      const float rounding = 3e-4f * std::max({there.x, there.y, there.z}) + 1e-30f;
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(there[i], back[i], rounding) << c.name << " from " << wo.z << " to " << wi.z;
    }
  }
}

TEST(MatteLobes, AreDarkBehind) {
  const glm::vec3 wo = direction(0.5), below = direction(-0.3);
  for (const Case &c : cases()) {
    EXPECT_EQ(value_of(c.make(wo), wo, below).f, glm::vec3(0.0f)) << c.name;
    EXPECT_EQ(value_of(c.make(wo), wo, below).pdf, 0.0f) << c.name;
  }
  const Lobe<float> paper = make_matte<float>(Matte::Translucent, glm::vec3(1.0f));
  EXPECT_EQ(value_of(paper, wo, direction(0.3)).f, glm::vec3(0.0f));
  EXPECT_NEAR(value_of(paper, wo, below).f.x, 0.3 / std::numbers::pi, 1e-7);
  EXPECT_LT(drawn(paper, wo, {0.3f, 0.6f}).z, 0.0f);
}

// The model has edges where wi is as high as wo and where both are a quarter turn apart: cells that end there have smooth
// integrands.
double oren_nayar_albedo(const Lobe<float> &lobe, const glm::vec3 &wo) {
  const testing::SquareFunction f =
      testing::direction_domain().density([&](const glm::vec3 &wi) { return double{matte_eval(lobe, wo, wi).f.x}; });
  return testing::integrate_square(f, 4, 1e-7, {0.0, 0.0}, {wo.z, 1.0}) +
         testing::integrate_square(f, 4, 1e-7, {wo.z, 0.0}, {1.0, 1.0});
}

// Fujii's directional albedo is a closed form; with returned losses a white surface loses nothing.
TEST(MatteLobes, OrenNayarKeepsItsLight) {
  const glm::vec3 white(1.0f);
  for (const float r : {1e-4f, 0.2f, 0.7f, 1.0f})
    for (const double cosine : {1.0, 0.7, 0.3, 0.05, 1e-3}) {
      const glm::vec3 wo = direction(cosine, 0.0);
      const Lobe<float> single = make_diffuse(white, white, r, false, wo.z), all = make_diffuse(white, white, r, true, wo.z);
      const double expected = single.alpha_x * std::numbers::pi + single.alpha_y * oren_nayar_g(wo.z);
      // Some thirty float roundings.
      EXPECT_NEAR(oren_nayar_albedo(single, wo), expected, 3e-6) << r << " " << cosine;
      EXPECT_NEAR(oren_nayar_albedo(all, wo), 1.0, 3e-6) << r << " " << cosine;
    }
}

TEST(MatteLobes, SmoothOrenNayarIsLambert) {
  EXPECT_EQ(make_diffuse(glm::vec3(0.5f), glm::vec3(0.5f), 0.0f, true, 0.4f).shape, LobeShape::Lambert);
  EXPECT_EQ(make_diffuse(glm::vec3(0.5f), glm::vec3(0.5f), 1e-4f, true, 0.4f).shape, LobeShape::Matte);
}

// Along the normal Burley's two Fresnel factors are 1 and there is no retroreflection.
TEST(MatteLobes, BurleyAlongTheNormalIsLambert) {
  const glm::vec3 n(0.0f, 0.0f, 1.0f);
  EXPECT_NEAR(value_of(make_burley(glm::vec3(1.0f), 0.9f), n, n).f.x, std::numbers::inv_pi, 1e-7);
}

// The density of half vectors is normalised on the projected hemisphere, and so is the distribution in the values.
TEST(MatteLobes, ClearCoatDistributionIsNormalised) {
  for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f}) {
    const double sum =
        testing::integrate_square(testing::half_vector_domain({0.0f, 0.0f, 1.0f}, alpha).density([&](const glm::vec3 &wi) {
          const glm::vec3 h = half_vector({0.0f, 0.0f, 1.0f}, wi);
          // Solid angle of normals per solid angle of wi: 1 / (4 wo.h).
          return double{gtr1_d(h, alpha)} * h.z / (4.0 * h.z);
        }),
                                  8, 1e-6);
    // Half vectors of directions above the plane tilt by at most 45 degrees: the rest of the distribution in closed form.
    const double a2 = double{alpha} * alpha;
    const double reached = a2 < 1.0 ? std::log((a2 + 0.5 * (1.0 - a2)) / a2) / -std::log(a2) : 0.5;
    EXPECT_NEAR(sum, reached, 1e-4) << alpha;
  }
}

TEST(MatteLobes, SheenScattersItsAlbedo) {
  const glm::vec3 weight(0.9f, 0.5f, 0.2f);
  for (const float r : {0.1f, 0.5f, 1.0f})
    for (const double cosine : {0.9, 0.4, 0.1}) {
      const glm::vec3 wo = direction(cosine);
      const Lobe<float> lobe = make_sheen(weight, r, wo.z);
      EXPECT_NEAR(albedo(lobe, wo), 1.0, 1e-4) << r << " " << cosine;
      EXPECT_EQ(lobe.albedo, lobe.color);
      EXPECT_LE(lobe.albedo.x, weight.x);
    }
  // Rougher cloth is brighter, and so is cloth along the horizon.
  EXPECT_GT(sheen_fit(0.5f, 0.8f).albedo, sheen_fit(0.5f, 0.4f).albedo);
  EXPECT_GT(sheen_fit(0.2f, 0.5f).albedo, sheen_fit(0.8f, 0.5f).albedo);
}

TEST(MatteLobes, SheenIsLinearBetweenItsNodes) {
  constexpr float kStep = 1.0f / (kSheenNodes - 1);
  const auto node = [](int j, int i) { return glm::vec3(kSheen[j][i][0], kSheen[j][i][1], kSheen[j][i][2]) * 1e-5f; };
  for (int j = 1; j < kSheenNodes; ++j)
    for (int i = 1; i < kSheenNodes; ++i) {
      const glm::vec3 near = node(j, i), far = node(j - 1, i - 1), mixed = node(j - 1, i) + node(j, i - 1);
      const SheenFit at = sheen_fit(i * kStep, j * kStep), middle = sheen_fit((i - 0.5f) * kStep, (j - 0.5f) * kStep);
      // A rounding of the position, at most 31, times the difference of two nodes, which is below 1.
      const float rounding = 4.0f * 31.0f * std::numeric_limits<float>::epsilon();
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(glm::vec3(at.a, at.b, at.albedo)[k], near[k], rounding) << j << " " << i;
        EXPECT_NEAR(glm::vec3(middle.a, middle.b, middle.albedo)[k], 0.25f * (near + far + mixed)[k], rounding)
            << j << " " << i;
      }
    }
}

// In this row of the table the albedo falls from 2e-5 at cos = 3/31 to 0 at 4/31.
TEST(MatteLobes, SheenWithHardlyAnAlbedoIsNothing) {
  const glm::vec3 white(1.0f);
  EXPECT_GT(make_sheen(white, 1.0f / 31.0f, 3.25f / 31.0f).color.x, 1e-5f);
  const Lobe<float> lobe = make_sheen(white, 1.0f / 31.0f, 3.75f / 31.0f);
  EXPECT_EQ(lobe.color, glm::vec3(0.0f));
  EXPECT_EQ(lobe.albedo, glm::vec3(0.0f));
}

// Sample weights are f / pdf: their mean is the integral of f, also where many half vectors face away.
TEST(MatteLobes, AshikhminSamplesWeighItsIntegral) {
  constexpr int kSide = 256;
  for (const float r : {0.6f, 1.0f})
    for (const float degrees : {20.0f, 65.0f, 80.0f}) {
      const glm::vec3 wo = direction(std::cos(glm::radians(degrees)));
      const Lobe<float> lobe = make_ashikhmin(glm::vec3(1.0f), r * r, r * r);
      double sum = 0.0;
      for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
          // Half vectors vary as the root of u.y and of 1 - u.y; in t they vary linearly at both ends.
          const double t = (j + 0.5) / kSide, u = t * t * (3.0 - 2.0 * t), du = 6.0 * t * (1.0 - t);
          const glm::vec3 wi = drawn(lobe, wo, glm::vec2((i + 0.5) / kSide, u));
          const ColorValue<float> term = wi.z > 0.0f ? value_of(lobe, wo, wi) : ColorValue<float>{};
          sum += term.pdf > 0.0f ? du * double{term.f.x} / term.pdf : 0.0;
        }
      // A grid of midpoints has an error of 1 / (24 kSide^2) times the slope at the start of a row, here 6, and at most as much
      // again from the break at the horizon. The integral's 64 cells are refined until they change by 1e-6, up or down.
      EXPECT_NEAR(sum / (kSide * kSide), albedo(lobe, wo), 0.5 / (kSide * kSide) + std::sqrt(64.0) * 1e-6)
          << r << " seen at " << degrees;
    }
}

TEST(MatteLobes, GlossGoesOverIntoAMirror) {
  EXPECT_TRUE(make_ashikhmin(glm::vec3(1.0f), 0.0f, 0.0f).delta);
  EXPECT_FALSE(make_ashikhmin(glm::vec3(1.0f), 0.0f, 0.1f).delta);
  EXPECT_TRUE(make_clear_coat(glm::vec3(1.0f), 0.0f, 0.5f).delta);
  const glm::vec3 wo(0.0f, 0.0f, 1.0f);
  // A quarter of the normal reflectance of a dielectric of IOR 1.5.
  const Lobe<float> coat = make_clear_coat(glm::vec3(1.0f), 0.0f, wo.z);
  EXPECT_NEAR(coat.color.x * gloss_delta_weight(coat, wo), 0.01f, 1e-8f);
  EXPECT_NEAR(coat.albedo.x, 0.01f, 1e-8f);
}

} // namespace
} // namespace lancer
