// Motion: placements between keys, the opening of the shutter, and traversals of scenes in which things move.
#include "accel_scenes.h"
#include "scene/moving_bounds.h"
#include "scene/shutter.h"
#include "scene/surface.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

glm::dmat3 turn(double angle, const glm::dvec3 &axis) { return glm::mat3_cast(glm::angleAxis(angle, glm::normalize(axis))); }

double difference(const Affine &a, const Affine &b) {
  double most = glm::length(a.translation - b.translation);
  for (int i = 0; i < 3; ++i)
    most = std::max(most, glm::length(a.linear[i] - b.linear[i]));
  return most;
}

TEST(Motion, NumbersOfKeys) {
  for (uint32_t count = 0; count < 300; ++count)
    EXPECT_EQ(is_key_count(count),
              count == 3 || count == 5 || count == 9 || count == 17 || count == 33 || count == 65 || count == 129)
        << count;
}

// Each key is met exactly at its time, and every time lies between two keys.
TEST(Motion, PlacesOfTimes) {
  for (const uint32_t count : {3u, 5u, 129u}) {
    for (uint32_t key = 0; key < count; ++key) {
      const KeyPlace at = key_at(count, float(key) / float(count - 1));
      EXPECT_EQ(float(at.key) + at.share, float(key));
    }
    for (const float time : {0.0f, 0.3f, 0.999f, 1.0f}) {
      const KeyPlace at = key_at(count, time);
      EXPECT_LT(at.key, count - 1);
      EXPECT_GE(at.share, 0.0f);
      EXPECT_LE(at.share, 1.0f);
    }
  }
}

// A stretched and turned shape turns at constant speed by the shorter way. Each product of matrices rounds by some 1e-16 of its
// numbers, which are below 10; the iteration of the decomposition ends within 2^-50.
TEST(Motion, PlacementsTurnAtConstantSpeed) {
  const glm::dmat3 stretch(2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5);
  for (const double angle : {1e-9, 0.3, 2.0, 3.1}) {
    const glm::dvec3 axis(1.0, 2.0, -1.0);
    const std::vector<Affine> maps{{stretch, glm::dvec3(0.0)},
                                   {turn(angle, axis) * stretch, glm::dvec3(1.0, 2.0, 3.0)},
                                   {turn(2.0 * angle, axis) * stretch, glm::dvec3(0.0)}};
    const std::vector<PlacementKey> keys = placement_keys(maps);
    for (uint32_t i = 0; i < 3; ++i)
      EXPECT_LT(difference(placement_at(keys, 0.5f * float(i)), maps[i]), 1e-14);
    for (const float time : {0.125f, 0.25f, 0.4375f}) {
      const Affine expected{turn(2.0 * double(time) * angle, axis) * stretch, 2.0 * double(time) * glm::dvec3(1.0, 2.0, 3.0)};
      EXPECT_LT(difference(placement_at(keys, time), expected), 1e-14) << angle << " " << time;
    }
  }
}

