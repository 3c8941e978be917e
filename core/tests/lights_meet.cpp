// Lights along a ray: hit where sampling would put them, and only lights that sampling can choose.
#include "lights/sample_light.h"
#include "round_lamp.h"
#include "tiny_scene.h"

#include "lights/light_set.h"
#include "lights/round_light.h"

#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

// Calls a function for each light.
template <class Visit> class Visitor final : public LightVisitor {
public:
  explicit Visitor(Visit visit) : visit_(visit) {}
  void visit(uint32_t lane, uint32_t light) override { visit_(lane, light); }

private:
  Visit visit_;
};

using testing::ball;

TEST(Lights, AreMetWhereTheyAreSampled) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 0.999f);
  for (const bool soft : {false, true}) {
    // From outside, and for the ball also from inside.
    for (const double height : {-3.0, -0.5}) {
      if (soft && height > -1.0)
        continue;
      const Light light = ball(1.0, soft);
      const glm::dvec3 p(0.1, 0.2, height);
      for (int i = 0; i < 1000; ++i) {
        const LightSample s = sample(light, p, {uniform(random), uniform(random)});
        const LightHit hit = meet(light, p, s.wi);
        // Directions are rounded to double: at grazing incidence the root of the ball magnifies this to 1e-8.
        EXPECT_NEAR(hit.distance, s.distance, 1e-6);
        EXPECT_NEAR(hit.pdf, s.pdf, 1e-9 * s.pdf);
      }
    }
  }
}

// Rectangles and parallelograms of all shapes, from near and far, from aside, and close to their planes.
TEST(Lights, RectanglesAreMetWithTheDensityThatTheyAreSampledWith) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0.0f, 0x1.fffffep-1f);
  int sampled = 0, met = 0;
  for (int k = 0; k < 20000; ++k) {
    Light light;
    light.kind = LightKind::Area;
    light.emission = glm::dvec3(1.0);
    light.position = {0.3, -0.2, 0.1};
    light.half_x = std::exp2(-12.0 * uniform(random));
    light.half_y = std::exp2(-12.0 * uniform(random));
    light.skew = k % 2 ? light.half_x * (4.0 * uniform(random) - 2.0) : 0.0;
    light.area = 4.0 * light.half_x * light.half_y;
    const glm::dvec3 away(uniform(random) - 0.5, uniform(random) - 0.5, -uniform(random));
    const glm::dvec3 p = light.position + 2.0 * away;
    const LightSample s = sample(light, p, {uniform(random), uniform(random)});
    if (!(s.pdf > 0.0))
      continue;
    ++sampled;
    const LightHit hit = meet(light, p, s.wi);
    if (!(hit.pdf > 0.0))
      continue;
    ++met;
    // The round trip has some roundings of double.
    EXPECT_NEAR(hit.pdf, s.pdf, 1e-9 * s.pdf);
    EXPECT_NEAR(hit.distance, s.distance, 1e-9 * s.distance);
  }
  EXPECT_GT(sampled, 19900);
  // On the rim, which numbers of 24 bits hit once in a million times, rounding decides.
  EXPECT_GE(met, sampled - 2);
}

TEST(Lights, TheMiddleOfTheSquareIsTheMiddleOfTheLight) {
  Light sun;
  sun.kind = LightKind::Sun;
  sun.emission = glm::dvec3(1.0);
  sun.one_minus_cos_sun = 0.2;
  EXPECT_EQ(sample(sun, glm::dvec3(0.0), {0.5f, 0.5f}).wi, sun.z);
  const LightSample s = sample(ball(0.5, false), glm::dvec3(0.0, 0.0, -2.0), {0.5f, 0.5f});
  EXPECT_NEAR(s.wi.z, 1.0, 1e-15);
  EXPECT_NEAR(s.distance, 1.5, 1e-12);
}

