// Exact surfaces that emit: samples cover each part by its area, with the density that belongs to the whole area.
#include "geometry_lab.h"
#include "lights/emission.h"
#include "nodes_lab.h"
#include "scene/fill.h"
#include "scene/geometry.h"
#include "scene/material.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace lancer_test {
namespace {

struct Shares {
  double side = 0.0, low = 0.0, high = 0.0; // of the samples: the curved side, the disks at z = -1 and z = 1
};

// Samples a unit shape over a grid of numbers, and expects the density of a uniform point of this area at each sample.
Shares shares_of(ShapeKind kind, double area) {
  constexpr int kSide = 96;
  Geometry geometry;
  Instance &instance = geometry.instances.emplace_back();
  instance.kind = kind;
  instance.slot_count = 1;
  instance.place(Affine{});
  std::vector<MaterialView> materials(1);
  materials[0].emission.value = glm::vec3(1.0f);
  const std::vector<uint32_t> slots{0};
  EmissionAt emission({}, materials);
  const Emitter emitter(geometry, slots, materials, 0, emission);
  const glm::dvec3 p(3.0, 4.0, 5.0);
  Shares shares;
  for (int i = 0; i < kSide * kSide; ++i) {
    const glm::vec2 u((float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide);
    Surface surface;
    const LightSample sample = emitter.sample_shape(geometry, slots, p, kMiddleTime, u, surface);
    const double cosine = std::abs(glm::dot(glm::dvec3(surface.ng), sample.wi));
    // Normals are floats: their rounding is a share of 6e-8 / cosine of it.
    EXPECT_NEAR(sample.pdf * area * cosine, sample.distance * sample.distance,
                1e-6 * sample.distance * sample.distance / cosine);
    double &share = std::abs(surface.ng.z) < 1.0f ? shares.side : surface.p.z < 0.0 ? shares.low : shares.high;
    share += 1.0 / (kSide * kSide);
  }
  return shares;
}

// A part begins and ends within a row of the grid: two rows of 96.
constexpr double kRows = 2.0 / 96.0;

TEST(LightsExact, CylindersAreCoveredByTheirAreas) {
  const Shares shares = shares_of(ShapeKind::Cylinder, 6.0 * glm::pi<double>());
  EXPECT_NEAR(shares.side, 2.0 / 3.0, kRows);
  EXPECT_NEAR(shares.low, 1.0 / 6.0, kRows);
  EXPECT_NEAR(shares.high, 1.0 / 6.0, kRows);
}

TEST(LightsExact, ConesAreCoveredByTheirAreas) {
  const double root = std::sqrt(5.0);
  const Shares shares = shares_of(ShapeKind::Cone, (root + 1.0) * glm::pi<double>());
  EXPECT_NEAR(shares.side, root / (root + 1.0), kRows);
  EXPECT_NEAR(shares.low, 1.0 / (root + 1.0), kRows);
  EXPECT_EQ(shares.high, 0.0);
}

TEST(LightsExact, SpheresAreOneSide) { EXPECT_NEAR(shares_of(ShapeKind::Sphere, 4.0 * glm::pi<double>()).side, 1.0, 1e-9); }

TEST(LightsExact, SomeMaterialsAreNoLights) {
  Material material;
  material.emission.value = glm::vec3(1.0f);
  EXPECT_TRUE(is_light(material));
  material.flags = LANCER_MATERIAL_NOT_A_LIGHT;
  EXPECT_FALSE(is_light(material));
}

// A face that is bright in its middle alone has the power of its mean over four places.
TEST(LightsExact, PowersOfFacesAreMeansOverThem) {
  Geometry geometry;
  Mesh &mesh = geometry.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  mesh.material_slots = {0, 1};
  Instance &instance = geometry.instances.emplace_back();
  instance.slot_count = 2;
  instance.place(Affine{});
  // All weights of the middle exceed 1/4; at the other places, two of them do not.
  const lancer_node nodes[] = {
      node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_PARAMETRIC),
      node(LANCER_NODE_SEPARATE, 0, {result_of(0)}),
      node(LANCER_NODE_SEPARATE, 1, {result_of(0)}),
      node(LANCER_NODE_MATH, LANCER_MATH_MINIMUM, {result_of(1), result_of(2), constant(0.0f)}),
      node(LANCER_NODE_MATH, LANCER_MATH_GREATER_THAN, {result_of(3), constant(0.25f), constant(0.0f)}),
      node(LANCER_NODE_MATH, LANCER_MATH_MULTIPLY, {result_of(4), constant(4.0f), constant(0.0f)})};
  Material bright, even;
  bright.program = read_program({}, "middle", nodes, std::size(nodes));
  bright.emission.node = 5;
  bright.emission_nodes = bright.program.schedule(std::span(&bright.emission, 1));
  even.emission.value = glm::vec3(1.0f);
  const std::vector<MaterialView> materials{bright, even};
  const std::vector<uint32_t> slots{0, 1};
  const GeometryView view = geometry;
  EmissionAt emission({.geometry = &view}, materials);
  const EmissiveFaces faces(view, slots, materials, 0, false, emission, BuildContext{});
  EXPECT_NEAR(faces.by_power().pmf(0), 0.5f, 1e-6f);
}

} // namespace
} // namespace lancer_test
