// Displacement of shared meshes, by invalid offsets, and with faces that collapse.
#include "allocations.h"
#include "nodes_lab.h"

#include "compile/steps.h"
#include "scene/surface.h"

#include <cmath>

using namespace lancer_test;

namespace {

const float kCorners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const uint32_t kHalves[] = {0, 1, 2, 0, 2, 3};

// A unit square of two triangles.
lancer_mesh square() {
  lancer_mesh mesh = {};
  mesh.name = "square";
  mesh.positions = kCorners;
  mesh.triangles = kHalves;
  mesh.vertex_count = 4;
  mesh.triangle_count = 2;
  return mesh;
}

void add_moving(Description &description, const char *name, lancer_parameter displacement,
                const std::vector<lancer_node> &nodes = {}) {
  lancer_material material = black();
  material.name = name;
  material.nodes = nodes.data();
  material.node_count = uint32_t(nodes.size());
  material.displacement = displacement;
  add_material(description, material);
}

void place(Description &description, const std::vector<uint32_t> &materials) {
  Instance instance;
  instance.first_slot = uint32_t(description.slots.size());
  instance.slot_count = uint32_t(materials.size());
  description.slots.insert(description.slots.end(), materials.begin(), materials.end());
  description.instances.push_back(instance);
}

const Mesh &mesh_of(const Description &description, uint32_t instance) {
  return *description.meshes[description.instances[instance].mesh];
}

TEST(DisplaceMeshes, EachInstanceGoesWhereItsOwnMaterialsSay) {
  for (const bool still_first : {true, false}) {
    Description description;
    add_moving(description, "still", constant(0.0f));
    add_moving(description, "also still", constant(0.0f));
    add_moving(description, "up", constant(0, 0, 2));
    add_moving(description, "down", constant(0, 0, -1));
    add_mesh(description, square());
    const std::vector<uint32_t> order =
        still_first ? std::vector<uint32_t>{0, 2, 1, 3, 2} : std::vector<uint32_t>{2, 0, 3, 2, 1};
    for (const uint32_t material : order)
      place(description, {material});
    displace(description, BuildContext{});
    const float height[] = {0.0f, 0.0f, 2.0f, -1.0f};
    for (uint32_t i = 0; i < order.size(); ++i)
      for (const glm::vec3 &p : mesh_of(description, i).positions)
        EXPECT_EQ(p.z, height[order[i]]) << "instance " << i;
    // Instances with equal displacement share a mesh: one for still, up and down each.
    EXPECT_EQ(description.meshes.size(), 3u);
  }
}

TEST(DisplaceMeshes, OnlySlotsThatOccurCount) {
  // Both have the same material on the mesh's faces: its second slot.
  const uint16_t slots[] = {1, 1};
  lancer_mesh mesh = square();
  mesh.material_slots = slots;
  Description description;
  add_moving(description, "up", constant(0, 0, 2));
  add_moving(description, "down", constant(0, 0, -1));
  add_mesh(description, mesh);
  place(description, {0, 1});
  place(description, {1, 1});
  displace(description, BuildContext{});
  EXPECT_EQ(description.meshes.size(), 1u);
  EXPECT_EQ(mesh_of(description, 0).positions[0].z, -1.0f);
}

TEST(DisplaceMeshes, WhatNoVertexCanHaveIsSaid) {
  // exp(100) overflows float; 1e30 exceeds the largest coordinate.
  Description description;
  add_moving(description, "wild", result_of(0), {node(LANCER_NODE_MATH, LANCER_MATH_EXPONENT, {constant(100.0f)})});
  add_moving(description, "far", constant(0, 0, 1e30f));
  const uint16_t slots[] = {0, 1};
  lancer_mesh mesh = square();
  mesh.material_slots = slots;
  add_mesh(description, mesh);
  place(description, {0, 1});
  displace(description, BuildContext{});
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(mesh_of(description, 0).positions[i], glm::vec3(kCorners[3 * i], kCorners[3 * i + 1], 0.0f));
  EXPECT_EQ(description.messages(),
            "mesh 'square': 3 vertices of material 'wild' were not moved: their displacement is not finite or too large\n"
            "mesh 'square': 3 vertices of material 'far' were not moved: their displacement is not finite or too large\n");
}

TEST(DisplaceMeshes, MessagesNameTheMeshAsGiven) {
  // The third instance displaces a copy of the first mesh.
  Description description;
  add_moving(description, "up", constant(0, 0, 2));
  add_moving(description, "far", constant(0, 0, 1e30f));
  lancer_mesh mesh = square();
  mesh.name = nullptr;
  add_mesh(description, mesh);
  add_mesh(description, mesh);
  for (const uint32_t material : {0, 0, 1}) {
    place(description, {material});
    description.instances.back().mesh = description.instances.size() == 2 ? 1 : 0;
  }
  displace(description, BuildContext{});
  EXPECT_EQ(description.meshes.size(), 3u);
  EXPECT_EQ(description.messages(),
            "mesh #0: 4 vertices of material 'far' were not moved: their displacement is not finite or too large\n");
}

TEST(DisplaceMeshes, AMeshThatDoesNotMoveCostsNoAllocationForEachFace) {
  std::vector<uint64_t> counts;
  for (const uint32_t faces : {2u, 2000u}) {
    // The two halves repeatedly, with two alternating materials.
    std::vector<uint32_t> triangles;
    std::vector<uint16_t> slots;
    for (uint32_t i = 0; i < faces; ++i) {
      triangles.insert(triangles.end(), kHalves + i % 2 * 3, kHalves + i % 2 * 3 + 3);
      slots.push_back(uint16_t(i % 2));
    }
    lancer_mesh mesh = square();
    mesh.triangles = triangles.data();
    mesh.triangle_count = faces;
    mesh.material_slots = slots.data();
    Description description;
    add_moving(description, "still", constant(0.0f));
    add_mesh(description, mesh);
    place(description, {0, 0});
    const Allocations allocations;
    displace(description, BuildContext{});
    counts.push_back(allocations.count());
  }
  EXPECT_EQ(counts[0], counts[1]);
}

TEST(DisplaceMeshes, FoldedFacesAreLeftOutWithAllThatIsTheirs) {
  // The corner at (1, 0) moves to (0, 0): the first half collapses to a line.
  const float uvs[] = {0, 0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0}, weights[] = {7, 8}, heights[] = {1, 2, 3, 4};
  const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  const uint16_t slots[] = {0, 1};
  const lancer_attribute attributes[] = {{"weight", weights, LANCER_DOMAIN_FACE, 1},
                                         {"height", heights, LANCER_DOMAIN_VERTEX, 1}};
  lancer_mesh mesh = square();
  mesh.uvs = uvs;
  mesh.normals = normals;
  mesh.normal_domain = LANCER_NORMALS_CORNER;
  mesh.material_slots = slots;
  mesh.attributes = attributes;
  mesh.attribute_count = 2;
  Description description;
  const std::vector<lancer_node> nodes = {
      node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_DOT_PRODUCT, {result_of(0), constant(1, -1, 0)}),
      node(LANCER_NODE_MATH, LANCER_MATH_MAXIMUM, {result_of(1), constant(0.0f)}),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY, {result_of(2), constant(-1, 0, 0)})};
  add_moving(description, "fold", result_of(3), nodes);
  add_moving(description, "still", constant(0.0f));
  add_mesh(description, mesh);
  place(description, {0, 1});
  displace(description, BuildContext{});
  const Mesh &left = mesh_of(description, 0);
  ASSERT_EQ(left.triangles.size(), 1u);
  EXPECT_EQ(left.triangles[0], glm::uvec3(0, 2, 3));
  EXPECT_EQ(left.face_of, std::vector<uint32_t>{1});
  EXPECT_EQ(left.uvs, (std::vector<glm::vec2>{{3, 0}, {4, 0}, {5, 0}}));
  EXPECT_EQ(left.normals.size(), 3u);
  EXPECT_EQ(left.material_slots, std::vector<uint16_t>{1});
  EXPECT_EQ(values_of(left, 0), std::vector<float>{8});
  EXPECT_EQ(values_of(left, 1), (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(description.messages(),
            "mesh 'square': 1 faces of material 'fold' that displacement leaves without area were left out\n");
}

TEST(DisplaceMeshes, VerticesWithoutANormalTakeTheGeometricOne) {
  const float normals[] = {0, 0, 1, 0, 0, 0, 0, 0, 1, NAN, 0, 1};
  lancer_mesh mesh = square();
  mesh.normals = normals;
  mesh.normal_domain = LANCER_NORMALS_VERTEX;
  Description description;
  add_moving(description, "up", result_of(0),
             {node(LANCER_NODE_DISPLACEMENT, 0, {constant(1.0f), constant(0.0f), constant(1.0f)})});
  add_mesh(description, mesh);
  place(description, {0});
  displace(description, BuildContext{});
  for (const glm::vec3 &p : mesh_of(description, 0).positions)
    EXPECT_EQ(p.z, 1.0f);
}

TEST(DisplaceMeshes, CanBeCancelled) {
  Description description;
  add_moving(description, "up", constant(0, 0, 2));
  add_mesh(description, square());
  place(description, {0});
  std::atomic<bool> cancel{true};
  EXPECT_THROW(displace(description, BuildContext{.cancel = &cancel}), BuildCancelled);
}

TEST(DisplaceMeshes, NoNameMeansTheVerticesAsTheyWere) {
  // Half of x as height, over the undisplaced surface, for any attributes of the user.
  const float zeros[4] = {};
  for (const char *name : {"position", "undisplaced position "}) {
    const lancer_attribute attribute = {name, zeros, LANCER_DOMAIN_VERTEX, 1};
    lancer_mesh mesh = square();
    mesh.attributes = &attribute;
    mesh.attribute_count = 1;
    Stage stage(mesh, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    stage.footprint = 0x1p-8f;
    const lancer_node bump =
        node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(1), constant(0.0f), constant(1.0f)});
    const glm::vec3 n(stage.value(
        {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT),
         node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_DOT_PRODUCT, {result_of(0), constant(0.5f, 0, 0)}), flagged(bump, 2)}));
    // Heights are differences of floats of order 1 over a step of 2^-8: a few times 2^-24 over this.
    expect_near(n, glm::normalize(glm::vec3(-0.5f, 0.0f, 1.0f)), 1e-4f);
  }
}

} // namespace
