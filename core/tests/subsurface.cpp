// Light below surfaces: the samplers of a step, walks against brute force and in a furnace, and the bounds of an object.
#include "bsdf/subsurface.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "bsdf/subsurface_lobe.h"
#include "wax.h"

namespace lancer {
namespace {

using testing::Random;
using testing::uniformity_p_value;

constexpr int kDraws = 20000;
// Level of each of about thirty tests of samplers and means in this file.
const double kLevel = testing::sidak_level(testing::kSignificance, 30);

TEST(Subsurface, ScatteringFollowsItsDensity) {
  Random random(1);
  for (const double g : {-0.9, -0.3, 0.0, 0.5, 0.9}) {
    std::vector<double> shares;
    for (int i = 0; i < kDraws; ++i) {
      const double c = double(henyey_greenstein_sample(float(g), random.uniform()));
      // The integral of the density up to the cosine c.
      const double share = g == 0.0
                               ? 0.5 * (1.0 + c)
                               : (1.0 - g * g) / (2.0 * g) * (1.0 / std::sqrt(1.0 + g * g - 2.0 * g * c) - 1.0 / (1.0 + g));
      shares.push_back(share);
    }
    EXPECT_GT(uniformity_p_value(shares), kLevel) << g;
  }
}

TEST(Subsurface, GuidedDirectionsFollowTheirDensity) {
  Random random(2);
  for (const double v : {1.0005, 1.2, 7.0, 500.0}) {
    const double log_v = std::log((v + 1.0) / (v - 1.0));
    std::vector<double> shares;
    for (int i = 0; i < kDraws; ++i) {
      const double c = double(dwivedi_sample(float(v), float(log_v), random.uniform()));
      shares.push_back(std::log((v + 1.0) / (v - c)) / log_v);
    }
    EXPECT_GT(uniformity_p_value(shares), kLevel) << v;
  }
}

TEST(Subsurface, DistancesFollowBurleysProfile) {
  Random random(3);
  std::vector<double> shares;
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double r = double(burley_radius(random.uniform()));
    shares.push_back((1.0 - 0.25 * std::exp(-r) - 0.75 * std::exp(-r / 3.0)) / double(kBurleyWithin));
  }
  EXPECT_GT(uniformity_p_value(shares), kLevel);
  // The profile of radius 1/2 holds all of the light within its reach.
  constexpr int kSteps = 100000;
  const double step = 0.5 * double(kBurleyReach) / kSteps;
  for (int i = 0; i < kSteps; ++i)
    sum += step * double(burley_profile(0.5f, float((i + 0.5) * step)));
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

// Smooth facets let light enter by Snell's law; rough ones and the even entry let it enter below the normal.
TEST(Subsurface, EntriesObeySnell) {
  Random random(4);
  SubsurfaceInputs<float> in;
  in.color = in.weight = in.radius = glm::vec3(0.5f);
  in.option = uint32_t(SubsurfaceMethod::RandomWalkLegacy);
  in.ior = 1.5f;
  in.alpha = 0.0f;
  Lobe<float> lobe = make_subsurface(in, 0);
  const glm::vec3 wo = glm::normalize(glm::vec3(0.6f, 0.0f, 0.8f)), down(0.0f, 0.0f, -1.0f);
  bool valid = false;
  const glm::vec3 wi = entry_sample(lobe, wo, down, 0.9f, 0.3f, 0.7f, valid);
  EXPECT_TRUE(valid);
  EXPECT_NEAR(wi.x, -0.4f, 1e-6f);
  EXPECT_NEAR(wi.z, -std::sqrt(1.0f - 0.16f), 1e-6f);
  for (const SubsurfaceMethod method : {SubsurfaceMethod::Skin, SubsurfaceMethod::RandomWalk})
    for (const float alpha : {0.1f, 1.0f}) {
      in.option = uint32_t(method);
      in.alpha = alpha;
      lobe = make_subsurface(in, 0);
      for (int i = 0; i < 1000; ++i) {
        const float kind = random.uniform(), u = random.uniform(), v = random.uniform();
        const glm::vec3 w = entry_sample(lobe, wo, down, kind, u, v, valid);
        EXPECT_NEAR(glm::length(w), 1.0f, 1e-5f); // some roundings of a turn into the frame of a facet
        EXPECT_TRUE(!valid || w.z < 0.0f);
      }
    }
}

} // namespace
} // namespace lancer

