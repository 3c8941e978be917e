// The surface at a hit.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

namespace lancer {

struct Surface {
  glm::dvec3 p{0.0};     // normalised world, on the surface to a few ulp of double
  double offset = 0.0;   // bound on p's distance from the surface as seen by later rays
  glm::vec3 ng{0, 0, 1}; // outward geometric normal, unit
  glm::vec3 ns{0, 0, 1}; // shading normal, unit; may be on the other side of ng
  glm::dvec2 bary{0.0};  // weights of vertices 1 and 2; 0 on an exact surface
  uint32_t instance = kNone;
  uint32_t primitive = kNone;
  uint32_t material = kNone;
};

// Returns the surface at the hit of a ray. slots: material numbers of all instances.
Surface surface_at(const Geometry &geometry, const std::vector<uint32_t> &slots, const Ray &ray, const Hit &hit);

// Attributes of the surface, computed separately because few callers need them.
struct SurfaceAttributes {
  glm::vec2 uv{0.0f}; // texture coordinates; a mesh without them has barycentric weights, an exact surface its parametrisation
  glm::vec3 color{1.0f}; // vertex colour; white without one
};
SurfaceAttributes attributes_at(const Geometry &geometry, const Surface &surface);

// Reads the normals at a triangle's corners in object space, of any length; returns false if the triangle is flat.
bool corner_normals(const Mesh &mesh, Shading shading, uint32_t triangle, glm::vec3 (&n)[3]);
// Returns the interpolated normal; 0 if the surface is flat. bary: see Surface::bary.
glm::vec3 interpolated_normal(const Mesh &mesh, Shading shading, uint32_t triangle, const glm::dvec2 &bary);

// Returns a ray that leaves the surface towards d (need not be unit): it starts on the side of d and does not hit its own
// primitive.
Ray leave(const Surface &surface, const glm::dvec3 &d, double tmax);

// Returns the material number of a primitive of an instance; kNone without slots.
uint32_t material_of(const Geometry &geometry, const std::vector<uint32_t> &slots, uint32_t instance, uint32_t primitive);

} // namespace lancer
