// Vertex normals weighted by the area of the faces.
#include "compile/steps.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lancer {
namespace {

TEST(MeshNormals, ByAreaWeighALargeFaceMore) {
  // On the edge along z a face of area 1 facing y and one of area 3 facing x; a vertex without a face.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 2}, {1, 0, 0}, {0, -3, 0}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const std::vector<glm::vec3> normals = normals_by_area(mesh);
  ASSERT_EQ(normals.size(), 5u);
  const glm::vec3 both(glm::dvec3(3, 1, 0) / std::sqrt(10.0));
  // In double, so that float's last bit may differ if a rounding is on its edge: 2^-24 of a component below 1.
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(normals[0][i], both[i], 0x1p-24);
    EXPECT_NEAR(normals[1][i], both[i], 0x1p-24);
  }
  EXPECT_EQ(normals[2], glm::vec3(0, 1, 0));
  EXPECT_EQ(normals[3], glm::vec3(1, 0, 0));
  EXPECT_EQ(normals[4], glm::vec3(0));
}

} // namespace
} // namespace lancer
