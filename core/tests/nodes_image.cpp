// Image and environment nodes: the image and place of a vector. The image's colour encodes the place of the lookup.
#include "nodes_lab.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

using namespace lancer_test;

namespace {

constexpr uint32_t kClosest = LANCER_INTERPOLATE_CLOSEST << 4;
// A gradient is interpolated exactly except for rounding: u of 256 texels between their centres.
constexpr float kExact = 2e-6f;

lancer_node image_node(uint32_t kind, uint32_t projection, const glm::vec3 &p, uint32_t count = 1, float blend = 0.0f) {
  lancer_node n = node(kind, projection, {constant(p.x, p.y, p.z), constant(blend)});
  n.flags = LANCER_EXTEND_EXTEND;
  n.image_count = count;
  return n;
}

class NodesImage : public testing::Test {
protected:
  Stage stage;
  glm::vec4 look(uint32_t projection, const glm::vec3 &p, float blend = 0.0f) {
    return stage.value({image_node(LANCER_NODE_IMAGE, projection, p, 1, blend)});
  }
};

TEST_F(NodesImage, Flat) {
  add_gradient(stage.description, 256, 128);
  expect_near(glm::vec3(look(LANCER_PROJECT_FLAT, {0.3f, 0.7f, 9.0f})), {0.3f, 0.7f, 0.0f}, kExact);
}

TEST_F(NodesImage, SphereIsLongitudeAndLatitude) {
  add_gradient(stage.description, 256, 128);
  for (const double longitude : {-2.5, -0.4, 0.3, 1.9, 3.0})
    for (const double latitude : {-1.2, -0.3, 0.0, 0.9}) {
      const glm::dvec3 d(std::sin(longitude) * std::cos(latitude), std::cos(longitude) * std::cos(latitude),
                         std::sin(latitude));
      const glm::vec3 place(0.5 + 0.5 * 0.7 * d);
      const double pi = glm::pi<double>();
      expect_near(glm::vec3(look(LANCER_PROJECT_SPHERE, place)),
                  glm::vec3(glm::dvec3(0.5 - longitude / (2.0 * pi), 0.5 + latitude / pi, 0.0)), kExact);
    }
  EXPECT_EQ(look(LANCER_PROJECT_SPHERE, glm::vec3(0.5f)), look(LANCER_PROJECT_FLAT, glm::vec3(0.0f)));
}

TEST_F(NodesImage, TubeIsLongitudeAndHeight) {
  add_gradient(stage.description, 256, 128);
  for (const double longitude : {-2.5, -0.4, 0.3, 1.9}) {
    const glm::dvec3 p(0.3 * std::sin(longitude), 0.3 * std::cos(longitude), 0.5);
    expect_near(glm::vec3(look(LANCER_PROJECT_TUBE, glm::vec3(0.5 + 0.5 * p))),
                glm::vec3(glm::dvec3(0.5 - longitude / (2.0 * glm::pi<double>()), 0.75, 0.0)), kExact);
  }
}

// A triangle of any orientation, for box projection, which depends on the object's normal.
lancer_mesh triangle_facing(const glm::vec3 &n, std::vector<float> &positions) {
  const glm::vec3 t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  const glm::vec3 b = glm::cross(n, t);
  positions = {0, 0, 0, t.x, t.y, t.z, b.x, b.y, b.z};
  lancer_mesh mesh = Stage::triangle();
  mesh.positions = positions.data();
  return mesh;
}

glm::vec3 box_at(const glm::vec3 &n, const glm::vec3 &p, float blend) {
  std::vector<float> positions;
  Stage stage(triangle_facing(glm::normalize(n), positions), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  stage.wo = glm::normalize(n);
  add_gradient(stage.description, 256, 128);
  return glm::vec3(stage.value({image_node(LANCER_NODE_IMAGE, LANCER_PROJECT_BOX, p, 1, blend)}));
}

TEST_F(NodesImage, BoxShowsEachSideUpright) {
  const glm::vec3 p(0.2f, 0.3f, 0.4f);
  expect_near(box_at({1, 0, 0}, p, 0.0f), {0.3f, 0.4f, 0.0f}, kExact);
  expect_near(box_at({-1, 0, 0}, p, 0.0f), {0.7f, 0.4f, 0.0f}, kExact);
  expect_near(box_at({0, 1, 0}, p, 0.0f), {0.8f, 0.4f, 0.0f}, kExact);
  expect_near(box_at({0, -1, 0}, p, 0.0f), {0.2f, 0.4f, 0.0f}, kExact);
  expect_near(box_at({0, 0, 1}, p, 0.0f), {0.7f, 0.2f, 0.0f}, kExact);
  expect_near(box_at({0, 0, -1}, p, 0.0f), {0.3f, 0.2f, 0.0f}, kExact);
}

TEST_F(NodesImage, BoxMixesNearItsEdges) {
  const glm::vec3 p(0.2f, 0.3f, 0.4f), x(0.3f, 0.4f, 0.0f), y(0.8f, 0.4f, 0.0f), z(0.7f, 0.2f, 0.0f);
  // At the edge half of each; near it the share that blend spreads over n.x / (n.x + n.y) = 0.5 -+ blend / 2.
  expect_near(box_at({1, 1, 0}, p, 0.4f), 0.5f * (x + y), kExact);
  expect_near(box_at({0.55f, 0.45f, 0.0f}, p, 0.4f), 0.625f * x + 0.375f * y, kExact);
  expect_near(box_at({0.75f, 0.25f, 0.0f}, p, 0.4f), x, kExact);
  expect_near(box_at({0.0f, 0.45f, 0.55f}, p, 0.4f), 0.375f * y + 0.625f * z, kExact);
  // In the corner a third of each.
  expect_near(box_at({1, 1, 1}, p, 0.4f), (x + y + z) / 3.0f, kExact);
  // Without a blend only the largest.
  expect_near(box_at({0.55f, 0.45f, 0.3f}, p, 0.0f), x, kExact);
}

TEST_F(NodesImage, TilesByTheWholePartOfTheVector) {
  for (const uint32_t tile : {1001u, 1002u, 1011u})
    add_gradient(stage.description, 64, 64, tile);
  const auto at = [&](float u, float v) {
    return stage.value({image_node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {u, v, 0.0f}, 3)});
  };
  expect_near(glm::vec3(at(0.3f, 0.6f)), {0.3f, 0.6f, 1001.0f}, kExact);
  expect_near(glm::vec3(at(1.3f, 0.6f)), {0.3f, 0.6f, 1002.0f}, kExact);
  expect_near(glm::vec3(at(0.3f, 1.6f)), {0.3f, 0.6f, 1011.0f}, kExact);
  const glm::vec4 missing(1, 0, 1, 1);
  for (const glm::vec2 uv : {glm::vec2(2.5f, 0.5f), {1.5f, 1.5f}, {-1.5f, 0.5f}, {10.5f, 0.0f}, {0.5f, 1e30f}})
    EXPECT_EQ(at(uv.x, uv.y), missing);
}

TEST_F(NodesImage, MissingPictureIsMagenta) {
  EXPECT_EQ(stage.value({image_node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, glm::vec3(0.5f), 0)}), glm::vec4(1, 0, 1, 1));
  EXPECT_EQ(stage.value({image_node(LANCER_NODE_ENVIRONMENT, 0, {1, 0, 0}, 0)}), glm::vec4(1, 0, 1, 1));
}

