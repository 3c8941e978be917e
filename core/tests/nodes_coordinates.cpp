// Coordinates, attributes and transforms on a placed triangle, on exact surfaces and in the world.
#include "nodes_lab.h"

using namespace lancer_test;

namespace {

// Rotated by a quarter turn about z, stretched by 3 along the object's z and by 2 along x, and translated.
const std::vector<double> kRows = {0, -1, 0, 10, 2, 0, 0, 20, 0, 0, 3, 30};

glm::vec3 at(Stage &stage, uint32_t option, double u = 0.25, double v = 0.5) {
  return glm::vec3(stage.value({node(LANCER_NODE_COORDINATE, option)}, u, v));
}

TEST(NodesCoordinates, PlacesInEveryFrame) {
  Stage stage(kRows);
  // The object's point (0.5, 1, 0).
  expect_near(at(stage, LANCER_COORDINATE_OBJECT), {0.5f, 1.0f, 0.0f});
  expect_near(at(stage, LANCER_COORDINATE_POSITION), {9.0f, 21.0f, 30.0f});
  expect_near(at(stage, LANCER_COORDINATE_UV), {0.25f, 0.5f, 0.0f});
  // The mesh extends from 0 to 2, and is flat in z.
  expect_near(at(stage, LANCER_COORDINATE_GENERATED), {0.25f, 0.5f, 0.5f});
  expect_near(at(stage, LANCER_COORDINATE_PARAMETRIC), {0.25f, 0.25f, 0.0f});
  expect_near(at(stage, LANCER_COORDINATE_WINDOW), {9.0f, 21.0f, 30.0f});
  // The world position transformed by the map of another object.
  lancer_node other = flagged(node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_OBJECT), 1);
  const float map[12] = {0, 1, 0, -21, 1, 0, 0, -9, 0, 0, 2, 0};
  std::copy(map, map + 12, other.matrix);
  expect_near(glm::vec3(stage.value({other})), {0.0f, 0.0f, 60.0f});
}

TEST(NodesCoordinates, NormalisationDoesNotShow) {
  Stage plain(kRows), normalised(kRows);
  normalised.normalise({7.0, -3.0, 11.0}, 64.0);
  for (uint32_t option = 0; option < LANCER_COORDINATE_COUNT; ++option) {
    SCOPED_TRACE(option);
    expect_near(at(normalised, option), at(plain, option), 0.0f);
  }
}

TEST(NodesCoordinates, NormalsLookAtTheViewer) {
  Stage stage(kRows);
  for (const float side : {1.0f, -1.0f}) {
    stage.wo = glm::normalize(glm::vec3(1.0f, 0.0f, side));
    expect_near(at(stage, LANCER_COORDINATE_SHADING_NORMAL), {0, 0, side});
    expect_near(at(stage, LANCER_COORDINATE_TRUE_NORMAL), {0, 0, side});
    expect_near(at(stage, LANCER_COORDINATE_NORMAL), {0, 0, side});
    expect_near(at(stage, LANCER_COORDINATE_INCOMING), stage.wo);
    expect_near(at(stage, LANCER_COORDINATE_BACKFACING), glm::vec3(side < 0.0f ? 1.0f : 0.0f));
    expect_near(at(stage, LANCER_COORDINATE_REFLECTION), {-stage.wo.x, 0.0f, stage.wo.z});
  }
}

TEST(NodesCoordinates, CameraLooksForwards) {
  Stage stage(kRows);
  Camera camera;
  camera.to_world.translation = {9.0, 21.0, 40.0};
  camera.left = -0.5, camera.right = 1.5, camera.bottom = -1.0, camera.top = 1.0;
  stage.camera = &camera;
  expect_near(at(stage, LANCER_COORDINATE_CAMERA), {0.0f, 0.0f, 10.0f});
  expect_near(at(stage, LANCER_COORDINATE_WINDOW), {0.25f, 0.5f, 0.0f});
}

TEST(NodesCoordinates, WorldKnowsOnlyTheDirection) {
  Stage stage;
  const glm::vec3 d = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));
  stage.wo = -d;
  const auto value = [&](uint32_t option) {
    return glm::vec3(stage.value_at({node(LANCER_NODE_COORDINATE, option)}, nullptr));
  };
  for (const uint32_t option : {LANCER_COORDINATE_GENERATED, LANCER_COORDINATE_OBJECT, LANCER_COORDINATE_POSITION})
    EXPECT_EQ(value(option), d);
  // The world's surface faces the viewer.
  for (const uint32_t option : {LANCER_COORDINATE_NORMAL, LANCER_COORDINATE_SHADING_NORMAL, LANCER_COORDINATE_TRUE_NORMAL,
                                LANCER_COORDINATE_INCOMING, LANCER_COORDINATE_REFLECTION})
    EXPECT_EQ(value(option), -d);
  for (const uint32_t option : {LANCER_COORDINATE_UV, LANCER_COORDINATE_PARAMETRIC, LANCER_COORDINATE_BACKFACING})
    EXPECT_EQ(value(option), glm::vec3(0.0f));
}

