// The first check of the course: three rays against two spheres and two planes.
#include "accel/hit_tests.h"
#include "accel_scenes.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Spheres of radius 1 at (0, 0, 0) and of radius 2 at (0, 0, -10); the planes z = -20 (facing up) and y = -3 (facing +y).
Geometry lab() {
  Geometry geometry;
  const glm::dmat3 up_to_y(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
  geometry.instances.push_back(placed(ShapeKind::Sphere, glm::dmat3(1.0), glm::dvec3(0.0)));
  geometry.instances.push_back(placed(ShapeKind::Sphere, glm::dmat3(2.0), glm::dvec3(0, 0, -10)));
  geometry.instances.push_back(placed(ShapeKind::Plane, glm::dmat3(1.0), glm::dvec3(0, 0, -20)));
  geometry.instances.push_back(placed(ShapeKind::Plane, up_to_y, glm::dvec3(0, -3, 0)));
  return geometry;
}

struct Expected {
  Ray ray;
  uint32_t instance;
  double t;
  glm::dvec3 normal;
};

glm::dvec3 world_normal(const Geometry &geometry, const Ray &ray, const Hit &hit) {
  const Instance &instance = geometry.instances[hit.instance];
  const SurfacePoint s = quadric_point(instance.kind, instance.to_object.point(ray.o), instance.to_object.vector(ray.d), hit.t);
  return glm::normalize(glm::transpose(instance.to_object.linear) * s.n);
}

TEST(AcceleratorLab, ThreeRaysTwoSpheresTwoPlanes) {
  const Geometry geometry = lab();
  const Expected table[] = {
      {make_ray({0, 0, 5}, {0, 0, -1}), 0, 4.0, {0, 0, 1}},
      {make_ray({1.5, 0, 5}, {0, 0, -2}), 1, (15.0 - std::sqrt(4.0 - 2.25)) / 2.0, {0.75, 0, std::sqrt(4.0 - 2.25) / 2.0}},
      {make_ray({5, 0, 0}, {0, -1, -1}), 3, 3.0, {0, 1, 0}},
  };
  for (const Contestant &c : all_accelerators(geometry))
    for (const Expected &e : table) {
      const Hit hit = closest(*c.accelerator, e.ray);
      ASSERT_EQ(hit.instance, e.instance) << c.name;
      EXPECT_EQ(hit.primitive, 0u);
      // Inputs are exact; the root and its division have a handful of roundings, 8 ulp.
      EXPECT_NEAR(hit.t, e.t, 8 * 0x1p-52 * e.t) << c.name;
      const glm::dvec3 n = world_normal(geometry, e.ray, hit);
      EXPECT_NEAR(glm::length(n - e.normal), 0.0, 16 * 0x1p-52) << c.name;
      EXPECT_TRUE(occluded(*c.accelerator, e.ray)) << c.name;
    }
}

TEST(AcceleratorLab, RangeIsRespectedAndOpen) {
  const Geometry geometry = lab();
  for (const Contestant &c : all_accelerators(geometry)) {
    // Down the z axis: 4 and 6 on the first sphere, 13 and 17 on the second, 25 on the plane; all exact in binary.
    Ray ray = make_ray({0, 0, 5}, {0, 0, -1});
    const double places[] = {4.0, 6.0, 13.0, 17.0, 25.0};
    for (const double place : places) {
      EXPECT_EQ(closest(*c.accelerator, ray).t, place) << c.name;
      ray.tmin = place;
    }
    EXPECT_FALSE(closest(*c.accelerator, ray).valid()) << c.name;
    EXPECT_FALSE(occluded(*c.accelerator, ray)) << c.name;

    // A shrinking tmax hides everything at or behind it.
    ray.tmin = 4.0;
    for (const double place : {25.0, 17.0, 13.0}) {
      ray.tmax = place;
      EXPECT_EQ(closest(*c.accelerator, ray).t, 6.0) << c.name;
    }
    ray.tmax = 6.0;
    EXPECT_FALSE(closest(*c.accelerator, ray).valid()) << c.name;
    EXPECT_FALSE(occluded(*c.accelerator, ray)) << c.name;
    ray.tmax = std::nextafter(6.0, 7.0);
    EXPECT_EQ(closest(*c.accelerator, ray).t, 6.0) << c.name;
    EXPECT_TRUE(occluded(*c.accelerator, ray)) << c.name;
  }
}

} // namespace
} // namespace lancer::test
