// True displacement: vertices move as the nodes specify, and normals follow.
#include "nodes_lab.h"

#include "compile/steps.h"

#include <cmath>

using namespace lancer_test;

namespace {

constexpr int kSide = 17;

// A square grid over 0 ... 1 in z = 0, with normals or without.
struct Grid {
  std::vector<float> positions, normals;
  std::vector<uint32_t> triangles;
  std::vector<uint16_t> slots;

  Grid() {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        positions.insert(positions.end(), {float(x) / (kSide - 1), float(y) / (kSide - 1), 0.0f});
        normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
      }
    for (int y = 0; y + 1 < kSide; ++y)
      for (int x = 0; x + 1 < kSide; ++x) {
        const uint32_t a = uint32_t(y * kSide + x), b = a + 1, c = b + kSide, d = a + kSide;
        triangles.insert(triangles.end(), {a, b, c, a, c, d});
        slots.insert(slots.end(), 2, uint16_t(x < (kSide - 1) / 2 ? 0 : 1));
      }
  }

  lancer_mesh mesh(uint32_t domain) const {
    lancer_mesh m = {};
    m.name = "grid";
    m.positions = positions.data();
    m.triangles = triangles.data();
    m.material_slots = slots.data();
    m.normals = domain == LANCER_NORMALS_NONE ? nullptr : normals.data();
    m.normal_domain = domain;
    m.vertex_count = uint32_t(positions.size() / 3);
    m.triangle_count = uint32_t(triangles.size() / 3);
    return m;
  }
};

// A material that displaces by slope . object position + height, along the normal.
void add_lifting(Description &description, const glm::vec3 &slope, float height) {
  std::vector<lancer_node> nodes = {
      node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_DOT_PRODUCT, {result_of(0), constant(slope.x, slope.y, slope.z)}),
      node(LANCER_NODE_DISPLACEMENT, 0, {result_of(1), constant(-height), constant(1.0f)})};
  lancer_material material = black();
  material.name = "lifting";
  material.nodes = nodes.data();
  material.node_count = 3;
  material.displacement = result_of(2);
  add_material(description, material);
}

void add_still(Description &description) {
  lancer_material material = black();
  add_material(description, material);
}

// Returns the grid as instance 0, with the description's materials as its slots.
Mesh displaced(Description &description, uint32_t domain, uint32_t threads = 1) {
  const Grid grid;
  add_mesh(description, grid.mesh(domain));
  for (uint32_t i = 0; i < description.materials.size(); ++i)
    description.slots.push_back(i);
  Instance instance;
  const double rows[12] = {0, -3, 0, 5, 3, 0, 0, 6, 0, 0, 3, 7};
  instance.to_world = Affine::from_rows(rows);
  instance.slot_count = uint32_t(description.materials.size());
  description.instances.push_back(instance);
  BuildContext context;
  context.threads = threads;
  displace(description, context);
  return *description.meshes[0];
}

TEST(NodesDisplace, VerticesFollowTheHeight) {
  for (const uint32_t domain : {LANCER_NORMALS_NONE, LANCER_NORMALS_VERTEX}) {
    Description description;
    add_lifting(description, {0.5f, 0.25f, 0.0f}, 0.125f);
    const Mesh mesh = displaced(description, domain, 2);
    const Grid grid;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::vec3 from(grid.positions[3 * i], grid.positions[3 * i + 1], 0.0f);
      expect_near(mesh.positions[i], {from.x, from.y, 0.5f * from.x + 0.25f * from.y + 0.125f});
    }
    // A tilted plane has one normal.
    for (const glm::vec3 &n : mesh.normals)
      expect_near(n, glm::normalize(glm::vec3(-0.5f, -0.25f, 1.0f)));
    EXPECT_EQ(mesh.normals.size(), domain == LANCER_NORMALS_NONE ? 0u : mesh.positions.size());
    // Generated coordinates stay those of the undisplaced mesh.
    EXPECT_EQ(mesh.high, glm::vec3(1.0f, 1.0f, 0.0f));
  }
}

TEST(NodesDisplace, ASharedVertexTakesTheMean) {
  Description description;
  add_lifting(description, glm::vec3(0.0f), 1.0f);
  add_lifting(description, glm::vec3(0.0f), 2.0f);
  const Mesh mesh = displaced(description, LANCER_NORMALS_VERTEX);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const int x = int(i) % kSide, middle = (kSide - 1) / 2;
    EXPECT_FLOAT_EQ(mesh.positions[i].z, x < middle ? 1.0f : x > middle ? 2.0f : 1.5f);
  }
}