TEST(Lights, ALightThatIsNeverChosenIsNeverMet) {
  // A spot without an opening has extent and emission, but no power.
  Light spot = ball(0.1, true);
  spot.kind = LightKind::Spot;
  spot.cos_half_angle = 1.0;
  const LightSet lights({spot}, {}, 0, Environment());
  EXPECT_FALSE(lights.any_on_the_way());
}

TEST(Lights, ManyAreMetAsOneByOne) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Light> lights;
  for (int i = 0; i < 300; ++i) {
    Light light = ball(20.0 * std::abs(uniform(random)) + 1e-3, i % 2);
    light.position = 400.0 * glm::dvec3(uniform(random), uniform(random), uniform(random));
    if (i % 3 == 0) {
      light.kind = LightKind::Area;
      light.half_x = light.radius;
      light.half_y = 0.5 * light.radius;
      light.area = 4.0 * light.half_x * light.half_y;
      light.ellipse = i % 2;
    }
    lights.push_back(light);
  }
  const LightSet set(lights, {}, 0, Environment());
  ASSERT_TRUE(set.finds());
  int met = 0;
  for (int round = 0; round < 1500; ++round) {
    SegmentBlock ways{};
    glm::dvec3 o[kBlockLanes], wi[kBlockLanes];
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      const int i = round * kBlockLanes + lane;
      // Also from distances at which float does not separate small lamps from their neighbours.
      o[lane] = (i % 7 ? 500.0 : 1e7) * glm::dvec3(uniform(random), uniform(random), uniform(random));
      // Aim at lights, and along the axes, parallel to the slabs of the boxes.
      const double beside = i % 7 ? 20.0 * uniform(random) : 0.0;
      wi[lane] = glm::normalize(lights[size_t(i) % 300].position + glm::dvec3(beside) - o[lane]);
      if (i % 5 == 0)
        wi[lane] = i % 2 ? glm::dvec3(0.0, -1.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
      ways.end[lane] = i % 7 ? 600.0 * std::abs(uniform(random)) : std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        ways.from[axis][lane] = o[lane][axis];
        ways.d[axis][lane] = 3.0 * wi[lane][axis];
      }
    }
    const int count = round % 2 ? kBlockLanes : 5;
    std::vector<bool> candidates(size_t(kBlockLanes) * 300);
    Visitor near_rays([&](uint32_t lane, uint32_t number) {
      EXPECT_FALSE(candidates[lane * 300 + number]);
      candidates[lane * 300 + number] = true;
      // Reported lamps are near the segment: a box around a lamp reaches sqrt(3) radii at its corners. Its padding is 2^-22 of
      // 1024 and its coordinates, up to 1200 together, and for each segment 2^-21 of its half, up to 20, its distance along an
      // axis, up to 900, and the segment's coordinates, up to 1500 together; the roundings that the padding covers move a
      // segment at most as far again. sqrt(3) times 2224 * 2^-22 + 2 * 2420 * 2^-21 is below 2^-7.
      const glm::dvec3 to = lights[number].position - o[lane];
      const double reach = std::sqrt(3.0) * lights[number].radius + 0x1p-7;
      const bool near = glm::length(to - glm::dot(to, wi[lane]) * wi[lane]) < reach;
      EXPECT_TRUE(near || glm::length(o[lane]) > 1000.0);
    });
    set.wide_tree().along(ways, uint32_t(count), near_rays);
    for (int lane = 0; lane < count; ++lane)
      for (size_t k = 0; k < 300; ++k) {
        const LightHit hit = meet(lights[k], o[lane], wi[lane]);
        if (!(hit.pdf > 0.0) || !(hit.distance < ways.end[lane]))
          continue;
        ++met;
        EXPECT_TRUE(candidates[size_t(lane) * 300 + k]);
      }
  }
  EXPECT_GT(met, 1000);
}

