// Rays that a thread traces together do not influence each other.
#include "accel_scenes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace lancer::test {
namespace {

std::vector<Ray> some_rays(Random &random, size_t count) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    Ray ray = make_ray(random.in_box(12.0), random.direction());
    ray.kinds = 1 + random.below(3);
    if (random.below(3) == 0)
      ray.tmax = random.uniform(-1.0, 10.0);
    if (random.below(9) == 0)
      ray.d = glm::dvec3(0.0);
    rays.push_back(ray);
  }
  return rays;
}

const char *const kInstructionSets[] = {"sse4", "avx2", "avx512"};

TEST(AcceleratorInterleaved, AnyBatchSizeAndOrderGiveTheSame) {
  Random random(11);
  const Geometry geometry = everything(random, 40, 3000, 8.0);
  for (const char *instruction_set : kInstructionSets) {
    const auto bvh = build_bvh_for(instruction_set, geometry, 1);
    const std::vector<Ray> rays = some_rays(random, 400);
    std::vector<Hit> alone(rays.size());
    std::vector<uint8_t> alone_occluded(rays.size());
    size_t found = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      alone[i] = closest(*bvh, rays[i]);
      alone_occluded[i] = occluded(*bvh, rays[i]);
      found += alone[i].valid();
      ASSERT_EQ(alone[i].valid(), alone_occluded[i] == 1);
    }
    EXPECT_GT(found, rays.size() / 4);
    EXPECT_LT(found, rays.size());
    std::vector<size_t> order(rays.size());
    std::iota(order.begin(), order.end(), size_t{0});
    for (size_t size = 0; size <= 100; size += size < 17 ? 1 : 83) {
      for (size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random.below(static_cast<uint32_t>(i))]);
      for (size_t first = 0; first < rays.size(); first += std::max<size_t>(size, 100)) {
        std::vector<Ray> batch;
        for (size_t i = 0; i < size; ++i)
          batch.push_back(rays[order[first + i]]);
        // An extra element at the end must stay unchanged.
        std::vector<Hit> hits(size + 1);
        std::vector<uint8_t> occlusion(size + 1, 7);
        hits[size].instance = 12345;
        bvh->closest_hit(batch, {hits.data(), size});
        bvh->any_hit(batch, {occlusion.data(), size});
        for (size_t i = 0; i < size; ++i) {
          ASSERT_TRUE(same_bits(hits[i], alone[order[first + i]])) << instruction_set << ", " << i << " of " << size;
          ASSERT_EQ(occlusion[i], alone_occluded[order[first + i]]) << instruction_set << ", " << i << " of " << size;
        }
        ASSERT_EQ(hits[size].instance, 12345u);
        ASSERT_EQ(occlusion[size], 7);
      }
    }
  }
}

// Rays of a small camera: neighbours are adjacent, with four samples per pixel. Some differ in every field of a ray.
std::vector<Ray> camera_rays(Random &random, const glm::dvec3 &eye, const glm::dvec3 &to, double spread, size_t count) {
  const glm::dvec3 forward = glm::normalize(to - eye), right = glm::normalize(glm::cross(forward, glm::dvec3(0.1, 0.2, 1.0))),
                   up = glm::cross(right, forward);
  const double length = std::exp2(random.uniform(-3.0, 3.0));
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i % 64) / 64.0 - 0.5, y = static_cast<double>(i / 64) / 64.0 - 0.5;
    Ray ray = make_ray(eye, length * (forward + spread * (x * right + y * up)));
    switch (random.below(16)) {
    case 0:
      ray.kinds = 1;
      break;
    case 1:
      ray.tmax = random.uniform(5.0, 20.0) / length;
      break;
    case 2:
      ray.tmin = random.uniform(5.0, 20.0) / length;
      break;
    case 3:
      ray.o += 0.01 * random.direction();
      break;
    case 4:
      ray.d *= random.uniform(0.1, 9.0);
      break;
    default:
      break;
    }
    if (random.below(200) == 0)
      ray.d = glm::dvec3(0.0);
    rays.push_back(ray);
  }
  return rays;
}