TEST(NodesDisplace, OtherMaterialsStayWhereTheyAre) {
  Description description;
  add_still(description);
  add_lifting(description, glm::vec3(0.0f), 1.0f);
  const Mesh mesh = displaced(description, LANCER_NORMALS_VERTEX);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const int x = int(i) % kSide, middle = (kSide - 1) / 2;
    EXPECT_EQ(mesh.positions[i].z, x < middle ? 0.0f : 1.0f);
    if (x < middle) {
      EXPECT_EQ(mesh.normals[i], glm::vec3(0, 0, 1));
    }
  }
}

TEST(NodesDisplace, CreasesStay) {
  // A roof of two triangles with separate corner normals at the ridge, displaced along world z by its x.
  const float positions[] = {0, 0, 0, 1, 0, 1, 1, 1, 1, 2, 0, 0};
  const uint32_t triangles[] = {0, 1, 2, 1, 3, 2};
  const glm::vec3 left = glm::normalize(glm::vec3(-1, 0, 1)), right = glm::normalize(glm::vec3(1, 0, 1));
  const glm::vec3 normals[] = {left, left, left, right, right, right};
  lancer_mesh mesh = {};
  mesh.positions = positions;
  mesh.triangles = triangles;
  mesh.normals = &normals[0].x;
  mesh.normal_domain = LANCER_NORMALS_CORNER;
  mesh.vertex_count = 4;
  mesh.triangle_count = 2;
  Description description;
  std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT),
                                    node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
                                    node(LANCER_NODE_COMBINE, 0, {constant(0.0f), constant(0.0f), result_of(1)})};
  lancer_material material = black();
  material.nodes = nodes.data();
  material.node_count = 3;
  material.displacement = result_of(2);
  add_material(description, material);
  add_mesh(description, mesh);
  description.slots = {0};
  Instance instance;
  instance.slot_count = 1;
  description.instances.push_back(instance);
  displace(description, BuildContext{});
  const Mesh &moved = *description.meshes[0];
  EXPECT_EQ(moved.positions[1], glm::vec3(1, 0, 2));
  EXPECT_EQ(moved.positions[3], glm::vec3(2, 0, 2));
  for (int corner = 0; corner < 3; ++corner) {
    expect_near(moved.normals[size_t(corner)], glm::normalize(glm::vec3(-2, 0, 1)));
    expect_near(moved.normals[size_t(3 + corner)], glm::vec3(0, 0, 1));
  }
}

TEST(NodesDisplace, KeptNormalsAndABumpThatStandsForThem) {
  // Displaced by half of x, and a bump of the same height over the undisplaced surface: the normal of the displaced plane,
  // applied once.
  Description description;
  const std::vector<lancer_node> nodes = {
      node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_DOT_PRODUCT, {result_of(0), constant(0.5f, 0.0f, 0.0f)}),
      node(LANCER_NODE_DISPLACEMENT, 0, {result_of(1), constant(0.0f), constant(1.0f)}),
      flagged(node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(1), constant(0.0f), constant(0.1f)}), 2)};
  lancer_material material = black();
  material.nodes = nodes.data();
  material.node_count = 4;
  material.flags = LANCER_MATERIAL_KEEP_NORMALS;
  material.displacement = result_of(2);
  material.normal = result_of(3);
  add_material(description, material);
  const Mesh mesh = displaced(description, LANCER_NORMALS_VERTEX);
  EXPECT_FLOAT_EQ(mesh.positions[kSide - 1].z, 0.5f);
  for (const glm::vec3 &n : mesh.normals)
    EXPECT_EQ(n, glm::vec3(0, 0, 1));
  Stage stage;
  stage.description = description;
  Instance &instance = stage.description.instances[0];
  instance.place(instance.to_world);
  stage.footprint = 0x1p-8f;
  const Surface surface = stage.surface(0.3, 0.3);
  expect_near(surface.ns, {0, 0, 1});
  // The object's x is the world's y.
  expect_near(surface.ng, glm::normalize(glm::vec3(0.0f, -0.5f, 1.0f)));
  // A step of 2^-8 of a pixel times a tenth, in heights of order 1: 2^-24 over 4e-4.
  expect_near(glm::vec3(stage.value_at(nodes, &surface)), glm::normalize(glm::vec3(0.0f, -0.5f, 1.0f)), 5e-4f);
}

} // namespace
