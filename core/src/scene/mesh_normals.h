// Normals of a skin of triangles: of its faces, of its vertices, and again after it has moved.
#pragma once

#include "scene/geometry.h"

namespace lancer {

// Along a face's normal, of the length of twice its area.
glm::dvec3 twice_area(const Mesh &mesh, uint32_t triangle);
// Unit, or 0.
glm::dvec3 face_normal(const Mesh &mesh, uint32_t triangle);

// One for each vertex, or 0: the sum of the faces' normals by area, as the course's Gouraud shading has it.
std::vector<glm::vec3> normals_by_area(const Mesh &mesh);

// One for each vertex, whatever the shading, so that a skin that moves along them does not tear: the mesh's own where it has
// them, else the faces' by their angles.
std::vector<glm::vec3> vertex_normals(const Mesh &mesh);

// Makes the mesh's own normals anew where they belong to these triangles (one bit each).
void renew_normals(Mesh &mesh, const std::vector<bool> &triangles);

} // namespace lancer
