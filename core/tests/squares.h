// Squares of two triangles each, in one mesh.
#pragma once

#include "tiny_scene.h"

#include <glm/glm.hpp>

namespace lancer_test {

class Squares {
public:
  // across, along: from the centre to the sides. The corner (0, 0) ... (uv, uv) of an image is mapped to it.
  void add(const glm::dvec3 &middle, const glm::dvec3 &across, const glm::dvec3 &along, float uv = 1.0f, uint16_t slot = 0) {
    const uint32_t first = uint32_t(positions_.size() / 3);
    for (const auto &[u, v] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      for (int axis = 0; axis < 3; ++axis)
        positions_.push_back(float((middle + u * across + v * along)[axis]));
    for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) {
      triangles_.push_back(first + corner);
      uvs_.push_back(corner == 1 || corner == 2 ? uv : 0.0f);
      uvs_.push_back(corner >= 2 ? uv : 0.0f);
    }
    slots_.insert(slots_.end(), 2, slot);
  }

  // Valid as long as nothing is added and this object is not moved.
  lancer_mesh mesh() const {
    lancer_mesh mesh = {};
    mesh.name = "squares";
    mesh.positions = positions_.data();
    mesh.triangles = triangles_.data();
    mesh.uvs = uvs_.data();
    mesh.material_slots = slots_.data();
    mesh.vertex_count = uint32_t(positions_.size() / 3);
    mesh.triangle_count = uint32_t(triangles_.size() / 3);
    return mesh;
  }

private:
  std::vector<float> positions_, uvs_;
  std::vector<uint32_t> triangles_;
  std::vector<uint16_t> slots_;
};

} // namespace lancer_test
