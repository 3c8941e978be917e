// Lights that are tiny, far, grazing or huge: solid angles by their densities, against closed forms in long double; and choices
// between lamps of any power.
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "bsdf_domain.h"
#include "light_choosers.h"
#include "lights/light_tree.h"
#include "lights/round_light.h"
#include "lights/sample_light.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::Random;
using Vector = std::array<long double, 3>;

Vector minus(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross(const Vector &a, const Vector &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
long double length(const Vector &a) { return std::sqrt(dot(a, a)); }

// Van Oosterom and Strackee 1983, with edges in the determinant.
long double triangle_angle(const Vector &a, const Vector &b, const Vector &c) {
  const long double la = length(a), lb = length(b), lc = length(c);
  const long double volume = std::abs(dot(a, cross(minus(b, a), minus(c, a))));
  return 2.0l * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

Light rectangle(double half_x, double half_y, const glm::dvec3 &position, const glm::dvec3 &facing) {
  Light light;
  light.kind = LightKind::Area;
  light.position = position;
  light.emission = glm::dvec3(1.0);
  light.z = glm::normalize(facing);
  const FrameAxes axes = complete_frame(Vector3<double>(light.z));
  light.x = axes.s;
  light.y = axes.t;
  light.half_x = half_x;
  light.half_y = half_y;
  light.area = 4.0 * half_x * half_y;
  return light;
}

long double rectangle_angle(const Light &light, const glm::dvec3 &p) {
  Vector corner[4];
  for (int i = 0; i < 4; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const long double along = (i == 1 || i == 2 ? 1.0l : -1.0l) * light.half_x, up = (i >= 2 ? 1.0l : -1.0l) * light.half_y;
      corner[i][std::size_t(axis)] =
          static_cast<long double>(light.position[axis]) - p[axis] + along * light.x[axis] + up * light.y[axis];
    }
  return triangle_angle(corner[0], corner[1], corner[2]) + triangle_angle(corner[0], corner[2], corner[3]);
}

TEST(LightsExtreme, RectanglesFillTheirSolidAngle) {
  Random random(1);
  // The mean of 1 / pdf is the solid angle, at any size; grazing: down to 1e-6 of height.
  for (const double size : {1.0, 0.1, 1e-3, 1e-6, 1e-9})
    for (const double tilt : {1.0, 0.1, 1e-3, 1e-6})
      for (int k = 0; k < 4; ++k) {
        const double phi = 6.28 * random.uniform();
        const glm::dvec3 towards(std::cos(phi), std::sin(phi), 0.0);
        // Edge-on except for the tilt, and farther away than it is wide.
        const Light light =
            rectangle(0.5 * size, 0.2 * size, 2.0 * towards, glm::dvec3(tilt * towards.x, tilt * towards.y, 1.0));
        const glm::dvec3 p(0.0);
        const double mean = testing::integrate_square(
            [&](const glm::dvec2 &u) {
              const LightSample sample = lancer::sample(light, p, glm::vec2(u));
              return sample.pdf > 0.0 ? 1.0 / sample.pdf : 0.0;
            },
            2, 0.0);
        EXPECT_NEAR(mean / double(rectangle_angle(light, p)), 1.0, 1e-6) << size << " " << tilt;
      }
}

TEST(LightsExtreme, BallsFillTheirCone) {
  for (const double distance : {1.0 + 1e-12, 1.0 + 1e-6, 1.001, 2.0, 1e3, 1e6, 1.6e7}) {
    Light light;
    light.kind = LightKind::Point;
    light.position = {0.0, 0.0, distance};
    light.emission = glm::dvec3(1.0);
    light.radius = 1.0;
    light.soft_falloff = false;
    const LightSample sample = lancer::sample(light, glm::dvec3(0.0), {0.3f, 0.7f});
    const long double d = distance, sin2 = 1.0l / (d * d), cosine = std::sqrt((d - 1.0l) * (d + 1.0l)) / d;
    const long double angle = 2.0l * glm::pi<long double>() * sin2 / (1.0l + cosine);
    ASSERT_GT(sample.pdf, 0.0) << distance;
    EXPECT_NEAR(double(angle * sample.pdf), 1.0, 1e-9) << distance;
    // A ray in a sampled direction hits the light with the same density; directions near the rim may round beyond it.
    const LightHit hit = meet(light, glm::dvec3(0.0), glm::normalize(light.position));
    EXPECT_NEAR(hit.pdf / sample.pdf, 1.0, 1e-12) << distance;
  }
}

TEST(LightsExtreme, SunsFillTheirDisk) {
  for (const double angle : {3e-7, 1e-5, 1e-3, 0.5, 3.1}) {
    Light light;
    light.kind = LightKind::Sun;
    light.emission = glm::dvec3(1.0);
    const double s = std::sin(0.25 * angle);
    light.one_minus_cos_sun = 2.0 * s * s;
    const LightSample sample = lancer::sample(light, glm::dvec3(0.0), {0.4f, 0.6f});
    const long double quarter = std::sin(0.25l * angle);
    EXPECT_NEAR(double(4.0l * glm::pi<long double>() * quarter * quarter * sample.pdf), 1.0, 1e-12) << angle;
  }
}

// No query of a light returns NaN. An infinite density is allowed: nothing arrives by it.
TEST(LightsExtreme, DensitiesAreNumbers) {
  for (const double size : {1e-30, 1e-6, 1.0, 1e6})
    for (const double height : {0.0, 1e-300, 1e-30, 1e-9, 1.0}) {
      Light area = rectangle(size, size, {0.0, 0.0, height}, {0.0, 0.0, 1.0}), ball;
      ball.kind = LightKind::Point;
      ball.position = {0.0, 0.0, height};
      ball.emission = glm::dvec3(1.0);
      ball.radius = size;
      for (const bool soft : {false, true}) {
        ball.soft_falloff = soft;
        for (const double x : {0.0, 1e-30, 0.5, 1.0, 1e6})
          for (const float u : {0.0f, 0.5f, 1.0f - 0x1p-24f}) {
            const glm::dvec3 p(x, 0.0, 0.0);
            for (const LightSample &sample : {lancer::sample(area, p, {u, u}), lancer::sample(ball, p, {u, u})})
              if (sample.pdf > 0.0) {
                // Transformed to the frame of a lamp so far away that the frame's own roundings matter.
                EXPECT_NEAR(glm::length(sample.wi), 1.0, 128.0 * 0x1p-53);
                EXPECT_FALSE(std::isnan(sample.radiance.x) || std::isnan(sample.distance));
              }
            for (const glm::dvec3 &wi : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(1, 0, 1e-9))})
              for (const LightHit &hit : {meet(area, p, wi), meet(ball, p, wi)}) {
                EXPECT_FALSE(std::isnan(hit.pdf) || hit.pdf < 0.0 || std::isnan(hit.radiance.x));
              }
          }
      }
    }
}

std::vector<DescribedLight> lamps(int count) {
  std::vector<DescribedLight> described;
  Random random(5);
  for (int i = 0; i < count; ++i) {
    Light light;
    light.kind = LightKind::Point;
    light.position = 100.0 * glm::dvec3(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform());
    light.emission = glm::dvec3(i % 2 ? 1e12 : 1e-6);
    described.push_back(describe(light, uint32_t(i)));
  }
  return described;
}

// Every lamp above the horizon may be chosen, with the reported probability, and the probabilities sum to 1.
template <class Choose> void expect_fair(const Choose &lights, int count, const std::vector<DescribedLight> &all) {
  for (const glm::vec3 &n : {glm::vec3(0, 0, 1), glm::vec3(1, 0, 0)}) {
    const LightQuery query({1.0, 2.0, 0.0}, n, false);
    double sum = 0.0;
    bool any = false;
    for (int i = 0; i < count; ++i) {
      const double p = lights.probability(query, uint32_t(i));
      const glm::dvec3 to = all[std::size_t(i)].light.centre - query.p;
      if (glm::dot(to, glm::dvec3(n)) > 1e-3) {
        EXPECT_GT(p, 0.0) << i;
        any = true;
      }
      sum += p;
    }
    EXPECT_NEAR(sum, any ? 1.0 : 0.0, 1e-12 * count);
    if (!any)
      continue;
    Random random(9);
    for (int k = 0; k < 2000; ++k) {
      const LightChoice choice = choose(lights, query, double(random.uniform()) + 0x1p-24 * double(random.uniform()));
      ASSERT_GT(choice.probability, 0.0);
      // The same products and quotients in another order.
      ASSERT_NEAR(lights.probability(query, choice.number) / choice.probability, 1.0, 1e-9);
    }
  }
}

TEST(LightsExtreme, LampsOfAnyPowersShareTheChoices) {
  for (const int count : {2, 4})
    expect_fair(BinaryLightTree(lamps(count), uint32_t(count)), count, lamps(count));
  for (const int count : {5, 17, 300})
    expect_fair(LightTree(lamps(count), uint32_t(count)), count, lamps(count));
}

// A very bright lamp may be occluded: the lamps beside it are still found, with at most a 256th of its choices.
TEST(LightsExtreme, DimLampsBesideABlindingOneAreFound) {
  const LightQuery query({1.0, 2.0, 0.0}, {0.0f, 0.0f, 1.0f}, false);
  for (const uint32_t count : {2u, 4u, 5u, 16u}) {
    // All at one place, so that none is in a cluster of its own.
    std::vector<DescribedLight> described;
    for (uint32_t i = 0; i < count; ++i) {
      Light light;
      light.kind = LightKind::Point;
      light.position = {3.0, 4.0, 5.0};
      light.emission = glm::dvec3(i == 0 ? 1e12 : 1e-6);
      described.push_back(describe(light, i));
    }
    const auto expect = [&](double blinding, double dim, double part) {
      // Share of the sum, for a dim lamp with this part of the bright one's importance.
      const double sum = 1.0 + (count - 1) * double{kRaised} * part;
      EXPECT_NEAR(dim * sum / (double{kRaised} * part), 1.0, 1e-6) << count;
      EXPECT_GE(blinding, 1.0 - double{kRaised}) << count;
    };
    const LightTree tree(described, count);
    expect(tree.probability(query, 0), tree.probability(query, 1), 1.0 / kBranchWidth);
    if (count > kLeafLights)
      continue;
    // The other half of the choices is by the lower bounds, which are not raised.
    const BinaryLightTree few(described, count);
    expect(few.probability(query, 0), 2.0 * few.probability(query, 1), 1.0 / count);
  }
}

} // namespace
} // namespace lancer