TEST_F(NodesImage, Equirectangular) {
  add_gradient(stage.description, 256, 128);
  const double pi = glm::pi<double>();
  for (const double longitude : {-2.5, -0.4, 0.3, 1.9})
    for (const double latitude : {-1.3, 0.0, 0.7}) {
      // Any length: only the direction counts.
      const glm::vec3 d(5.0 * glm::dvec3(std::cos(longitude) * std::cos(latitude), std::sin(longitude) * std::cos(latitude),
                                         std::sin(latitude)));
      const glm::vec4 got = stage.value({image_node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_EQUIRECTANGULAR, d)});
      expect_near(glm::vec3(got), glm::vec3(glm::dvec3(0.5 - longitude / (2.0 * pi), 0.5 + latitude / pi, 0.0)), kExact);
    }
}

TEST_F(NodesImage, MirrorBallShowsTheReflectedDirection) {
  add_gradient(stage.description, 256, 256);
  for (const glm::dvec2 place : {glm::dvec2(0.5, 0.5), {0.3, 0.6}, {0.8, 0.35}, {0.5, 0.1}}) {
    // The ball's normal there, seen by a viewer who faces +y; its mirror direction.
    const double x = 2.0 * place.x - 1.0, z = 2.0 * place.y - 1.0;
    const glm::dvec3 n(x, -std::sqrt(1.0 - x * x - z * z), z), forwards(0, 1, 0);
    const glm::vec3 d(glm::reflect(forwards, n));
    const glm::vec4 got = stage.value({image_node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_MIRROR_BALL, d)});
    expect_near(glm::vec3(got), glm::vec3(glm::dvec3(place, 0.0)), kExact);
  }
}

TEST_F(NodesImage, CubeStandsUpright) {
  for (uint32_t side = 1; side <= 6; ++side)
    add_gradient(stage.description, 64, 64, side);
  const auto look_along = [&](const glm::vec3 &d) {
    return glm::vec3(stage.value({image_node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_CUBE, d, 6)}));
  };
  // Straight ahead, then a quarter of the side to the right and up, as seen from inside.
  struct Side {
    glm::vec3 forwards, right, up;
  };
  const Side sides[] = {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                        {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {{0, -1, 0}, {-1, 0, 0}, {0, 0, 1}},
                        {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};
  for (uint32_t i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    const Side &side = sides[i];
    expect_near(look_along(3.0f * side.forwards), {0.5f, 0.5f, float(i + 1)}, kExact);
    expect_near(look_along(side.forwards + 0.5f * side.right + 0.25f * side.up), {0.75f, 0.625f, float(i + 1)}, kExact);
  }
}

TEST_F(NodesImage, FlagsReachTheLookup) {
  add_gradient(stage.description, 2, 1);
  const auto at = [&](float u, uint32_t flags) {
    lancer_node n = image_node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {u, 0.5f, 0.0f});
    n.flags = flags;
    return stage.value({n});
  };
  EXPECT_EQ(at(0.4f, kClosest).x, 0.25f);
  EXPECT_EQ(at(1.6f, kClosest).x, 0.75f);
  EXPECT_EQ(at(1.6f, kClosest | LANCER_EXTEND_CLIP), glm::vec4(0.0f));
  EXPECT_EQ(at(1.6f, kClosest | LANCER_EXTEND_MIRROR).x, 0.25f);
  EXPECT_NEAR(at(0.4f, 0).x, 0.4f, kExact);
}

} // namespace