TEST(Motion, MirroredPlacementsStayMirrored) {
  const glm::dmat3 mirror(-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  const std::vector<PlacementKey> keys = placement_keys(
      std::vector<Affine>{{mirror, {}}, {turn(1.0, {0, 0, 1}) * mirror, {}}, {turn(2.0, {0, 0, 1}) * mirror, {}}});
  for (int i = 0; i <= 16; ++i)
    EXPECT_NEAR(glm::determinant(placement_at(keys, float(i) / 16.0f).linear), -1.0, 1e-14);
}

// The shares of times below a time are the integral of the opening. A number has 24 digits, and a time as many.
TEST(Motion, ShutterFollowsItsCurve) {
  const std::vector<float> open{0.0f, 1.0f, 1.0f, 0.25f, 0.0f, 0.5f};
  const Shutter shutter(open);
  double whole = 0.0, below = 0.0;
  for (size_t i = 0; i + 1 < open.size(); ++i)
    whole += 0.5 * double(open[i] + open[i + 1]);
  float last = -1.0f;
  for (int i = 0; i < 4096; ++i) {
    const float u = (float(i) + 0.5f) / 4096.0f, time = shutter.time(u);
    EXPECT_GE(time, last);
    last = time;
    const double at = double(time) * double(open.size() - 1);
    const auto step = std::min(size_t(at), open.size() - 2);
    const double share = at - double(step), from = double(open[step]), to = double(open[step + 1]);
    below = 0.0;
    for (size_t k = 0; k < step; ++k)
      below += 0.5 * double(open[k] + open[k + 1]);
    below += share * (from + 0.5 * share * (to - from));
    EXPECT_NEAR(below / whole, double(u), 1e-6);
  }
  // A shutter that never opens is open all the time.
  EXPECT_FLOAT_EQ(Shutter(std::vector<float>{0.0f, 0.0f}).time(0.25f), 0.25f);
}

TEST(Motion, RowsOfARollingShutterFollowEachOther) {
  Motion motion;
  motion.shutter = Shutter(std::vector<float>{1.0f, 1.0f});
  motion.rolling = true;
  motion.rolling_duration = 0.25;
  EXPECT_FLOAT_EQ(motion.time(0.0f, 0.0), 0.0f);
  EXPECT_FLOAT_EQ(motion.time(0.5f, 0.0), 0.125f);
  EXPECT_FLOAT_EQ(motion.time(0.5f, 1.0), 0.875f);
  motion.rolling_duration = 0.0;
  EXPECT_FLOAT_EQ(motion.time(0.7f, 0.25), 0.25f);
}

// All kinds of shapes and motions: turning, stretched, changing their shape, both, and standing still.
Geometry moving_things(Random &random, double away) {
  Geometry geometry = everything(random, 24, 200, 6.0);
  for (const uint32_t number : {0u, 2u}) {
    Mesh &mesh = geometry.meshes[number];
    mesh.key_count = number == 0 ? 3 : 9;
    for (uint32_t key = 0; key < mesh.key_count; ++key)
      for (const glm::vec3 &p : mesh.positions)
        mesh.moved_positions.push_back(p * float(random.uniform(0.8, 1.3)) + glm::vec3(random.in_box(0.2)));
    std::copy_n(mesh.moved_positions.begin() + ptrdiff_t(mesh.key_count / 2 * mesh.positions.size()), mesh.positions.size(),
                mesh.positions.begin());
  }
  for (Instance &instance : geometry.instances) {
    instance.place({instance.to_world.linear, instance.to_world.translation + glm::dvec3(away)});
    const uint32_t kind = random.below(4);
    if (kind == 0)
      continue;
    const uint32_t count = kind == 1 ? 3 : kind == 2 ? 5 : 17;
    std::vector<Affine> maps;
    const glm::dvec3 axis = random.direction(), way = random.in_box(3.0);
    for (uint32_t key = 0; key < count; ++key) {
      const double time = double(key) / double(count - 1);
      const glm::dmat3 stretch(random.uniform(0.7, 1.4), 0.1, 0.0, 0.0, random.uniform(0.7, 1.4), 0.2, 0.1, 0.0, 1.0);
      maps.push_back({turn(3.0 * time * double(kind), axis) * instance.to_world.linear * stretch,
                      instance.to_world.translation + time * way});
    }
    geometry.move(instance, maps);
  }
  return geometry;
}

// The same scene, standing still as it is at a time.
Geometry posed(const Geometry &moving, float time) {
  const GeometryView view = moving;
  Geometry still;
  still.meshes = moving.meshes;
  for (Mesh &mesh : still.meshes) {
    for (size_t i = 0; i < mesh.positions.size() && mesh.key_count > 0; ++i)
      mesh.positions[i] = MeshView(mesh).moved(mesh.moved_positions, i, time);
    mesh.key_count = 0;
    mesh.moved_positions.clear();
  }
  for (uint32_t i = 0; i < view.instances.size(); ++i) {
    Instance scratch;
    still.instances.push_back(view.placed_at(i, time, scratch));
    still.instances.back().key_count = 0;
  }
  return still;
}

// Every accelerator meets, at any time, the scene as it stands then: the same bits as brute force, and the hits of the posed
// scene. The boxes of all times give rays other frames than those of one time, so that distances differ by the rounding of
// double: coordinates of at most 2e5 have errors below 1e-10, which grow on faces seen at a grazing angle.
TEST(Motion, RaysMeetTheSceneOfTheirTime) {
  Random random(47);
  for (const double away : {0.0, 1e5}) {
    const Geometry moving = moving_things(random, away);
    const std::vector<Contestant> all = all_accelerators(moving);
    size_t met = 0;
    for (const float time : {0.0f, 0.1875f, 0.5f, 0.71f, 0.9999f, 1.0f}) {
      const Geometry still = posed(moving, time);
      const auto reference = build_brute_force(still);
      constexpr double kRounding = 1e-7;
      std::vector<Ray> rays;
      for (int i = 0; i < 700; ++i) {
        rays.push_back(make_ray(random.in_box(12.0) + away, random.direction()));
        if (i % 2)
          rays.back().d = glm::dvec3(away) + random.in_box(5.0) - rays.back().o;
        rays.back().time = time;
        if (i % 5 == 0)
          rays.back().kinds = 1u;
      }
      std::vector<Hit> expected(rays.size()), hits(rays.size());
      std::vector<uint8_t> occluded(rays.size());
      reference->closest_hit(rays, hits);
      all[0].accelerator->closest_hit(rays, expected);
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(expected[i].instance, hits[i].instance) << "ray " << i << " at " << time;
        ASSERT_EQ(expected[i].primitive, hits[i].primitive) << "ray " << i << " at " << time;
        const double t = hits[i].valid() ? hits[i].t : 0.0;
        ASSERT_NEAR(expected[i].valid() ? expected[i].t : 0.0, t, kRounding);
      }
      for (const Contestant &one : all) {
        one.accelerator->closest_hit(rays, hits);
        one.accelerator->any_hit(rays, occluded);
        for (size_t i = 0; i < rays.size(); ++i) {
          ASSERT_TRUE(same_bits(hits[i], expected[i]))
              << one.name << " at " << time << ", ray " << i << ": t " << hits[i].t << " instead of " << expected[i].t
              << ", instance " << hits[i].instance << " instead of " << expected[i].instance;
          ASSERT_EQ(occluded[i], uint8_t(expected[i].valid())) << one.name << " at " << time << ", ray " << i;
          met += hits[i].valid();
        }
      }
    }
    // Half of the rays aim into the cube of things.
    EXPECT_GT(met, all.size() * 6 * 200);
  }
}

