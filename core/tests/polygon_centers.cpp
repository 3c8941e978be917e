// The points at which flat shading computes a polygon's colour.
#include "compile/steps.h"

#include <gtest/gtest.h>

#include "scene/geometry.h"

namespace lancer {
namespace {

// A mesh and its centres.
struct Polygons : Mesh {
  std::vector<PolygonCenter> centers;

  MeshView view() const {
    MeshView all = *this;
    all.centers = centers;
    return all;
  }
};

glm::dvec3 place(const Mesh &mesh, const Hit &hit) {
  const glm::dvec3 v0(mesh.vertex(hit.primitive, 0)), v1(mesh.vertex(hit.primitive, 1)), v2(mesh.vertex(hit.primitive, 2));
  return v0 + hit.u * (v1 - v0) + hit.v * (v2 - v0);
}

Hit on(uint32_t triangle) {
  Hit hit;
  hit.instance = 0;
  hit.primitive = triangle;
  hit.t = 3.0;
  return hit;
}

// A pentagon in three triangles, a triangle, and a warped quadrilateral; polygons out of order.
Polygons three_polygons() {
  Polygons mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {5, 2, 0}, {2, 4, 0}, {0, 1, 0}, {9, 9, 9},
                    {9, 8, 9}, {8, 9, 9}, {0, 0, 5}, {2, 0, 6}, {2, 2, 5}, {0, 2, 6}};
  mesh.triangles = {{8, 9, 10}, {0, 1, 2}, {0, 2, 3}, {5, 6, 7}, {0, 3, 4}, {8, 10, 11}};
  mesh.polygons = {4, 1, 1, 0, 1, 4};
  mesh.centers = polygon_centers(mesh);
  return mesh;
}

TEST(PolygonCenters, AreTheMeanOfTheVertices) {
  const Polygons mesh = three_polygons();
  const glm::dvec3 mean(11.0 / 5.0, 7.0 / 5.0, 0.0);
  for (const uint32_t triangle : {1u, 2u, 4u}) {
    const Hit hit = center_hit(mesh.view(), on(triangle));
    // A dozen roundings of double of numbers up to 5.
    EXPECT_LT(glm::distance(place(mesh, hit), mean), 1e-14);
    EXPECT_EQ(mesh.polygons[hit.primitive], 1u);
    EXPECT_EQ(hit.t, 3.0);
    EXPECT_EQ(mesh.centers[1].normal, glm::vec3(0, 0, 1));
  }
  EXPECT_LT(glm::distance(place(mesh, center_hit(mesh.view(), on(3))), glm::dvec3(26.0, 26.0, 27.0) / 3.0), 1e-14);
}

TEST(PolygonCenters, OfAWarpedPolygonLieOnIt) {
  // The mean is at height 5.5, above the edge shared by both triangles, which is at height 5.
  const Polygons mesh = three_polygons();
  EXPECT_LT(glm::distance(place(mesh, center_hit(mesh.view(), on(0))), glm::dvec3(1.0, 1.0, 5.0)), 1e-14);
  EXPECT_EQ(place(mesh, center_hit(mesh.view(), on(5))), place(mesh, center_hit(mesh.view(), on(0))));
  // Half the cross product of its diagonals.
  EXPECT_EQ(mesh.centers[4].normal, glm::vec3(0, 0, 1));
}

TEST(PolygonCenters, WithoutPolygonsATriangleIsOne) {
  Polygons mesh = three_polygons();
  mesh.polygons.clear();
  EXPECT_TRUE(polygon_centers(mesh).empty());
  mesh.centers.clear();
  const glm::dvec3 middle = (glm::dvec3(0, 0, 5) + glm::dvec3(2, 0, 6) + glm::dvec3(2, 2, 5)) / 3.0;
  EXPECT_LT(glm::distance(place(mesh, center_hit(mesh.view(), on(0))), middle), 1e-14);
}

TEST(PolygonCenters, GoWithTheFacesThatAreKept) {
  Polygons mesh = three_polygons();
  keep_faces(mesh, {1, 2, 5});
  EXPECT_EQ(mesh.polygons, (std::vector<uint32_t>{1, 1, 4}));
  mesh.centers = polygon_centers(mesh);
  // The rest of the pentagon has four of its vertices.
  EXPECT_LT(glm::distance(place(mesh, center_hit(mesh.view(), on(0))), glm::dvec3(11.0, 6.0, 0.0) / 4.0), 1e-14);
  EXPECT_TRUE(polygon_centers(Mesh{}).empty());
}

TEST(PolygonCenters, OfAConcavePolygonAreMovedToIt) {
  Polygons mesh;
  mesh.positions = {{-10, -10, 0}, {10, -10, 0}, {10, -9, 0}, {-9, -9, 0}, {-9, 32, 0}, {-10, 32, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  mesh.polygons = {0, 0, 0, 0};
  mesh.centers = polygon_centers(mesh);
  EXPECT_LT(glm::distance(place(mesh, center_hit(mesh.view(), on(2))), glm::dvec3(-9.0, 26.0 / 6.0, 0.0)), 1e-14);
}

} // namespace
} // namespace lancer
