// Placements that flatten: maps of the plane, and what lies in it.
#include "compile/scene.h"
#include "compile/steps.h"
#include "nodes_lab.h"
#include "scene/affine.h"
#include "scene/description.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lancer_test {
namespace {

Affine map_of(const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c) {
  return {glm::dmat3(a, b, c), glm::dvec3(3.0, -2.0, 5.0)};
}

// Turned and scaled; the last column is a sum of the others in `sheared`.
const Affine kAlongAxis = map_of({0.6, 0.8, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, -3.0});
const Affine kSheared = map_of({1.0, 0.5, 0.2}, {-0.3, 2.0, 0.4}, {0.7, 2.5, 0.6});
// Far from 1 along both axes that are left.
const Affine kSmall = map_of({1e-20, 0.0, 0.0}, {0.0, 1e20, 0.0}, {0.0, 0.0, 0.0});

TEST(FlatObjects, AMapOfThePlaneGetsAnInverse) {
  for (const Affine &map : {kAlongAxis, kSheared, kSmall}) {
    ASSERT_TRUE(is_singular(map.linear));
    const std::optional<FlatMap> flat = flat_map(map);
    ASSERT_TRUE(flat.has_value());
    EXPECT_FALSE(is_singular(flat->map.linear));
    EXPECT_GT(glm::determinant(flat->map.linear), 0.0);
    EXPECT_NEAR(glm::length(flat->axis), 1.0, 1e-15);
    EXPECT_EQ(flat->map.translation, map.translation);
    // In the plane across the axis both maps agree, to the rounding of the axis, which the largest column enlarges.
    const glm::dvec3 any = std::abs(flat->axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(flat->axis, any)), v = glm::cross(flat->axis, u);
    for (const glm::dvec3 &p : {u, v, 0.3 * u - 2.0 * v}) {
      const double size = glm::length(map.linear[0]) + glm::length(map.linear[1]) + glm::length(map.linear[2]);
      EXPECT_LE(glm::length(flat->map.vector(p) - map.vector(p)), 1e-14 * size);
    }
    // What the map loses.
    EXPECT_LE(glm::length(map.vector(flat->axis)), 1e-14 * glm::length(map.linear[0] + map.linear[1] + map.linear[2]));
  }
}

TEST(FlatObjects, AScaleOfZeroLosesExactlyItsAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    Affine map = map_of({0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6});
    map.linear[axis] = glm::dvec3(0.0);
    glm::dvec3 expected(0.0);
    expected[axis] = 1.0;
    EXPECT_EQ(glm::abs(flat_map(map)->axis), expected);
  }
}

TEST(FlatObjects, ALineIsNoPlane) {
  EXPECT_FALSE(flat_map(map_of({1, 2, 3}, {0, 0, 0}, {0, 0, 0})).has_value());
  EXPECT_FALSE(flat_map(map_of({1, 2, 3}, {2, 4, 6}, {-3, -6, -9})).has_value());
  EXPECT_FALSE(flat_map(map_of({0, 0, 0}, {0, 0, 0}, {0, 0, 0})).has_value());
  EXPECT_FALSE(is_singular(glm::dmat3(1e-9)));
}

// A roof over the unit square with a wall below it, smooth, with tangents and places before displacement.
const float kPositions[] = {0, 0, 1, 1, 0, 2, 0, 1, 1, 1, 1, 3, 1, 0, 0};
const uint32_t kTriangles[] = {0, 1, 2, 2, 1, 3, 1, 4, 0};

lancer_mesh roof(const float *normals, const lancer_attribute *tangents) {
  lancer_mesh mesh = {};
  mesh.name = "roof";
  mesh.positions = kPositions;
  mesh.triangles = kTriangles;
  mesh.vertex_count = 5;
  mesh.triangle_count = 3;
  mesh.normals = normals;
  mesh.normal_domain = LANCER_NORMALS_VERTEX;
  mesh.attributes = tangents;
  mesh.attribute_count = 1;
  return mesh;
}

