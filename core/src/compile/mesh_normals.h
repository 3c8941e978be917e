// What shading needs of a mesh and its user does not give: smooth normals, centres of polygons.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

namespace lancer {

// Normals of a skin of triangles: of its faces, of its vertices, and again after it has moved.

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

// Where flat shading computes the one colour of a polygon.

// By polygon number. The normal is the sum of the triangles' area vectors (Newell's). A centre is the mean of the polygon's
// vertices; of a warped polygon the place straight above or below it, along the normal; of a concave one that does not hold it
// the nearest place.
std::vector<PolygonCenter> polygon_centers(const Mesh &mesh);

// The hit of the same mesh at the centre of the polygon that hit is of; t stays. A triangle that belongs to no polygon is one.
Hit center_hit(const Mesh &mesh, const Hit &hit);

} // namespace lancer
