// Coincident surfaces: a ray always hits the same one of them.
#include "accel_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Every face of a closed surface six times, with its corners in all orders: three face outwards, three inwards.
Mesh faces_in_all_orders(Random &random) {
  Mesh mesh = bumpy_sphere(1.0, 24, 12, 0.2);
  std::vector<glm::uvec3> all;
  for (const glm::uvec3 &t : mesh.triangles)
    all.insert(all.end(),
               {{t.x, t.y, t.z}, {t.y, t.z, t.x}, {t.z, t.x, t.y}, {t.x, t.z, t.y}, {t.z, t.y, t.x}, {t.y, t.x, t.z}});
  for (size_t i = all.size(); i > 1; --i)
    std::swap(all[i - 1], all[random.below(static_cast<uint32_t>(i))]);
  mesh.triangles = std::move(all);
  return mesh;
}

glm::uvec3 sorted(glm::uvec3 t) {
  uint32_t corner[3] = {t.x, t.y, t.z};
  std::sort(corner, corner + 3);
  return {corner[0], corner[1], corner[2]};
}

// Of faces with the same corners a ray hits the first: from outside, from inside, at edges, from any direction.
void expect_first(const glm::dmat3 &linear, const glm::dvec3 &place) {
  Random random(81);
  Geometry geometry;
  geometry.meshes.push_back(faces_in_all_orders(random));
  const Mesh &mesh = geometry.meshes[0];
  geometry.instances.push_back(placed(ShapeKind::Mesh, linear, place));
  // Rays into the surface and back out of it, and rays that hit it at an edge.
  std::vector<Ray> rays;
  for (int i = 0; i < 3000; ++i) {
    const uint32_t triangle = random.below(static_cast<uint32_t>(mesh.triangles.size()));
    const glm::dvec3 a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1), c = mesh.vertex(triangle, 2);
    const double u = random.uniform(0.0, 0.5), v = i % 3 ? random.uniform(0.0, 0.5) : 0.0;
    const glm::dvec3 aim = (1.0 - u - v) * a + u * b + v * c, o = random.direction() * std::exp2(random.uniform(-1.0, 8.0));
    const Affine &to_world = geometry.instances[0].to_world;
    rays.push_back(make_ray(to_world.point(o), to_world.point(aim) - to_world.point(o)));
  }
  std::vector<Hit> oracle;
  for (const Contestant &c : all_accelerators(geometry)) {
    std::vector<Hit> hits(rays.size());
    c.accelerator->closest_hit(rays, hits);
    size_t met = 0;
    for (const Hit &hit : hits) {
      if (!hit.valid())
        continue;
      ++met;
      const glm::uvec3 face = sorted(mesh.triangles[hit.primitive]);
      const auto first =
          std::find_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::uvec3 &t) { return sorted(t) == face; });
      ASSERT_EQ(first - mesh.triangles.begin(), hit.primitive) << c.name;
    }
    EXPECT_GT(met, rays.size() * 9 / 10) << c.name;
    if (oracle.empty())
      oracle = hits;
    for (size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(same_bits(hits[i], oracle[i])) << c.name;
  }
}

TEST(Coincident, TheFirstOfEqualFaces) {
  expect_first(glm::dmat3(1.0), glm::dvec3(0.0));
  expect_first({{0.7, 0.2, -0.4}, {-0.3, 1.1, 0.1}, {0.5, 0.2, -0.9}}, {1.0, 2.0, 3.0});
}

// Of coincident copies a ray hits the first, whatever the numbers in between.
TEST(Coincident, TheFirstOfEqualInstances) {
  Random random(82);
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 16, 8, 0.2));
  const ShapeKind kinds[] = {ShapeKind::Mesh, ShapeKind::Sphere, ShapeKind::Cylinder, ShapeKind::Cone};
  const glm::dmat3 turned({0.7, 0.2, -0.4}, {-0.3, 1.1, 0.1}, {0.5, 0.2, -0.9});
  for (uint32_t copy = 0; copy < 5; ++copy)
    for (uint32_t i = 0; i < 4; ++i)
      geometry.instances.push_back(placed(kinds[i], turned, {4.0 * i, 0.0, 0.0}));
  for (const Contestant &c : all_accelerators(geometry))
    for (int i = 0; i < 2000; ++i) {
      const uint32_t target = random.below(4);
      const glm::dvec3 o = random.in_box(20.0), aim = glm::dvec3(4.0 * target, 0.0, 0.0) + turned * random.in_box(0.2);
      const Hit hit = closest(*c.accelerator, make_ray(o, aim - o));
      ASSERT_TRUE(hit.valid());
      ASSERT_LT(hit.instance, 4u) << c.name;
    }
}

// LANCER_TEST_RAYS: ten times as many.
TEST(Coincident, ThousandsOfInstancesAtOnePlace) {
  const uint32_t count = std::getenv("LANCER_TEST_RAYS") ? 1000000 : 100000;
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 8, 4, 0.0));
  for (const ShapeKind kind : {ShapeKind::Mesh, ShapeKind::Sphere, ShapeKind::Cone}) {
    geometry.instances.assign(count, placed(kind, glm::dmat3(1.0), glm::dvec3(0.0)));
    for (const AcceleratorKind accelerator : {AcceleratorKind::Bvh, AcceleratorKind::KdTree}) {
      const auto all = build_accelerator(accelerator, geometry, {2, nullptr});
      const Ray towards = make_ray({0.1, 0.2, 5.0}, {0, 0, -1});
      EXPECT_EQ(closest(*all, towards).instance, 0u);
      EXPECT_TRUE(occluded(*all, towards));
      EXPECT_FALSE(occluded(*all, make_ray({3, 0, 5}, {0, 0, -1})));
    }
  }
}

} // namespace
} // namespace lancer::test