// Rays of different times in one batch do not disturb each other.
TEST(Motion, TimesInOneBatch) {
  Random random(48);
  const Geometry moving = moving_things(random, 0.0);
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    rays.push_back(make_ray(random.in_box(12.0), random.direction()));
    rays.back().time = float(random.uniform(0.0, 1.0));
  }
  for (const Contestant &one : all_accelerators(moving)) {
    std::vector<Hit> together(rays.size());
    one.accelerator->closest_hit(rays, together);
    for (size_t i = 0; i < rays.size(); i += 7)
      ASSERT_TRUE(same_bits(together[i], closest(*one.accelerator, rays[i]))) << one.name << ", ray " << i;
  }
}

// A surface is that of the scene posed at the time of the ray.
TEST(Motion, SurfacesAreOfTheTimeOfTheRay) {
  Random random(49);
  const Geometry moving = moving_things(random, 0.0);
  const auto accelerator = build_brute_force(moving);
  uint32_t met = 0;
  for (int i = 0; i < 400; ++i) {
    Ray ray = make_ray(random.in_box(9.0), random.direction());
    ray.time = float(random.uniform(0.0, 1.0));
    const Hit hit = closest(*accelerator, ray);
    if (!hit.valid())
      continue;
    ++met;
    const Surface moved = surface_at(moving, {}, ray, hit), still = surface_at(posed(moving, ray.time), {}, ray, hit);
    EXPECT_EQ(moved.p, still.p);
    EXPECT_EQ(moved.ng, still.ng);
    EXPECT_EQ(moved.ns, still.ns);
    EXPECT_EQ(moved.time, ray.time);
    EXPECT_EQ(ray_from(moved, glm::dvec3(moved.ng), 1.0).time, ray.time);
  }
  EXPECT_GT(met, 100u);
}

// The box of an instance at all times holds it at each.
TEST(Motion, SweptBoxesHoldTheShapes) {
  Random random(50);
  const Geometry moving = moving_things(random, 3.0);
  const GeometryView view = moving;
  for (uint32_t i = 0; i < view.instances.size(); ++i) {
    const Instance &instance = view.instances[i];
    if (!view.moves(instance) || instance.kind != ShapeKind::Mesh)
      continue;
    const Extent swept = swept_extent(view, instance);
    const MeshView &mesh = view.meshes[instance.mesh];
    for (int step = 0; step <= 100; ++step) {
      const float time = float(step) / 100.0f;
      Instance scratch;
      const Instance &placed = view.placed_at(i, time, scratch);
      for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        const glm::dvec3 p = placed.to_world.point(glm::dvec3(mesh.vertex(triangle, 0, time)));
        // A point of the box's rim may be outside by the rounding of double.
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_GE(p[axis], swept.lo[axis] - 1e-12);
          ASSERT_LE(p[axis], swept.hi[axis] + 1e-12);
        }
      }
    }
  }
}

} // namespace
} // namespace lancer::test
