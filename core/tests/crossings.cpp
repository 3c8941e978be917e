// Transparent layers along a ray: each place once, in order of distance.
#include "geometry_lab.h"
#include "integrator/stages/hit.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace lancer {
namespace {

// A fan of four triangles around vertex 0, and a square beside it whose triangles repeat the positions of vertices 1 and 2.
Geometry fan() {
  Geometry geometry;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {7, 5, 6}};
  geometry.meshes.push_back(mesh);
  for (int i = 0; i < 2; ++i)
    geometry.instances.emplace_back();
  geometry.instances.emplace_back().kind = ShapeKind::Sphere;
  return geometry;
}

// Adds hits like a filter; returns the number of layers.
uint32_t count(const std::vector<Hit> &hits) {
  const Geometry geometry = fan();
  Crossings layers(geometry);
  layers.begin(1);
  for (const Hit &hit : hits)
    layers.put(layers.find(0, hit), 0, hit, glm::vec3(1.0f));
  EXPECT_EQ(layers.in_order(0).size(), layers.count(0));
  return layers.count(0);
}

TEST(Crossings, ATriangleIsPassedOnce) {
  EXPECT_EQ(count({{1.0, 0.25, 0.25, 0, 0}, {1.0, 0.25, 0.25, 0, 0}}), 1u);
  EXPECT_EQ(count({{1.0, 0.25, 0.25, 0, 0}, {1.0, 0.25, 0.25, 1, 0}}), 2u);
  EXPECT_EQ(count({{1.0, 0.25, 0.25, 0, 0}, {1.0, 0.25, 0.25, 0, 4}}), 2u);
}

TEST(Crossings, AnExactSurfaceIsPassedWhereItIsMet) {
  EXPECT_EQ(count({{1.0, 0.0, 0.0, 2, 0}, {3.0, 0.0, 0.0, 2, 0}, {1.0, 0.0, 0.0, 2, 0}}), 2u);
}

TEST(Crossings, ACommonEdgeIsPassedOnce) {
  // Halfway between vertices 0 and 2: corner 2 of the first triangle, corner 1 of the second.
  EXPECT_EQ(count({{1.0, 0.0, 0.5, 0, 0}, {1.0, 0.5, 0.0, 0, 1}}), 1u);
  // The outer edge between vertices 1 and 2, where the weight of corner 0 is the rounding error of 0.
  EXPECT_EQ(count({{1.0, 0.5, 0.5 - 0x1p-54, 0, 0}, {1.0, 0.5, 0.5, 0, 0}}), 1u);
  // Different edges of two triangles, the same edge of another instance, and an edge next to an interior.
  EXPECT_EQ(count({{1.0, 0.0, 0.5, 0, 0}, {1.0, 0.0, 0.5, 0, 1}}), 2u);
  EXPECT_EQ(count({{1.0, 0.0, 0.5, 0, 0}, {1.0, 0.5, 0.0, 1, 1}}), 2u);
  EXPECT_EQ(count({{1.0, 0.0, 0.5, 0, 0}, {1.0, 0.5, 0.1, 0, 1}}), 2u);
  // Two coincident sheets.
  EXPECT_EQ(count({{1.0, 0.0, 0.5, 0, 0}, {1.0, 0.0, 0.5, 0, 4}}), 2u);
}

TEST(Crossings, ACommonCornerIsPassedOnce) {
  EXPECT_EQ(count({{1.0, 0.0, 0.0, 0, 0}, {1.0, 0.0, 0.0, 0, 1}, {1.0, 0.0, 0.0, 0, 2}, {1.0, 0.0, 0.0, 0, 3}}), 1u);
  EXPECT_EQ(count({{1.0, 0.0, 1.0, 0, 0}, {1.0, 1.0, 0.0, 0, 1}}), 1u);
  EXPECT_EQ(count({{1.0, 0.0, 0.0, 0, 0}, {1.0, 0.0, 0.0, 0, 4}}), 2u);
}

TEST(Crossings, TheClosestStandsForAllAndOrderIsThatOfDistance) {
  const Geometry geometry = fan();
  const Hit near{1.0, 0.0, 0.5, 0, 0}, same{std::nextafter(1.0, 2.0), 0.5, 0.0, 0, 1}, far{2.0, 0.25, 0.25, 0, 2},
      tie{2.0, 0.25, 0.25, 1, 0};
  std::vector<Hit> hits{near, same, far, tie};
  const auto before = [](const Hit &a, const Hit &b) { return closer(a.t, a.instance, a.primitive, b); };
  std::sort(hits.begin(), hits.end(), before);
  do {
    Crossings layers(geometry);
    layers.begin(3);
    for (const Hit &hit : hits)
      layers.put(layers.find(1, hit), 1, hit, glm::vec3(float(hit.primitive)));
    EXPECT_EQ(layers.count(0) + layers.count(2), 0u);
    const auto found = layers.in_order(1);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].hit.primitive, 0u);
    EXPECT_EQ(found[0].transmittance.x, 0.0f);
    EXPECT_EQ(found[1].hit.primitive, 2u);
    EXPECT_EQ(found[2].hit.instance, 1u);
  } while (std::next_permutation(hits.begin(), hits.end(), before));
}

} // namespace
} // namespace lancer