namespace lancer_test {
namespace {

using lancer::testing::Random;

// Level of each of twelve comparisons of means.
const double kLevel = lancer::testing::sidak_level(lancer::testing::kSignificance, 12);

// Returns the mean radiance of the front of a unit ball under a white sky, over this many pixels squared.
Mean ball_under_sky(const lancer_lobe &lobe, double width, uint32_t samples = 64, uint32_t bounces = 0) {
  Studio studio;
  studio.settings.samples = samples;
  studio.settings.max_bounces = bounces;
  studio.place(LANCER_SPHERE, studio.add({lobe}));
  studio.sky(1.0f, 1.0f, 1.0f);
  studio.look({0, 0, 5}, {0, 0, 0}, 16, width);
  studio.render();
  // A sample without a finite value is dropped and counted.
  EXPECT_EQ(studio.statistics().invalid_samples, 0u);
  return mean_of(studio.read(LANCER_PASS_COMBINED, 4));
}

// The radii give each method a mean free path of 1/2.
TEST(SubsurfacePictures, AWhiteBallVanishesInWhiteLight) {
  const float twice_pi = 2.0f * std::numbers::pi_v<float>, of_skin = 0.5f / std::sqrt(3e-6f);
  for (const auto &[method, radius] :
       {std::pair(LANCER_SUBSURFACE_RANDOM_WALK_LEGACY, twice_pi), std::pair(LANCER_SUBSURFACE_SKIN, of_skin),
        std::pair(LANCER_SUBSURFACE_RANDOM_WALK, 0.5f)})
    for (const float g : {0.0f, 0.8f}) {
      const Mean got = ball_under_sky(wax(method, 1.0f, radius, g), 1.6);
      // Each of less than 100 steps takes a millionth, and walks of more than 256 steps are lost. The lowest mode of a ball
      // of two mean free paths loses (1 - g) 0.45 of its light with each step: what is left after 256 steps is no loss.
      EXPECT_GT(same_mean_p_value(got, {1.0, 0.0}, 1e-4), kLevel) << method << " " << g << " " << got.value;
    }
}

// Returns E[albedo^n] of walks that enter a unit ball straight through its surface and scatter n times before they leave it.
Mean walk_by_brute_force(double sigma_t, double albedo) {
  Random random(5);
  constexpr int kWalks = 100000;
  double sum = 0.0, squares = 0.0;
  for (int walk = 0; walk < kWalks; ++walk) {
    glm::dvec3 p(0.0, 0.0, 1.0), d(0.0, 0.0, -1.0);
    double beta = 1.0;
    for (;;) {
      const double b = glm::dot(p, d), reach = -b + std::sqrt(std::max(b * b - (glm::dot(p, p) - 1.0), 0.0));
      const double t = -std::log1p(-double(random.uniform())) / sigma_t;
      if (t >= reach)
        break;
      p += t * d;
      beta *= albedo;
      const double z = 2.0 * double(random.uniform()) - 1.0, phi = 2.0 * std::numbers::pi * double(random.uniform());
      d = glm::dvec3(std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z);
    }
    sum += beta;
    squares += beta * beta;
  }
  const double mean = sum / kWalks;
  return {mean, std::sqrt((squares / kWalks - mean * mean) / kWalks)};
}

TEST(SubsurfacePictures, GuidedWalksHaveTheMeanOfPlainOnes) {
  for (const float color : {0.3f, 0.8f})
    for (const float radius : {0.1f, 0.5f, 2.0f}) {
      const Mean got = ball_under_sky(wax(LANCER_SUBSURFACE_RANDOM_WALK, color, radius, 0.0f, 0.0f), 1e-6, 256);
      const float albedo = lancer::similar_albedo(color, 0.0f);
      const Mean expected = walk_by_brute_force(1.0 / double(radius), double(albedo));
      // The light of both is the colour's share of E[albedo^n] over the colour.
      EXPECT_GT(same_mean_p_value(got, expected), kLevel) << color << " " << radius << " " << got.value;
    }
}

TEST(SubsurfacePictures, AWalkStaysInItsObject) {
  Studio studio;
  studio.settings.samples = 16;
  const uint32_t material = studio.add({wax(LANCER_SUBSURFACE_RANDOM_WALK, 0.9f, 0.5f)});
  studio.place(LANCER_SPHERE, material);
  studio.place(LANCER_SPHERE, studio.add({}, glow(100.0f)), glm::scale(glm::dmat4(1.0), glm::dvec3(0.5)));
  studio.look({0, 0, 5}, {0, 0, 0}, 8, 1.0);
  studio.render();
  EXPECT_EQ(studio.color().x, 0.0f);
}

// Walks of a batch are sorted by their methods: each must end in its own path.
TEST(SubsurfacePictures, WalksOfOneObjectDoNotDependOnThoseOfAnother) {
  const auto left_half = [](uint32_t method) {
    Studio studio;
    studio.settings.samples = 4;
    studio.place(LANCER_SPHERE, studio.add({wax(LANCER_SUBSURFACE_RANDOM_WALK, 0.8f, 0.3f)}), moved(-2, 0, 0));
    studio.place(LANCER_SPHERE, studio.add({wax(method, 0.3f, 0.3f)}), moved(2, 0, 0));
    studio.sky(0.7f, 0.8f, 1.0f);
    studio.look({0, 0, 5}, {0, 0, 0}, 16, 7.0);
    studio.render();
    std::vector<float> pixels = studio.read(LANCER_PASS_COMBINED, 4), left;
    for (size_t i = 0; i < pixels.size(); ++i)
      if (i / 4 % 16 < 8)
        left.push_back(pixels[i]);
    return left;
  };
  EXPECT_EQ(left_half(LANCER_SUBSURFACE_BURLEY), left_half(LANCER_SUBSURFACE_SKIN));
}

TEST(SubsurfacePictures, ExtremesEnd) {
  for (const uint32_t method :
       {LANCER_SUBSURFACE_BURLEY, LANCER_SUBSURFACE_RANDOM_WALK_LEGACY, LANCER_SUBSURFACE_SKIN, LANCER_SUBSURFACE_RANDOM_WALK})
    for (const float radius : {1e-9f, 1e-7f, 1e9f, 1e30f})
      for (const float color : {0.0f, 1e-4f, 1.0f, 1e6f}) {
        const Mean got = ball_under_sky(wax(method, color, radius), 1.6, 1);
        EXPECT_TRUE(std::isfinite(got.value)) << method << " " << radius << " " << color;
        EXPECT_GE(got.value, 0.0);
      }
}

} // namespace
} // namespace lancer_test
