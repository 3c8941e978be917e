// No ray leaves a closed surface, at any position and size.
#include "accel_scenes.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Counts rays from inside that escape. They aim exactly at corners and midpoints of edges, where two or more triangles meet.
size_t count_leaks(const Accelerator &accelerator, const Geometry &geometry, double radius, size_t stride) {
  const Mesh &mesh = geometry.meshes[0];
  const Affine &to_world = geometry.instances[0].to_world;
  Random random(11);
  std::vector<Ray> rays;
  for (size_t triangle = 0; triangle < mesh.triangles.size(); triangle += stride)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 a = mesh.positions[mesh.triangles[triangle][corner]];
      const glm::dvec3 b = mesh.positions[mesh.triangles[triangle][(corner + 1) % 3]];
      for (const glm::dvec3 &aim : {a, 0.5 * (a + b)}) {
        const glm::dvec3 o = to_world.point(random.in_box(0.4 * radius));
        rays.push_back(make_ray(o, to_world.point(aim) - o));
      }
    }
  std::vector<Hit> hits(rays.size());
  std::vector<uint8_t> occlusion(rays.size());
  accelerator.closest_hit(rays, hits);
  accelerator.any_hit(rays, occlusion);
  size_t leaks = 0;
  for (size_t i = 0; i < rays.size(); ++i)
    leaks += !hits[i].valid() || !occlusion[i];
  return leaks;
}

void expect_watertight(double radius, const glm::dmat3 &linear, const glm::dvec3 &place) {
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(radius, 128, 64, 0.1));
  geometry.instances.push_back(placed(ShapeKind::Mesh, linear, place));
  for (const Contestant &c : all_accelerators(geometry))
    EXPECT_EQ(count_leaks(*c.accelerator, geometry, radius, c.name == "brute force" ? 397 : 1), 0u) << c.name;
}

const glm::dmat3 kSheared(glm::dvec3(0.7, 0.2, -0.4), glm::dvec3(-0.3, 1.1, 0.1), glm::dvec3(0.5, 0.2, -0.9));

TEST(Watertight, AtTheOrigin) { expect_watertight(2.0, glm::dmat3(1.0), glm::dvec3(0.0)); }
TEST(Watertight, Tiny) { expect_watertight(1e-6, glm::dmat3(1.0), glm::dvec3(0.0)); }
TEST(Watertight, Huge) { expect_watertight(1e9, glm::dmat3(1.0), glm::dvec3(0.0)); }
TEST(Watertight, Sheared) { expect_watertight(2.0, kSheared, glm::dvec3(1.0, 2.0, 3.0)); }
TEST(Watertight, AMillionRadiiAway) { expect_watertight(2.0, kSheared, glm::dvec3(1483760.0, 12340.0, -2234230.0)); }
TEST(Watertight, BroughtToSizeByItsPlacement) { expect_watertight(1e-6, glm::dmat3(1e15), glm::dvec3(1e9, 0.0, 0.0)); }

// From far outside, a million radii or two: every ray towards the centre of the sphere hits it.
TEST(Watertight, SeenFromFarAway) {
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 64, 32, 0.1));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  Random random(12);
  for (const Contestant &c : all_accelerators(geometry))
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 o = random.direction() * std::exp2(random.uniform(1.0, 20.0));
      const Hit hit = closest(*c.accelerator, make_ray(o, random.in_box(0.4) - o));
      ASSERT_TRUE(hit.valid()) << c.name;
      // d reaches the target, which is inside, at t = 1.
      ASSERT_LT(hit.t, 1.0) << c.name;
    }
}

} // namespace
} // namespace lancer::test
