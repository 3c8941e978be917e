// Area lights of small spread: only the part that lights a point is sampled, and nothing outside the light.
#include "lights/light.h"
#include "lights/sample_light.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

TEST(AreaLightSpread, IsSampledWhereItShinesOnThePoint) {
  Light light;
  light.kind = LightKind::Area;
  light.emission = glm::dvec3(1.0);
  light.half_x = light.half_y = 1.0;
  light.ellipse = true;
  light.area = glm::pi<double>();
  const double half = 0.3;
  light.tan_half_spread = std::tan(half);
  light.spread_scale = 1.0 / (light.tan_half_spread - half);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0.0f, 0x1.fffffep-1f);
  // In front of the disk's edge, where the square around the lit circle extends beyond the disk.
  const glm::dvec3 p = light.position - 1.5 * light.z + 0.65 * (light.x + light.y);
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const LightSample s = sample(light, p, {uniform(random), uniform(random)});
    if (!(s.pdf > 0.0))
      continue;
    ++met;
    const LightHit hit = meet(light, p, s.wi);
    // The round trip has some roundings of double.
    EXPECT_NEAR(hit.distance, s.distance, 1e-12);
    EXPECT_NEAR(hit.pdf, s.pdf, 1e-9 * s.pdf);
    EXPECT_LE(glm::length(s.target - light.position), 1.0 + 1e-12);
    // The square is smaller than the disk, so the density is higher.
    EXPECT_GT(s.pdf, 2.0 * s.distance * s.distance / (glm::dot(s.wi, light.z) * light.area));
  }
  EXPECT_GT(met, 500);
}

} // namespace
} // namespace lancer
