// Normal maps, tangents, bumps, displacement, Fresnel and layer weight against closed forms.
#include "nodes_lab.h"

#include <cmath>

using namespace lancer_test;

namespace {

const std::vector<double> kHere = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
// Stretched: normals and tangents transform differently.
const std::vector<double> kStretched = {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

glm::vec3 map_at(Stage &stage, const glm::vec3 &color, float strength = 1.0f, uint32_t option = 0) {
  return glm::vec3(
      stage.value({node(LANCER_NODE_NORMAL_MAP, option, {constant(strength), constant(color.x, color.y, color.z)})}));
}

TEST(NodesNormal, MapStandsInTheFrameOfTheUVs) {
  Stage stage;
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.4f, 0.8f)), color = 0.5f + 0.5f * direction;
  // u is along x, v along y.
  expect_near(map_at(stage, color), direction);
  expect_near(map_at(stage, glm::vec3(0.5f, 0.5f, 1.0f)), {0, 0, 1});
  // Strength flattens x and y, and z towards 1.
  const glm::vec3 weak(0.5f * direction.x, 0.5f * direction.y, 0.5f + 0.5f * direction.z);
  expect_near(map_at(stage, color, 0.5f), glm::normalize(weak));
  // From behind the whole map is flipped.
  stage.wo = {0, 0, -1};
  expect_near(map_at(stage, color), -direction);
}

TEST(NodesNormal, MapMirroredWithItsUVs) {
  lancer_mesh mesh = Stage::triangle();
  const float uvs[] = {0, 0, -1, 0, 0, 1};
  mesh.uvs = uvs;
  Stage stage(mesh, kHere);
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.4f, 0.8f));
  expect_near(map_at(stage, 0.5f + 0.5f * direction), {-direction.x, direction.y, direction.z});
}

TEST(NodesNormal, MapTakesTheTangentsOfItsName) {
  lancer_mesh mesh = Stage::triangle();
  const float tangents[] = {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1};
  const lancer_attribute attribute = {"tangent:map", tangents, LANCER_DOMAIN_CORNER, 4};
  mesh.attributes = &attribute;
  mesh.attribute_count = 1;
  Stage stage(mesh, kHere);
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.4f, 0.8f)), color = 0.5f + 0.5f * direction;
  const lancer_node map = named(node(LANCER_NODE_NORMAL_MAP, 0, {constant(1.0f), constant(color.x, color.y, color.z)}), "map");
  // x of the map along +y; the bitangent -(n x t) along +x.
  expect_near(glm::vec3(stage.value({map})), {direction.y, direction.x, direction.z});
}

TEST(NodesNormal, MapWithoutUVsChangesNothing) {
  lancer_mesh mesh = Stage::triangle();
  mesh.uvs = nullptr;
  Stage stage(mesh, kHere);
  expect_near(map_at(stage, {0.9f, 0.2f, 0.7f}), {0, 0, 1}, 0.0f);
}

TEST(NodesNormal, MapsStartFromAGivenNormal) {
  Stage stage(kHere);
  const glm::vec3 bent = glm::normalize(glm::vec3(0.5f, 0.25f, 1.0f)), direction(0, 1, 0);
  const auto map = [&](uint32_t option, float strength) {
    return glm::vec3(
        stage.value({named(node(LANCER_NODE_NORMAL_MAP, option,
                                {constant(strength), constant(0.5f, 1.0f, 0.5f), constant(bent.x, bent.y, bent.z)}),
                           "no such map")}));
  };
  expect_near(map(0, 1.0f), bent, 0.0f);
  expect_near(map(2, 0.5f), glm::normalize(0.5f * bent + 0.5f * direction));
}

