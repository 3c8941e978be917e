// What the scene is like where a ray has met it.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

namespace lancer {

struct Surface {
  glm::dvec3 p{0.0};     // normalised world, on the surface to a few ulp of double
  double offset = 0.0;   // bound of p's distance from the surface as any later ray sees it
  glm::vec3 ng{0, 0, 1}; // outward geometric normal, unit
  glm::vec3 ns{0, 0, 1}; // shading normal, unit; on the other side of ng where the mesh has it so
  glm::dvec2 bary{0.0};  // weights of vertex 1 and 2; 0 on an exact surface
  uint32_t instance = kNone;
  uint32_t primitive = kNone;
  uint32_t material = kNone;
};

// The hit of ray with the geometry, with interpolated attributes. slots: material numbers of all instances.
Surface surface_at(const Geometry &geometry, const std::vector<uint32_t> &slots, const Ray &ray, const Hit &hit);

// What is painted on the surface; asked for only where something reads it.
struct SurfaceAttributes {
  glm::vec2 uv{0.0f};    // texture coordinates; barycentrics on a mesh without, the parametrisation of an exact surface
  glm::vec3 color{1.0f}; // vertex colour; white on what has none
};
SurfaceAttributes attributes_at(const Geometry &geometry, const Surface &surface);

// The normals at a triangle's corners in the object's space, of any length; false where it is flat.
bool corner_normals(const Mesh &mesh, Shading shading, uint32_t triangle, glm::vec3 (&n)[3]);
// The normal between them; 0 where the surface is flat. bary: as Surface::bary.
glm::vec3 interpolated_normal(const Mesh &mesh, Shading shading, uint32_t triangle, const glm::dvec2 &bary);

// A ray that leaves the surface towards d (need not be unit): it starts on the side of d and cannot meet its own primitive.
Ray leave(const Surface &surface, const glm::dvec3 &d, double tmax);

// The material number of a primitive of an instance; kNone without slots.
uint32_t material_of(const Geometry &geometry, const std::vector<uint32_t> &slots, uint32_t instance, uint32_t primitive);

} // namespace lancer
