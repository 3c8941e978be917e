// Data of a mesh that shading needs and the description lacks: smooth normals and centres of polygons.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

namespace lancer {

// Normals of a mesh: of its faces, of its vertices, and after displacement.

// Returns a vector along a face's normal whose length is twice the face's area.
glm::dvec3 twice_area(const Mesh &mesh, uint32_t triangle);
// Returns the unit normal of a face, or 0 where it has no area.
glm::dvec3 face_normal(const Mesh &mesh, uint32_t triangle);

// Returns one normal per vertex, or 0: the sum of the faces' normals by area, as in the course's Gouraud shading.
std::vector<glm::vec3> normals_by_area(const Mesh &mesh);

// Returns one normal per vertex, so that a surface displaced along the normals does not tear: the mesh's own normals if it has
// any, otherwise the means of the faces' normals weighted by their angles.
std::vector<glm::vec3> vertex_normals(const Mesh &mesh);

// Recomputes those of the mesh's own normals that belong to the given triangles. triangles: one bit per triangle.
void renew_normals(Mesh &mesh, const std::vector<bool> &triangles);

// The places at which flat shading evaluates the colour of a polygon.

// Returns the centres by polygon number. The normal is the sum of the triangles' area vectors (Newell's). The centre is the
// mean of the polygon's vertices, projected onto a warped polygon along the normal. If a concave polygon does not contain the
// mean, the centre is the nearest place of the polygon.
std::vector<PolygonCenter> polygon_centers(const Mesh &mesh);

// Returns the hit at the centre of the polygon of the given hit; t stays. A triangle without a polygon is its own polygon.
Hit center_hit(const Mesh &mesh, const Hit &hit);

} // namespace lancer