TEST(NodesNormal, MapsOfObjectAndWorld) {
  Stage stage(kStretched);
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.4f, 0.8f)), color = 0.5f + 0.5f * direction;
  const glm::vec3 placed = glm::normalize(glm::vec3(0.5f * direction.x, direction.y, direction.z));
  expect_near(map_at(stage, color, 1.0f, 1), placed);
  expect_near(map_at(stage, color, 1.0f, 2), direction);
  const glm::vec3 inverted(direction.x, -direction.y, -direction.z);
  stage.wo = {0, 0, -1};
  expect_near(map_at(stage, color, 1.0f, 4), -inverted);
  expect_near(map_at(stage, color, 1.0f, 3), -glm::normalize(glm::vec3(0.5f * inverted.x, inverted.y, inverted.z)));
  stage.wo = {0, 0, 1};
  expect_near(map_at(stage, color, 0.5f, 2), glm::normalize(glm::vec3(0, 0, 1) + 0.5f * (direction - glm::vec3(0, 0, 1))));
}

// Heights are differences of floats of order 1 over a step of 2^-8: a few times 2^-24 over this.
constexpr float kRough = 1e-4f;

// A bump whose height is slope . position, in world units.
glm::vec3 bump_of(Stage &stage, const glm::vec3 &slope, float strength, float distance, float filter, uint32_t flags = 0) {
  lancer_node bump = flagged(
      node(LANCER_NODE_BUMP, 0, {constant(strength), constant(distance), result_of(1), constant(0.0f), constant(filter)}),
      flags);
  return glm::vec3(stage.value(
      {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION),
       node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_DOT_PRODUCT, {result_of(0), constant(slope.x, slope.y, slope.z)}), bump}));
}

TEST(NodesNormal, BumpTiltsAgainstTheSlope) {
  for (const double scale : {1.0, 512.0}) {
    Stage stage;
    stage.normalise(glm::dvec3(0.0), scale);
    stage.footprint = 0x1p-8f * float(scale);
    const glm::vec3 slope(0.4f, -0.3f, 0.7f);
    const auto expected = [](float x, float y) { return glm::normalize(glm::vec3(-x, -y, 1.0f)); };
    for (const float filter : {0.1f, 1.0f})
      expect_near(bump_of(stage, slope, 1.0f, 1.0f, filter), expected(0.4f, -0.3f), kRough / filter);
    expect_near(bump_of(stage, slope, 1.0f, 2.0f, 1.0f), expected(0.8f, -0.6f), kRough);
    expect_near(bump_of(stage, slope, 1.0f, 1.0f, 1.0f, 1), expected(-0.4f, 0.3f), kRough);
    expect_near(bump_of(stage, slope, 0.5f, 1.0f, 1.0f),
                glm::normalize(0.5f * expected(0.4f, -0.3f) + glm::vec3(0.0f, 0.0f, 0.5f)), kRough);
    stage.wo = {0, 0, -1};
    expect_near(bump_of(stage, slope, 1.0f, 1.0f, 1.0f), glm::normalize(glm::vec3(-0.4f, 0.3f, -1.0f)), kRough);
  }
}

TEST(NodesNormal, BumpFollowsEveryCoordinate) {
  // u = x / 2, generated = x / 2, object = x: the same plane through three coordinates.
  for (const auto &[option, factor] : {std::pair(LANCER_COORDINATE_UV, 2.0f),
                                       {LANCER_COORDINATE_GENERATED, 2.0f},
                                       {LANCER_COORDINATE_OBJECT, 1.0f},
                                       {LANCER_COORDINATE_POSITION, 1.0f}}) {
    Stage stage;
    stage.footprint = 0x1p-8f;
    const glm::vec3 n(stage.value(
        {node(LANCER_NODE_COORDINATE, option), node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
         node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(factor), result_of(1), constant(0.0f), constant(1.0f)})}));
    expect_near(n, glm::normalize(glm::vec3(-1.0f, 0.0f, 1.0f)), kRough);
    // From behind, attributes of the mesh bump to the other side; this mesh has no attribute for GENERATED.
    stage.wo = {0, 0, -1};
    const bool painted = option == LANCER_COORDINATE_UV;
    const glm::vec3 behind(stage.value(
        {node(LANCER_NODE_COORDINATE, option), node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
         node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(factor), result_of(1), constant(0.0f), constant(1.0f)})}));
    expect_near(behind, glm::normalize(glm::vec3(painted ? 1.0f : -1.0f, 0.0f, -1.0f)), kRough);
  }
}