TEST(NodesCoordinates, AttributesOfEveryDomain) {
  lancer_mesh mesh = Stage::triangle();
  const float vertex[] = {0, 0, 1, 0, 0, 1};
  const float face[] = {5, 6, 7, 8};
  const float corner[] = {1, 2, 4};
  const float undeformed[] = {0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f};
  const float colors[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const lancer_attribute attributes[] = {{"second map", vertex, LANCER_DOMAIN_VERTEX, 2},
                                         {"paint", face, LANCER_DOMAIN_FACE, 4},
                                         {"height", corner, LANCER_DOMAIN_CORNER, 1},
                                         {"generated", undeformed, LANCER_DOMAIN_VERTEX, 3}};
  mesh.attributes = attributes;
  mesh.attribute_count = 4;
  mesh.colors = colors;
  Stage stage(mesh, kRows);
  const auto value = [&](const char *name) { return stage.value({named(node(LANCER_NODE_ATTRIBUTE), name)}); };
  EXPECT_EQ(value("second map"), glm::vec4(0.25f, 0.5f, 0.0f, 1.0f));
  EXPECT_EQ(value("paint"), glm::vec4(5, 6, 7, 8));
  // 0.25 of 1, 0.25 of 2, 0.5 of 4; a scalar in all of x, y, z.
  EXPECT_EQ(value("height"), glm::vec4(2.75f, 2.75f, 2.75f, 1.0f));
  EXPECT_EQ(value(""), glm::vec4(0.25f, 0.25f, 0.5f, 1.0f));
  EXPECT_EQ(value("none such"), glm::vec4(0.0f));
  const auto flagged_value = [&](const char *name, uint32_t flags) {
    return stage.value({flagged(named(node(LANCER_NODE_ATTRIBUTE), name), flags)});
  };
  EXPECT_EQ(flagged_value("none such", LANCER_ATTRIBUTE_OPAQUE), glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(flagged_value("paint", LANCER_ATTRIBUTE_OPAQUE), glm::vec4(5, 6, 7, 8));
  EXPECT_EQ(flagged_value("second map", LANCER_ATTRIBUTE_FIRST), glm::vec4(0.25f, 0.25f, 0.25f, 1.0f));
  EXPECT_EQ(flagged_value("paint", LANCER_ATTRIBUTE_FIRST), glm::vec4(5, 6, 7, 8));
  // An attribute that is no map gives its own numbers.
  EXPECT_EQ(glm::vec3(stage.value({named(node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), "paint")})), glm::vec3(5, 6, 7));
  expect_near(glm::vec3(stage.value({named(node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), "second map")})),
              {0.25f, 0.5f, 0.0f});
  EXPECT_EQ(glm::vec3(stage.value({named(node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), "none such")})), glm::vec3(0.0f));
  expect_near(at(stage, LANCER_COORDINATE_GENERATED), {0.1f, 0.2f, 0.3f});
  EXPECT_EQ(stage.value({named(node(LANCER_NODE_ATTRIBUTE), "paint"), node(LANCER_NODE_ALPHA, 0, {result_of(0)})}).x, 8.0f);
}

TEST(NodesCoordinates, ExactSurfacesHaveTheirParametrisation) {
  Stage stage(kRows);
  stage.description.instances[0].kind = ShapeKind::Sphere;
  Surface surface;
  surface.instance = 0;
  const Instance &instance = stage.description.instances[0];
  surface.p = instance.to_world.point({0.0, 1.0, 0.0});
  surface.ng = surface.ns = glm::vec3(-1.0f, 0.0f, 0.0f);
  stage.wo = surface.ng;
  const auto value = [&](uint32_t option) {
    return glm::vec3(stage.value_at({node(LANCER_NODE_COORDINATE, option)}, &surface));
  };
  expect_near(value(LANCER_COORDINATE_OBJECT), {0, 1, 0});
  expect_near(value(LANCER_COORDINATE_GENERATED), {0.5f, 1.0f, 0.5f});
  expect_near(value(LANCER_COORDINATE_NORMAL), {0, 1, 0});
  EXPECT_NEAR(value(LANCER_COORDINATE_UV).y, 0.5f, 1e-6f);
  EXPECT_EQ(stage.value_at({named(node(LANCER_NODE_ATTRIBUTE), "any")}, &surface), glm::vec4(0.0f));
  const auto opaque = flagged(named(node(LANCER_NODE_ATTRIBUTE), "any"), LANCER_ATTRIBUTE_OPAQUE);
  EXPECT_EQ(stage.value_at({opaque}, &surface), glm::vec4(0, 0, 0, 1));
}

TEST(NodesCoordinates, TransformOfPointVectorNormal) {
  Stage stage;
  const auto value = [&](uint32_t option) {
    lancer_node n = node(LANCER_NODE_TRANSFORM, option, {constant(1.0f, 2.0f, 3.0f)});
    const float rows[12] = {0, -2, 0, 5, 1, 0, 0, 6, 0, 0, 4, 7};
    std::copy(rows, rows + 12, n.matrix);
    return glm::vec3(stage.value({n}));
  };
  expect_near(value(0), {1, 7, 19}, 0.0f);
  expect_near(value(1), {-4, 1, 12}, 0.0f);
  // The inverse transpose of the rows (0, -2), (1, 0), 4 is (0, -1/2), (1, 0), 1/4.
  expect_near(value(2), glm::normalize(glm::vec3(-1.0f, 1.0f, 0.75f)));
}

} // namespace
