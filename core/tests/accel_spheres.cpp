// The BVH tests four spheres at a time: the same bits as one by one.
#include "accel_scenes.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Spheres and ellipsoids with radii from 2^-smallest to 2^largest, some hidden from some rays.
Geometry spheres(Random &random, uint32_t count, double smallest, double largest) {
  Geometry geometry;
  for (uint32_t i = 0; i < count; ++i) {
    glm::dmat3 linear(std::exp2(random.uniform(smallest, largest)));
    if (i % 5 == 0)
      for (int column = 0; column < 3; ++column)
        linear[column] = linear[0][0] * (random.direction() + 2.0 * glm::dmat3(1.0)[column]);
    geometry.instances.push_back(placed(ShapeKind::Sphere, linear, random.in_box(8.0)));
    geometry.instances.back().hidden_from = i % 7 == 0 ? 2 : 0;
  }
  return geometry;
}

// Brute force uses quadric.cpp.
void expect_equal(const Geometry &geometry, const std::vector<Ray> &rays, double least_hits) {
  const std::vector<Contestant> all = all_accelerators(geometry);
  std::vector<Hit> oracle(rays.size()), hits(rays.size());
  std::vector<uint8_t> occlusion(rays.size());
  all[0].accelerator->closest_hit(rays, oracle);
  size_t found = 0;
  for (const Hit &hit : oracle)
    found += hit.valid();
  EXPECT_GE(static_cast<double>(found), least_hits * static_cast<double>(rays.size()));
  for (const Contestant &c : all) {
    c.accelerator->closest_hit(rays, hits);
    c.accelerator->any_hit(rays, occlusion);
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(same_bits(hits[i], oracle[i]))
          << c.name << ", ray " << i << ": t " << hits[i].t << " instead of " << oracle[i].t << ", " << hits[i].instance
          << " instead of " << oracle[i].instance;
      ASSERT_EQ(occlusion[i], oracle[i].valid()) << c.name << ", ray " << i;
    }
  }
}

Ray aimed(Random &random, const Geometry &geometry, double off) {
  const Instance &target = geometry.instances[random.below(static_cast<uint32_t>(geometry.instances.size()))];
  const glm::dvec3 o = random.in_box(16.0);
  Ray ray = make_ray(o, target.to_world.point(off * random.direction()) - o);
  ray.kinds = 1 + random.below(3);
  return ray;
}

TEST(AcceleratorSpheres, AnyNumberOfThem) {
  Random random(21);
  for (const uint32_t count : {1u, 2u, 3u, 4u, 5u, 9u, 300u}) {
    const Geometry geometry = spheres(random, count, -4.0, 0.0);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i)
      rays.push_back(aimed(random, geometry, 0.7));
    expect_equal(geometry, rays, 0.5); // all but those to which their target is invisible, a twelfth, and some that hit
                                       // something before it
  }
}

// Tangential rays: the discriminant is a few roundings from 0.
TEST(AcceleratorSpheres, TangentialRays) {
  Random random(22);
  const Geometry geometry = spheres(random, 40, -2.0, 0.0);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const Instance &target = geometry.instances[random.below(40)];
    const glm::dvec3 n = random.direction(), along = glm::cross(n, random.direction());
    const double distance = 1.0 + random.uniform(-4.0, 4.0) * 0x1p-53;
    rays.push_back(make_ray(target.to_world.point(distance * n - 9.0 * along), target.to_world.vector(along)));
  }
  expect_equal(geometry, rays, 0.2); // half of them touch from inside
}

// Rays that start on a sphere and leave it to either side.
TEST(AcceleratorSpheres, RaysFromTheSurface) {
  Random random(23);
  const Geometry geometry = spheres(random, 40, -2.0, 2.0);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const uint32_t number = random.below(40);
    Ray ray = make_ray(geometry.instances[number].to_world.point(random.direction()), random.direction());
    ray.skip_instance = number;
    ray.skip_primitive = 0;
    ray.kinds = 1;
    rays.push_back(ray);
  }
  expect_equal(geometry, rays, 0.4); // the half that goes inside hits the far side
}

TEST(AcceleratorSpheres, HugeAndTiny) {
  Random random(24);
  const Geometry geometry = spheres(random, 60, -40.0, 40.0);
  std::vector<Ray> rays;
  for (int i = 0; i < 10000; ++i) {
    Ray ray = aimed(random, geometry, 0.7);
    ray.d *= std::exp2(random.uniform(-400.0, 400.0));
    rays.push_back(ray);
  }
  expect_equal(geometry, rays, 0.5); // most start inside a huge one
}

} // namespace
} // namespace lancer::test
