// Brute force, kd-tree and the BVH of every instruction set return the same bits.
#include "accel_scenes.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Rays of all kinds: inside and outside, scaled, axis-parallel, bounded, with a primitive to skip.
Ray random_ray(Random &random, const Geometry &geometry, double size) {
  Ray ray = make_ray(random.in_box(size), random.direction());
  const glm::dvec3 target = random.in_box(0.6 * size);
  switch (random.below(4)) {
  case 0:
    ray.d = target - ray.o;
    break;
  case 1:
    ray.o *= std::exp2(random.uniform(0.0, 20.0));
    ray.d = target - ray.o;
    break;
  case 2:
    ray.d = glm::dvec3(0.0);
    ray.d[static_cast<int>(random.below(3))] = random.below(2) ? 1.0 : -1.0;
    break;
  default:
    break;
  }
  ray.d *= std::exp2(random.uniform(-30.0, 30.0));
  if (random.below(4) == 0) {
    ray.tmin = random.uniform(-1.0, 1.0) * size / glm::length(ray.d);
    ray.tmax = ray.tmin + random.uniform(0.0, 1.0) * size / glm::length(ray.d);
  }
  if (random.below(4) == 0) {
    ray.skip_instance = random.below(static_cast<uint32_t>(geometry.instances.size()));
    ray.skip_primitive = random.below(4);
  }
  return ray;
}

// Traces the same rays with all accelerators; the share of hits proves that the rays test something.
void expect_equal(const Geometry &geometry, const std::vector<Ray> &rays, double least_hits) {
  const std::vector<Contestant> all = all_accelerators(geometry);
  std::vector<Hit> oracle(rays.size()), hits(rays.size());
  std::vector<uint8_t> occlusion(rays.size());
  all[0].accelerator->closest_hit(rays, oracle);
  size_t hit_count = 0;
  for (const Hit &hit : oracle)
    hit_count += hit.valid();
  EXPECT_GE(static_cast<double>(hit_count), least_hits * static_cast<double>(rays.size()));
  for (const Contestant &c : all) {
    c.accelerator->closest_hit(rays, hits);
    c.accelerator->any_hit(rays, occlusion);
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(same_bits(hits[i], oracle[i]))
          << c.name << ", ray " << i << ": t " << hits[i].t << " instead of " << oracle[i].t << ", instance "
          << hits[i].instance << " instead of " << oracle[i].instance;
      ASSERT_EQ(occlusion[i], oracle[i].valid()) << c.name << ", ray " << i;
    }
  }
}

std::vector<Ray> random_rays(Random &random, const Geometry &geometry, size_t count, double size) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i)
    rays.push_back(random_ray(random, geometry, size));
  return rays;
}

TEST(AcceleratorsEqual, TriangleSoup) {
  Random random(1);
  for (const uint32_t count : {1u, 2u, 5u, 33u, 600u, 6000u}) {
    Geometry geometry;
    geometry.meshes.push_back(triangle_soup(random, count, 10.0));
    geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
    std::vector<Ray> rays = random_rays(random, geometry, 1500, 14.0);
    for (int i = 0; i < 1500; ++i) {
      const uint32_t aim = random.below(count);
      const Mesh &mesh = geometry.meshes[0];
      const glm::dvec3 o = random.in_box(14.0);
      rays.push_back(make_ray(o, glm::dvec3(mesh.vertex(aim, 0) + mesh.vertex(aim, 1) + mesh.vertex(aim, 2)) / 3.0 - o));
    }
    expect_equal(geometry, rays, 0.5); // the aimed half
  }
}

// A lattice of squares and rays along its lines: every box is touched at its faces, edges and corners.
TEST(AcceleratorsEqual, RaysAlongTheLattice) {
  Mesh mesh;
  constexpr uint32_t kSide = 9;
  for (uint32_t plane = 0; plane < 3; ++plane) {
    const uint32_t base = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t j = 0; j < kSide; ++j)
      for (uint32_t i = 0; i < kSide; ++i) {
        glm::vec3 p(static_cast<float>(i) - 4.0f, static_cast<float>(j) - 4.0f, 0.0f);
        mesh.positions.push_back(plane == 0 ? p : plane == 1 ? glm::vec3(p.y, p.z, p.x) : glm::vec3(p.z, p.x, p.y));
      }
    for (uint32_t j = 0; j + 1 < kSide; ++j)
      for (uint32_t i = 0; i + 1 < kSide; ++i) {
        const uint32_t a = base + j * kSide + i;
        mesh.triangles.push_back({a, a + 1, a + kSide});
        mesh.triangles.push_back({a + 1, a + kSide + 1, a + kSide});
      }
  }
  Geometry geometry;
  geometry.meshes.push_back(mesh);
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(-1.0), glm::dvec3(0.0)));
  Random random(2);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const auto lattice = [&] { return 0.5 * (static_cast<double>(random.below(21)) - 10.0); };
    const glm::dvec3 o(lattice(), lattice(), lattice()), target(lattice(), lattice(), lattice());
    if (o != target)
      rays.push_back(make_ray(o, target - o));
  }
  expect_equal(geometry, rays, 0.3);
}