lancer_instance placed(const std::vector<double> &rows, uint32_t kind = LANCER_MESH) {
  lancer_instance instance = {};
  std::copy(rows.begin(), rows.end(), instance.matrix);
  instance.kind = kind;
  return instance;
}

const std::vector<double> kFlat = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 7};

TEST(FlatObjects, AMeshLiesInThePlane) {
  const float normals[] = {0, 0.6f, 0.8f, 0, 0.6f, -0.8f, 1, 0, 0, 0, 0, 1, 0, -1, 0};
  const float tangents[] = {1, 0, 0.5f, 1, 1, 0, 0.5f, 1, 1, 0, 0.5f, 1, 1, 0, 0.5f, -1, 1, 0, 0.5f, 1};
  const lancer_attribute attribute = {"tangent:", tangents, LANCER_DOMAIN_VERTEX, 4};
  Description description;
  // A node that reads generated coordinates.
  const lancer_node generated = node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED);
  lancer_material material = black();
  material.nodes = &generated;
  material.node_count = 1;
  add_material(description, material);
  add_mesh(description, roof(normals, &attribute));
  const lancer_instance instances[] = {placed(kFlat), placed({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}), placed(kFlat)};
  add_instances(description, 3, instances, 0, nullptr, nullptr, 0);
  ASSERT_EQ(description.instances.size(), 3u);
  EXPECT_EQ(description.messages(), "");
  MadeMeshes made;
  flatten(description, BuildContext{}, made);
  // One copy for all that lie in the same plane; the other keeps its own.
  const std::vector<Instance> &found = description.instances;
  EXPECT_EQ(found[0].mesh, 1u);
  EXPECT_EQ(found[1].mesh, 0u);
  EXPECT_EQ(found[2].mesh, 1u);
  EXPECT_EQ(description.meshes.size(), 2u);
  EXPECT_EQ(description.meshes[0]->positions[3].z, 3.0f);
  const Mesh &mesh = *description.meshes[1];
  for (size_t i = 0; i < 5; ++i)
    EXPECT_EQ(mesh.positions[i], glm::vec3(kPositions[3 * i], kPositions[3 * i + 1], 0.0f));
  // The wall is seen edge-on.
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, -1));
  EXPECT_EQ(mesh.normals[2], glm::vec3(0.0f));
  const std::vector<float> laid = values_of(mesh, 0);
  EXPECT_EQ(std::vector<float>(laid.begin(), laid.begin() + 4), (std::vector<float>{1, 0, 0, 1}));
  // Generated coordinates are those before.
  const std::vector<float> before = values_of(mesh, 1);
  EXPECT_EQ(before[2], float(1.0 / 3.0));
  EXPECT_EQ(before[11], 1.0f);
}

TEST(FlatObjects, OnlyWhatHasNoAreaIsLeftOut) {
  Description description;
  const float normals[15] = {};
  const lancer_attribute none = {"any", normals, LANCER_DOMAIN_VERTEX, 3};
  add_mesh(description, roof(normals, &none));
  const std::vector<double> line = {1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0};
  const lancer_instance instances[] = {placed(line), placed(kFlat, LANCER_SPHERE), placed(kFlat, LANCER_PLANE),
                                       placed({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, LANCER_PLANE),
                                       placed({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0})};
  add_instances(description, 5, instances, 0, nullptr, nullptr, 0);
  // A plane has no thickness to lose; across the wall the roof is a line, and along it the wall is left.
  ASSERT_EQ(description.instances.size(), 2u);
  EXPECT_EQ(description.instances[0].kind, ShapeKind::Plane);
  EXPECT_EQ(description.instances[0].to_world.linear[0], glm::dvec3(2, 0, 0));
  EXPECT_EQ(description.messages(),
            "object #0: its matrix is singular and leaves it no area; it was left out\n"
            "object #1: its matrix is singular (a scale of 0), which no exact shape can have; it was left out\n"
            "object #3: its matrix is singular and leaves it no area; it was left out\n");
}

} // namespace
} // namespace lancer_test