TEST(NodesNormal, BumpWithoutAPixelIsItsNormal) {
  Stage stage;
  expect_near(bump_of(stage, {1, 1, 1}, 1.0f, 1.0f, 1.0f), {0, 0, 1}, 0.0f);
}

TEST(NodesNormal, BumpsInARowAddUp) {
  Stage stage;
  stage.footprint = 0x1p-8f;
  const auto bump = [](int32_t height, lancer_parameter normal, uint32_t first) {
    lancer_node n = node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(height), normal, constant(1.0f)});
    n.first = first;
    return n;
  };
  // The second bump's height depends on x only; the first is among its nodes and keeps its value.
  const glm::vec3 n(
      stage.value({node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION), node(LANCER_NODE_SEPARATE, 1, {result_of(0)}),
                   bump(1, constant(0.0f), 0), node(LANCER_NODE_SEPARATE, 0, {result_of(0)}), bump(3, result_of(2), 0)}));
  const glm::vec3 first = glm::normalize(glm::vec3(0, -1, 1));
  // det n - (dh/dx) (py x n): px = e_x, py = e_y.
  const glm::vec3 px(1, 0, 0), py(0, 1, 0);
  const glm::vec3 expected = glm::normalize(glm::dot(px, glm::cross(py, first)) * first - glm::cross(py, first));
  expect_near(n, expected, kRough);
}

TEST(NodesNormal, BumpOfANormalBelowTheSurface) {
  Stage stage;
  stage.footprint = 0x1p-8f;
  const glm::vec3 n(stage.value(
      {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION), node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
       node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(1), constant(0, 0, -1), constant(1.0f)})}));
  // The slope keeps its side: uphill is +x, so the normal tilts to -x.
  expect_near(n, glm::normalize(glm::vec3(-1, 0, -1)), kRough);
}

TEST(NodesNormal, BumpLeavesItsHeightAsItWas) {
  Stage stage;
  stage.footprint = 0.25f;
  // Nodes after the bump still read the height at the hit itself.
  const glm::vec4 height =
      stage.value({node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION), node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
                   node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(1), constant(0.0f), constant(1.0f)}),
                   node(LANCER_NODE_MIX, LANCER_MIX_MIX, {constant(0.0f), result_of(1), result_of(2)})});
  EXPECT_EQ(height.x, 0.5f);
}

TEST(NodesNormal, TangentsRadialAndAlongTheMap) {
  Stage stage(kStretched);
  const auto tangent = [&](uint32_t option, double u, double v) {
    return glm::vec3(stage.value({node(LANCER_NODE_TANGENT, option)}, u, v));
  };
  // Generated (0.75, 0.25, 0.5): around z this is (0.25, 0.25); a normal's transformation to the world halves x, then
  // normalises.
  expect_near(tangent(2, 0.75, 0.25), glm::normalize(glm::vec3(0.125f, 0.25f, 0.0f)));
  // Around x: (0, 0, y - 0.5) is along the normal; nothing remains perpendicular to it.
  expect_near(tangent(0, 0.75, 0.25), glm::vec3(0.0f));
  expect_near(tangent(3, 0.2, 0.2), {1, 0, 0});
}

TEST(NodesNormal, TangentsLieAcrossAGivenNormal) {
  Stage stage(kHere);
  // Along u is x; across the normal (3, 0, 4) / 5, (4, 0, -3) / 5 remains of x.
  expect_near(glm::vec3(stage.value({node(LANCER_NODE_TANGENT, 3, {constant(0.6f, 0.0f, 0.8f)})})), {0.8f, 0.0f, -0.6f});
}

