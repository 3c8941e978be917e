// Boxes of instances: they contain the instance and are tight.
#include "accel/placed_scene.h"
#include "accel_scenes.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Any rotation and any stretch.
glm::dmat3 turned(Random &random) {
  const glm::dvec3 x = random.direction(), y = glm::normalize(glm::cross(x, random.direction()));
  return {x, y, glm::cross(x, y)};
}

// An instance's box in the world.
struct WorldBox {
  glm::dvec3 lo, hi;
};
WorldBox box_of(const PlacedScene &scene, uint32_t bounded) {
  WorldBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = double(scene.boxes[bounded].lo[axis]) / scene.world.scale + scene.world.centre[axis];
    box.hi[axis] = double(scene.boxes[bounded].hi[axis]) / scene.world.scale + scene.world.centre[axis];
  }
  return box;
}

TEST(PlacedScene, BoxesHoldTheirMeshes) {
  Random random(3);
  Geometry geometry;
  geometry.meshes = {bumpy_sphere(1.0, 12, 7, 0.3), bumpy_sphere(0.2, 5, 4, 0.0), bumpy_sphere(3.0, 9, 6, 0.6)};
  for (uint32_t i = 0; i < 40; ++i) {
    glm::dmat3 linear = turned(random) * random.uniform(0.01, 5.0);
    linear[i % 3] *= random.uniform(-3.0, 3.0);
    geometry.instances.push_back(placed(ShapeKind::Mesh, linear, random.in_box(100.0), i == 0 ? 0 : 1 + i % 2));
  }
  const PlacedScene scene = place_scene(geometry);
  ASSERT_EQ(scene.boxes.size(), geometry.instances.size());
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    const WorldBox box = box_of(scene, i);
    for (const glm::vec3 &p : geometry.meshes[geometry.instances[i].mesh].positions) {
      const glm::dvec3 at = geometry.instances[i].to_world.point(glm::dvec3(p));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.lo[axis], at[axis]) << i;
        EXPECT_GE(box.hi[axis], at[axis]) << i;
      }
    }
  }
}

TEST(PlacedScene, TurnedCopiesHaveNarrowBoxes) {
  Random random(4);
  Geometry geometry;
  geometry.meshes = {bumpy_sphere(1.0, 48, 24, 0.0)};
  for (int i = 0; i < 100; ++i)
    geometry.instances.push_back(placed(ShapeKind::Mesh, turned(random), glm::dvec3(0.0)));
  const PlacedScene scene = place_scene(geometry);
  // Cut into four along each axis, the ball lies in boxes whose farthest corner, of boxes with points that have two coordinates
  // of at least a half and one of at most a half, is at sqrt(3/4 + 3/4 + 1/4). A single box would reach to sqrt(3).
  for (uint32_t i = 0; i < 100; ++i) {
    const WorldBox box = box_of(scene, i);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(box.hi[axis], std::sqrt(1.75) + 2.0 * double(kBoxPad) / scene.world.scale);
      EXPECT_GE(box.lo[axis], -std::sqrt(1.75) - 2.0 * double(kBoxPad) / scene.world.scale);
    }
  }
}

TEST(PlacedScene, WhatHasNoPlaceHasNoBox) {
  Geometry geometry;
  Mesh &mesh = geometry.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {10, 10, 0}, {10, 10, 1}};
  mesh.triangles = {{0, 1, 2}};
  for (int i = 0; i < 2; ++i)
    geometry.instances.push_back(placed(ShapeKind::Mesh, glm::dmat3(1.0), glm::dvec3(0.0)));
  // For two corners x is the difference of two products beyond the range of double.
  geometry.instances[1].to_world.linear[0].x = 1e308;
  geometry.instances[1].to_world.linear[1].x = -1e308;
  const PlacedScene scene = place_scene(geometry);
  EXPECT_EQ(scene.bounded, std::vector<uint32_t>{0});
  EXPECT_EQ(scene.unbounded, std::vector<uint32_t>{1});
}

} // namespace
} // namespace lancer::test