TEST(Lights, TheDeepestTreeIsSearchedToItsEnd) {
  // Positions in geometric progression make the deepest tree.
  std::vector<Light> lights;
  for (int i = 0; i < 1000; ++i) {
    lights.push_back(ball(1e-3, true));
    lights.back().position = {std::ldexp(500.0, -i), 0.0, 1.0};
  }
  const LightSet set(lights, {}, 0, Environment());
  const glm::dvec3 o(-1.0, -1.0, 5.0);
  // Aim at every one.
  for (uint32_t first = 0; first < lights.size(); first += kBlockLanes) {
    const uint32_t count = std::min(uint32_t(kBlockLanes), uint32_t(lights.size()) - first);
    SegmentBlock ways{};
    for (uint32_t lane = 0; lane < count; ++lane) {
      for (int axis = 0; axis < 3; ++axis) {
        ways.from[axis][lane] = o[axis];
        ways.d[axis][lane] = lights[first + lane].position[axis] - o[axis];
      }
      ways.end[lane] = 1e3;
    }
    uint32_t told = 0;
    Visitor visitor([&](uint32_t lane, uint32_t number) { told |= uint32_t(number == first + lane) << lane; });
    set.wide_tree().along(ways, count, visitor);
    EXPECT_EQ(told, (1u << count) - 1u);
  }
}

TEST(Lights, ATinyDiskIsAPoint) {
  const Light light = ball(1e-30, true);
  const LightSample s = sample(light, glm::dvec3(0.0, 0.0, -2.0), {0.2f, 0.7f});
  EXPECT_TRUE(s.delta);
  EXPECT_FLOAT_EQ(s.radiance.x, 0.25f);
}

// Returns the level of a floor under a lamp; a pane of the given opacity passes through the lamp, none if it is negative.
double floor_level(float pane_opacity, bool soft) {
  using namespace lancer_test;
  lancer_scene scene = 0;
  lancer_scene_create(&scene);
  add_material(scene, {lobe(LANCER_LAMBERT, 0.8f)});
  add_material(scene, {lobe(LANCER_LAMBERT, 0.0f)}, 0.0f, std::max(pane_opacity, 0.0f));
  lancer_instance instances[2] = {};
  const uint32_t slots[] = {0, 1};
  for (uint32_t i = 0; i < 2; ++i) {
    place(instances[i].matrix, 0, 0, i == 0 ? 0.0 : 2.2);
    instances[i].kind = LANCER_PLANE;
    instances[i].first_slot = i;
    instances[i].slot_count = 1;
  }
  lancer_scene_add_instances(scene, pane_opacity < 0.0f ? 1 : 2, instances, 2, slots, nullptr, 0);
  lancer_light light = point_light();
  place(light.matrix, 0, 0, 2);
  light.radius = 1.0f;
  light.soft_falloff = soft;
  lancer_scene_add_light(scene, &light);
  lancer_scene_commit(scene, LANCER_BVH, 1);
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  lancer_camera camera = make_camera(8, 8);
  const double down[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5};
  std::copy(down, down + 12, camera.matrix);
  lancer_settings settings = make_settings();
  settings.max_bounces = 0;
  lancer_session session = 0;
  lancer_session_create(scene, &camera, &settings, &session);
  lancer_session_render(session, 0, 1024);
  finish(session);
  std::vector<float> image(8 * 8 * 4);
  lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size());
  double sum = 0.0;
  for (size_t i = 0; i < image.size(); i += 4)
    sum += double(image[i]) / 64.0;
  lancer_session_destroy(session);
  lancer_scene_destroy(scene);
  return sum;
}

TEST(Lights, APaneThatIsNotThereChangesNothing) {
  for (const bool soft : {true, false}) {
    // 65536 samples of a level whose standard deviation is below the level agree within 4 / 256.
    EXPECT_NEAR(floor_level(0.0f, soft) / floor_level(-1.0f, soft), 1.0, 4.0 / 256.0);
  }
}

} // namespace
} // namespace lancer