// Neighbours that traverse the tree together, through mirrored, rotated and flattened instances.
TEST(AcceleratorInterleaved, NeighboursGiveTheSameAsEachAlone) {
  Random random(12);
  Geometry geometry = everything(random, 40, 3000, 8.0);
  for (int i = 0; i < 60; ++i) {
    const glm::dmat3 turned(random.direction(), 0.7 * random.direction(), -random.direction());
    geometry.instances.push_back(placed(ShapeKind::Mesh, turned, random.in_box(8.0), i % 3 == 0 ? 2 : 0));
    if (i % 7 == 0)
      geometry.instances.back().hidden_from = 1;
    geometry.instances.push_back(placed(ShapeKind::Sphere, glm::dmat3(0.3), random.in_box(8.0)));
  }
  for (const char *instruction_set : kInstructionSets) {
    const auto bvh = build_bvh_for(instruction_set, geometry, 1);
    for (int view = 0; view < 60; ++view) {
      const double spread = std::exp2(-(view % 12));
      const glm::dvec3 eye = view % 3 == 0 ? random.in_box(8.0) : 20.0 * random.direction();
      std::vector<Ray> rays = camera_rays(random, eye, random.in_box(4.0), spread, 1000);
      size_t found = 0;
      for (int round = 0; round < 2; ++round) {
        std::vector<Hit> hits(rays.size());
        std::vector<uint8_t> occlusion(rays.size());
        bvh->closest_hit(rays, hits);
        bvh->any_hit(rays, occlusion);
        for (size_t i = 0; i < rays.size(); ++i) {
          ASSERT_TRUE(same_bits(hits[i], closest(*bvh, rays[i]))) << instruction_set << ", " << i << " of view " << view;
          ASSERT_EQ(occlusion[i], hits[i].valid()) << instruction_set << ", " << i << " of view " << view;
          found += hits[i].valid();
        }
        // The second pass skips the surfaces hit, from the same origins and, for some rays, from the hit.
        for (size_t i = 0; i < rays.size(); ++i)
          if (hits[i].valid()) {
            rays[i].skip_instance = hits[i].instance;
            rays[i].skip_primitive = hits[i].primitive;
            if (view % 2 == 0)
              rays[i].o += hits[i].t * rays[i].d;
          }
      }
      EXPECT_GT(found, rays.size() / 8);
    }
  }
}

// One quad of two triangles: a ray that hits it visits one node and one block; a ray that misses its box visits the node only.
TEST(AcceleratorInterleaved, WorkIsCounted) {
  Geometry geometry;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  geometry.meshes.push_back(mesh);
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  geometry.instances.push_back(placed(ShapeKind::Sphere, glm::dmat3(1.0), {0.0, 8.0, 0.0}));
  geometry.instances.push_back(placed(ShapeKind::Cone, glm::dmat3(1.0), {0.0, 16.0, 0.0}));
  const std::vector<Ray> rays = {make_ray({0.3, 0.1, 5.0}, {0, 0, -1}), make_ray({0.3, 4.0, 5.0}, {0, 0, -1}),
                                 make_ray({0.1, 8.0, 5.0}, {0, 0, -1}), make_ray({0.1, 15.5, 5.0}, {0, 0, -1})};
  for (const char *instruction_set : kInstructionSets)
    for (const bool any : {false, true}) {
      const TraversalCounts counts = build_bvh_for(instruction_set, geometry, 1)->count(rays, any);
      EXPECT_EQ(counts.nodes, 4u);
      EXPECT_EQ(counts.triangle_blocks, 1u);
      EXPECT_EQ(counts.sphere_blocks, 1u);
      EXPECT_EQ(counts.instances, 1u);
    }
}

// More unbounded instances than a stack holds.
TEST(AcceleratorInterleaved, AnyNumberOfPlanes) {
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, 9, 6, 0.0));
  for (int i = 0; i < 3000; ++i)
    geometry.instances.push_back(placed(ShapeKind::Plane, glm::dmat3(1.0), {0.0, 0.0, -3.0 - i}));
  geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), {0.0, 0.0, 0.0}, 0));
  for (const char *instruction_set : kInstructionSets) {
    const auto bvh = build_bvh_for(instruction_set, geometry, 1);
    EXPECT_EQ(closest(*bvh, make_ray({0.1, 0.1, 9.0}, {0, 0, -1})).instance, 3000u);
    EXPECT_EQ(closest(*bvh, make_ray({5.0, 0.1, 9.0}, {0, 0, -1})).t, 12.0);
    EXPECT_EQ(closest(*bvh, make_ray({5.0, 0.1, -4000.0}, {0, 0, 1})).t, 1.0 + 4000.0 - 3003.0);
  }
}

} // namespace
} // namespace lancer::test
