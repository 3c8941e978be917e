// Which faces of a mesh can be traced, and a mesh of some of its faces only.
#pragma once

#include "scene/geometry.h"

namespace lancer {

// Finite, and not beyond 2^60, where squares leave float's range; no scene is measured so.
bool is_usable(const glm::vec3 &vertex);
// More than 0, in double.
bool has_area(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c);

// Leaves the triangles with these numbers, in rising order, with all that belongs to them.
void keep_faces(Mesh &mesh, const std::vector<uint32_t> &kept);

} // namespace lancer
