// Shadow rays near the end of the lit side of smooth meshes: they start on the curved surface that the normals stand for, so
// that the triangles' own edges throw no shadow there. The way of Hanika, Hacking the Shadow Terminator (Ray Tracing Gems II,
// 4).
#pragma once

#include "scene/geometry.h"
#include "scene/surface.h"

namespace lancer {

// How far to lift the start of a ray towards the unit direction wi, in the normalised world; n: the shading normal, ng: the
// geometric one, both on the viewer's side. 0 where the mesh is not smooth or wi is far enough from grazing.
glm::dvec3 terminator_offset(const Geometry &geometry, const Surface &surface, const glm::vec3 &n, const glm::vec3 &ng,
                             const glm::vec3 &wi);

} // namespace lancer