glm::dmat3 random_linear(Random &random, double scale) {
  glm::dmat3 m;
  do {
    for (int column = 0; column < 3; ++column)
      m[column] = random.in_box(1.0);
  } while (std::abs(glm::determinant(m)) < 0.05);
  return m * scale; // half of them mirrored, all sheared
}

Geometry mixed_scene(Random &random, uint32_t count, double size, double smallest, const glm::dvec3 &place) {
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 12, 8, 0.2));
  geometry.meshes.push_back(triangle_soup(random, 60, 1.0));
  geometry.meshes.push_back(bumpy_sphere(1e-6, 9, 6, 0.2)); // scaled up by its placement
  for (uint32_t i = 0; i < count; ++i) {
    const ShapeKind kind = static_cast<ShapeKind>(i % 7 < 3 ? 0 : i % 7 == 6 ? 1 : i % 7 - 2);
    const uint32_t mesh = i % 3;
    const double scale = 0.5 * size * std::exp2(random.uniform(std::log2(smallest), 0.0));
    const double unit = kind == ShapeKind::Mesh && mesh == 2 ? 1e6 : 1.0;
    if (kind == ShapeKind::Plane && i > 14)
      continue;
    geometry.instances.push_back(placed(kind, random_linear(random, scale * unit), place + random.in_box(size), mesh));
  }
  return geometry;
}

TEST(AcceleratorsEqual, MixedInstances) {
  Random random(3);
  const Geometry geometry = mixed_scene(random, 80, 10.0, 1e-2, glm::dvec3(0.0));
  expect_equal(geometry, random_rays(random, geometry, 5000, 14.0), 0.5);
}

TEST(AcceleratorsEqual, ScaleRatioOfAMillion) {
  Random random(4);
  const Geometry geometry = mixed_scene(random, 80, 10.0, 1e-6, glm::dvec3(0.0));
  std::vector<Ray> rays = random_rays(random, geometry, 2500, 14.0);
  for (int i = 0; i < 2500; ++i) {
    // Aim at the centre of an instance, so that tiny ones are hit.
    const Instance &target = geometry.instances[random.below(static_cast<uint32_t>(geometry.instances.size()))];
    const glm::dvec3 o = random.in_box(14.0);
    rays.push_back(make_ray(o, target.to_world.translation - o));
  }
  expect_equal(geometry, rays, 0.5);
}

TEST(AcceleratorsEqual, FarFromTheOrigin) {
  Random random(5);
  const glm::dvec3 place(3e6, -7e6, 1e7);
  const Geometry geometry = mixed_scene(random, 80, 10.0, 1e-2, place);
  std::vector<Ray> rays = random_rays(random, geometry, 5000, 14.0);
  for (Ray &ray : rays)
    ray.o += place;
  expect_equal(geometry, rays, 0.5);
}

TEST(AcceleratorsEqual, AnyNumberOfThreadsBuildsTheSame) {
  Random random(6);
  Geometry geometry;
  geometry.meshes.push_back(triangle_soup(random, 90000, 10.0));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  for (const AcceleratorKind kind : {AcceleratorKind::Bvh, AcceleratorKind::KdTree}) {
    const auto one = build_accelerator(kind, geometry, {1, nullptr}), three = build_accelerator(kind, geometry, {3, nullptr});
    EXPECT_EQ(one->bytes(), three->bytes());
    const std::vector<Ray> rays = random_rays(random, geometry, 5000, 14.0);
    std::vector<Hit> a(rays.size()), b(rays.size());
    one->closest_hit(rays, a);
    three->closest_hit(rays, b);
    for (size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(same_bits(a[i], b[i])) << i;
  }
}

// Equal t: the smaller instance wins, then the smaller primitive, wherever the builder has put them.
TEST(AcceleratorsEqual, TiesGoToTheSmallerNumber) {
  Random random(7);
  Geometry geometry;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles.assign(40, {0, 1, 2});
  geometry.meshes.push_back(mesh);
  for (int i = 0; i < 20; ++i)
    geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  for (const Contestant &c : all_accelerators(geometry))
    for (int i = 0; i < 100; ++i) {
      Ray ray = make_ray({random.uniform(-0.3, 0.3), random.uniform(-0.6, -0.1), 3.0}, {0, 0, -1});
      const Hit hit = closest(*c.accelerator, ray);
      ASSERT_EQ(hit.instance, 0u) << c.name;
      ASSERT_EQ(hit.primitive, 0u) << c.name;
      ray.skip_instance = ray.skip_primitive = 0;
      ASSERT_EQ(closest(*c.accelerator, ray).primitive, 1u) << c.name;
    }
}

} // namespace
} // namespace lancer::test
