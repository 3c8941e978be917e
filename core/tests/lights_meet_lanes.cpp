// Lights along segments in lanes: kernels hit the same lights as the general code, with the same data.
#include "integrator/stages/light.h"
#include "lights/light_set.h"
#include "lights/round_light.h"
#include "lights/sample_light.h"

#include <gtest/gtest.h>
#include <random>

#include "round_lamp.h"

namespace lancer {
namespace {

using testing::ball;

TEST(Lights, KernelsMeetWhatTheGeneralCodeMeets) {
  std::mt19937 random(5);
  const auto uniform = [&](double) { return 2.0 * double(random()) / 4294967296.0 - 1.0; };
  const auto vector = [&] { return glm::dvec3(uniform(0), uniform(0), uniform(0)); };
  std::vector<Light> lights;
  for (int i = 0; i < 60; ++i) {
    Light light = ball(0.2 + 2.0 * std::abs(uniform(0)), i % 2 == 0);
    light.kind = i % 3 == 0 ? LightKind::Area : i % 3 == 1 ? LightKind::Point : LightKind::Sun;
    light.position = 4.0 * vector();
    light.z = glm::normalize(vector());
    const FrameAxes axes = complete_frame(Vector3<double>(light.z));
    light.x = axes.s;
    light.y = axes.t;
    light.half_x = 0.5 + std::abs(uniform(0));
    light.half_y = 0.5 + std::abs(uniform(0));
    light.area = 4.0 * light.half_x * light.half_y;
    light.one_minus_cos_sun = 0.1;
    lights.push_back(light);
  }
  const LightSet set(lights, {}, 0, Environment());
  int met = 0;
  for (int round = 0; round < 400; ++round) {
    SegmentBlock ways{};
    glm::dvec3 o[kBlockLanes], d[kBlockLanes];
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      o[lane] = 6.0 * vector();
      // Of any length, mostly towards a light.
      d[lane] = lane % 4 ? lights[size_t(round % 60)].position + vector() - o[lane] : vector();
      for (int axis = 0; axis < 3; ++axis) {
        ways.from[axis][lane] = o[lane][axis];
        ways.d[axis][lane] = d[lane][axis];
      }
      ways.end[lane] = 12.0 * std::abs(uniform(0));
    }
    for (uint32_t number = 0; number < 60; ++number) {
      const uint32_t bits = light_kernel().meets(ways, set.lamps()[number]);
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        const LightHit hit = meet(lights[number], o[lane], d[lane] / glm::length(d[lane]));
        const bool here = hit.pdf > 0.0 && (std::isinf(hit.distance) || hit.distance < ways.end[lane]);
        met += here;
        EXPECT_EQ(bool(bits >> lane & 1), here) << number;
      }
    }
  }
  EXPECT_GT(met, 10000);
}

TEST(Lights, LanesThatMeetALampKnowWhatItGivesAndHowItIsChosen) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  constexpr uint32_t kLamps = 4; // more would be in the tree of many lights
  std::vector<Light> lights;
  for (uint32_t i = 0; i < kLamps; ++i) {
    Light light = ball(0.3, i % 2);
    light.position = 4.0 * vector();
    light.emission = glm::dvec3(1.0 + i);
    if (i % 3 == 0) {
      light.kind = LightKind::Area;
      light.half_x = light.half_y = 1.0;
      light.area = 4.0;
    }
    lights.push_back(light);
  }
  const LightSet set(lights, {}, 0, Environment());
  const LightNodes tree = set.binary_tree().nodes();
  int met = 0;
  for (int round = 0; round < 200; ++round) {
    SegmentBlock ways{};
    glm::dvec3 o[kBlockLanes], d[kBlockLanes];
    glm::vec3 n[kBlockLanes];
    ways.transmits = uint32_t(random()) & 0xffffu;
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      o[lane] = 6.0 * vector();
      d[lane] = lights[size_t(round) % kLamps].position + 0.2 * vector() - o[lane];
      n[lane] = glm::vec3(glm::normalize(vector()));
      for (int axis = 0; axis < 3; ++axis) {
        ways.from[axis][lane] = o[lane][axis];
        ways.d[axis][lane] = d[lane][axis];
        ways.normal[axis][lane] = n[lane][axis];
      }
    }
    for (uint32_t number = 0; number < kLamps; ++number) {
      MetBlock found{};
      light_kernel().meet(ways, set.lamps()[number], tree, set.binary_tree().place_of(number), found);
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        const LightHit hit = meet(lights[number], o[lane], d[lane] / glm::length(d[lane]));
        ASSERT_EQ(found.pdf[lane], hit.pdf) << number;
        const LightQuery query(o[lane], n[lane], ways.transmits >> lane & 1u);
        EXPECT_EQ(found.chosen[lane], set.probability(query, number)) << number;
        if (!(hit.pdf > 0.0))
          continue;
        ++met;
        EXPECT_EQ(found.distance[lane], hit.distance) << number;
        EXPECT_EQ(found.radiance[0][lane], hit.radiance.x) << number;
      }
    }
  }
  EXPECT_GT(met, 1000);
}

} // namespace
} // namespace lancer
