// Degenerate scenes and rays: the query returns and never hangs.
#include "accel_scenes.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(AcceleratorDegenerate, NothingToHit) {
  Geometry empty, hollow;
  hollow.meshes.emplace_back();
  hollow.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  for (const Geometry *geometry : {&empty, &hollow})
    for (const Contestant &c : all_accelerators(*geometry)) {
      EXPECT_FALSE(closest(*c.accelerator, make_ray({0, 0, 5}, {0, 0, -1})).valid()) << c.name;
      EXPECT_FALSE(occluded(*c.accelerator, make_ray({0, 0, 5}, {0, 0, -1}))) << c.name;
    }
}

TEST(AcceleratorDegenerate, OnlyPlanes) {
  Geometry geometry;
  for (int i = 0; i < 5; ++i)
    geometry.instances.push_back(placed(ShapeKind::Plane, glm::dmat3(1.0), glm::dvec3(0, 0, -i)));
  for (const Contestant &c : all_accelerators(geometry)) {
    Ray ray = make_ray({0, 0, 5}, {0, 0, -1});
    EXPECT_EQ(closest(*c.accelerator, ray).t, 5.0) << c.name;
    ray.skip_instance = ray.skip_primitive = 0;
    EXPECT_EQ(closest(*c.accelerator, ray).t, 6.0) << c.name;
    EXPECT_FALSE(occluded(*c.accelerator, make_ray({0, 0, 5}, {1, 0, 0}))) << c.name;
  }
}

TEST(AcceleratorDegenerate, NonFiniteRaysMeetNothing) {
  Random random(31);
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 16, 8, 0.1));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  geometry.instances.push_back(placed(ShapeKind::Sphere, glm::dmat3(1.0), glm::dvec3(3, 0, 0)));
  geometry.instances.push_back(placed(ShapeKind::Cone, glm::dmat3(1.0), glm::dvec3(0, 3, 0)));
  geometry.instances.push_back(placed(ShapeKind::Cylinder, glm::dmat3(1.0), glm::dvec3(0, -3, 0)));
  geometry.instances.push_back(placed(ShapeKind::Plane, glm::dmat3(1.0), glm::dvec3(0, 0, -3)));
  for (const Contestant &c : all_accelerators(geometry)) {
    for (const double bad : {kNaN, kInfinity, -kInfinity})
      for (int axis = 0; axis < 3; ++axis)
        for (const bool direction : {false, true}) {
          Ray ray = make_ray({0.1, 0.2, 0.0}, {0.3, 0.4, -1});
          (direction ? ray.d : ray.o)[axis] = bad;
          EXPECT_FALSE(closest(*c.accelerator, ray).valid()) << c.name << axis << direction << bad;
          EXPECT_FALSE(occluded(*c.accelerator, ray)) << c.name;
        }
    Ray ray = make_ray({0, 0, 5}, {0, 0, 0});
    EXPECT_FALSE(closest(*c.accelerator, ray).valid()) << c.name;
    ray.d.z = -1.0;
    EXPECT_TRUE(closest(*c.accelerator, ray).valid()) << c.name;
    ray.tmin = kNaN;
    EXPECT_FALSE(closest(*c.accelerator, ray).valid()) << c.name;
    ray.tmin = 0.0;
    ray.tmax = kNaN;
    EXPECT_FALSE(occluded(*c.accelerator, ray)) << c.name;
    ray.tmax = -1.0;
    EXPECT_FALSE(occluded(*c.accelerator, ray)) << c.name;
  }
}

// Nothing separates the triangles: the builders must stop splitting and still find the first.
TEST(AcceleratorDegenerate, AMillionCoincidentTriangles) {
  Geometry geometry;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles.assign(1000000, {0, 1, 2});
  geometry.meshes.push_back(mesh);
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  for (const AcceleratorKind kind : {AcceleratorKind::Bvh, AcceleratorKind::KdTree}) {
    const auto accelerator = build_accelerator(kind, geometry, {2, nullptr});
    const Hit hit = closest(*accelerator, make_ray({0, 0, 3}, {0, 0, -1}));
    EXPECT_EQ(hit.t, 3.0);
    EXPECT_EQ(hit.primitive, 0u);
    EXPECT_TRUE(occluded(*accelerator, make_ray({0, 0, 3}, {0, 0, -1})));
    EXPECT_FALSE(occluded(*accelerator, make_ray({2, 0, 3}, {0, 0, -1})));
  }
}

// Sizes in geometric progression make the surface-area heuristic split them off one by one: the deepest trees possible.
TEST(AcceleratorDegenerate, GeometricProgression) {
  Geometry geometry;
  Mesh mesh;
  for (uint32_t i = 0; i < 250; ++i) {
    const float s = std::exp2(-static_cast<float>(i) * 0.12f);
    mesh.positions.insert(mesh.positions.end(), {{s, 0, 0}, {s * 1.1f, 0, 0}, {s, s * 0.1f, 0}});
    for (int copy = 0; copy < 40; ++copy)
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  geometry.meshes.push_back(mesh);
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  for (const Contestant &c : all_accelerators(geometry))
    for (uint32_t i = 0; i < 250; i += 7) {
      const double s = mesh.positions[3 * i].x;
      const Hit hit = closest(*c.accelerator, make_ray({s * 1.02, s * 0.01, 3.0}, {0, 0, -1}));
      ASSERT_TRUE(hit.valid()) << c.name << " " << i;
      ASSERT_EQ(hit.primitive, 40 * i) << c.name;
    }
}

TEST(AcceleratorDegenerate, CancelledBuildThrows) {
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 64, 32, 0.1));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  const std::atomic<bool> cancel{true};
  for (const AcceleratorKind kind : {AcceleratorKind::Bvh, AcceleratorKind::KdTree})
    for (const uint32_t threads : {1u, 2u})
      EXPECT_THROW(build_accelerator(kind, geometry, {threads, &cancel}), BuildCancelled);
}

TEST(AcceleratorDegenerate, InstructionSetIsNamed) {
  const Geometry geometry;
#if defined(__x86_64__)
  const char *const told = "sse4";
#else
  // Other processors have one set, whatever the environment requests.
  const char *const told = "generic";
#endif
  EXPECT_STREQ(build_bvh_for("sse4", geometry, 1)->instruction_set(), told);
  EXPECT_NE(build_accelerator(AcceleratorKind::Bvh, geometry, {})->instruction_set(), nullptr);
}

} // namespace
} // namespace lancer::test