TEST(NodesNormal, AStillAttributeGivesNoSlope) {
  lancer_mesh mesh = Stage::triangle();
  const float heights[] = {0.0f, 1.0f, 0.5f};
  const lancer_attribute attribute = {"height", heights, LANCER_DOMAIN_VERTEX, 1};
  mesh.attributes = &attribute;
  mesh.attribute_count = 1;
  Stage stage(mesh, kHere);
  stage.footprint = 0.25f;
  const auto bumped = [&](uint32_t flags) {
    return glm::vec3(stage.value(
        {flagged(named(node(LANCER_NODE_ATTRIBUTE), "height"), flags),
         node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(0), constant(0.0f), constant(1.0f)})}));
  };
  EXPECT_LT(bumped(0).z, 0.9f);
  EXPECT_EQ(bumped(LANCER_ATTRIBUTE_STILL), glm::vec3(0, 0, 1));
}

TEST(NodesNormal, DisplacementInObjectAndWorld) {
  // The normal z has length 4 in the world.
  Stage stage({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 4, 0});
  stage.normalise(glm::dvec3(0.0), 8.0);
  const auto offset = [&](uint32_t option, lancer_parameter normal) {
    return glm::vec3(
        stage.value({node(LANCER_NODE_DISPLACEMENT, option, {constant(0.75f), constant(0.25f), constant(0.6f), normal})}));
  };
  expect_near(offset(0, constant(0.0f)), {0.0f, 0.0f, 0.3f});
  expect_near(offset(1, constant(0.0f)), {0.0f, 0.0f, 0.075f});
  expect_near(offset(1, constant(1.0f, 0.0f, 0.0f)), {0.3f, 0.0f, 0.0f});
}

double fresnel(double cosine, double ior) {
  const double sin2 = (1.0 - cosine * cosine) / (ior * ior);
  if (sin2 >= 1.0)
    return 1.0;
  const double t = std::sqrt(1.0 - sin2);
  const double s = (cosine - ior * t) / (cosine + ior * t), p = (ior * cosine - t) / (ior * cosine + t);
  return 0.5 * (s * s + p * p);
}

TEST(NodesNormal, FresnelFromBothSides) {
  Stage stage;
  for (const float cosine : {0.1f, 0.5f, 0.9f, 1.0f})
    for (const float side : {1.0f, -1.0f})
      for (const float ior : {1.2f, 1.5f, 2.5f}) {
        stage.wo = {std::sqrt(1.0f - cosine * cosine), 0.0f, side * cosine};
        const double expected = fresnel(double(cosine), side > 0.0f ? double(ior) : 1.0 / double(ior));
        // Numbers of order 1 with a dozen roundings of 2^-24; none of these angles is near the critical one.
        EXPECT_NEAR(stage.value({node(LANCER_NODE_FRESNEL, 0, {constant(ior)})}).x, expected, 1e-6);
        // Layer weight's Fresnel has the blend 1 - 1 / ior, from which 1 / ior is recovered with an error of 2^-24: a relative
        // 1.5e-7 for an ior of 2.5, and Fresnel grows by less than 1 with the logarithm of ior here.
        EXPECT_NEAR(stage.value({node(LANCER_NODE_LAYER_WEIGHT, 0, {constant(1.0f - 1.0f / ior)})}).x, expected, 1.2e-6);
      }
  // With a normal of its own.
  stage.wo = {0, 0, 1};
  EXPECT_NEAR(stage.value({node(LANCER_NODE_FRESNEL, 0, {constant(1.5f), constant(0.0f, 0.8f, 0.6f)})}).x, fresnel(0.6, 1.5),
              1e-6);
}

TEST(NodesNormal, FacingIsAPowerOfTheCosine) {
  Stage stage;
  stage.wo = {0.8f, 0.0f, 0.6f};
  const auto facing = [&](float blend) { return stage.value({node(LANCER_NODE_LAYER_WEIGHT, 1, {constant(blend)})}).x; };
  // Numbers below 1 after a power and a few other roundings of 2^-24.
  EXPECT_NEAR(facing(0.5f), 0.4, 1e-6);
  EXPECT_NEAR(facing(0.25f), 1.0 - std::sqrt(0.6), 1e-6);
  EXPECT_NEAR(facing(0.75f), 1.0 - 0.36, 1e-6);
  EXPECT_NEAR(facing(0.0f), 0.0, 1e-6);
}

} // namespace
