// One mesh may have flat and smooth instances: a flat one has no curved surface on which shadow rays start.
#include "integrator/stages/terminator.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lancer {
namespace {

// A triangle without normals of its own, and the normals computed for a smooth instance.
struct OneTriangle {
  const float r = std::sqrt(0.5f);
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, bent = {{-r, 0, r}, {r, 0, r}, {0, r, r}};
  const std::vector<glm::uvec3> triangles = {{0, 1, 2}};
  MeshView mesh;
  std::vector<Instance> instances;

  explicit OneTriangle(NormalDomain domain) {
    mesh.positions = positions;
    mesh.triangles = triangles;
    mesh.normal_domain = domain;
    (domain == NormalDomain::None ? mesh.smooth_normals : mesh.normals) = bent;
    for (const Shading shading : {Shading::AsMesh, Shading::Flat, Shading::Gouraud, Shading::Phong}) {
      Instance &instance = instances.emplace_back();
      instance.place(Affine{});
      instance.shading = shading;
      instance.terminator = 0.5f;
    }
  }
  GeometryView geometry() const { return {{&mesh, 1}, instances, {}, {}}; }
};

TEST(SurfaceNormals, OnlyWhatIsShadedSmoothIsLifted) {
  for (const NormalDomain domain : {NormalDomain::None, NormalDomain::Vertex, NormalDomain::Corner}) {
    const OneTriangle triangle(domain);
    const GeometryView geometry = triangle.geometry();
    for (uint32_t i = 0; i < 4; ++i) {
      const Shading shading = geometry.instances[i].shading;
      SCOPED_TRACE(int(shading));
      Surface surface;
      surface.instance = i;
      surface.primitive = 0;
      surface.bary = {0.25, 0.25};
      // Grazing light, with the full offset.
      const glm::vec3 up(0, 0, 1), wi = glm::normalize(glm::vec3(1.0f, 0.0f, 0.01f));
      const bool smooth = interpolated_normal(geometry.meshes[0], shading, 0, surface.bary) != glm::vec3(0.0f);
      EXPECT_EQ(smooth, shading != Shading::Flat && (domain != NormalDomain::None || shading != Shading::AsMesh));
      EXPECT_EQ(terminator_offset(geometry, surface, up, up, wi) != glm::dvec3(0.0), smooth);
    }
  }
}

} // namespace
} // namespace lancer
