// The surface at a hit, and attributes of meshes there.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"
#include "simd/vectors.h"

namespace lancer {

struct Surface {
  glm::dvec3 p{0.0};     // normalised world, on the surface to a few ulp of double
  double offset = 0.0;   // bound on p's distance from the surface as seen by later rays: a ray starts this far off
  glm::vec3 ng{0, 0, 1}; // outward geometric normal, unit
  glm::vec3 ns{0, 0, 1}; // shading normal, unit; may be on the other side of ng
  glm::dvec2 bary{0.0};  // weights of vertices 1 and 2; 0 on an exact surface
  uint32_t instance = kNone;
  uint32_t primitive = kNone;
  uint32_t material = kNone;
  float time = kMiddleTime; // of the ray that has hit it
};

// Returns the surface at the hit of a ray, at the time of the ray. slots: material numbers of all instances.
Surface surface_at(const GeometryView &geometry, std::span<const uint32_t> slots, const Ray &ray, const Hit &hit);

// Attributes of the surface, computed separately because few callers need them.
struct SurfaceAttributes {
  glm::vec2 uv{0.0f}; // texture coordinates; a mesh without them has barycentric weights, an exact surface its parametrisation
  glm::vec3 color{1.0f}; // vertex colour; white without one
};
SurfaceAttributes attributes_at(const GeometryView &geometry, const Surface &surface);

// Reads the normals at a triangle's corners in object space, of any length; returns false if the triangle is flat.
bool corner_normals(const MeshView &mesh, Shading shading, uint32_t triangle, float time, glm::vec3 (&n)[3]);
// Returns the interpolated normal of a mesh that keeps its shape; 0 if the surface is flat. bary: see Surface::bary.
glm::vec3 interpolated_normal(const MeshView &mesh, Shading shading, uint32_t triangle, const glm::dvec2 &bary);

// Returns a ray that leaves the surface towards d (need not be unit): it starts on the side of d and does not hit its own
// primitive.
Ray ray_from(const Surface &surface, const glm::dvec3 &d, double tmax);

// Returns the material number of a primitive of an instance; kNone without slots.
uint32_t material_of(const GeometryView &geometry, std::span<const uint32_t> slots, uint32_t instance, uint32_t primitive);

// Interpolates between the corners of a triangle.

template <class F>
LANCER_LANE Vector3<F> interpolate(const Vector3<F> &a, const Vector3<F> &b, const Vector3<F> &c, const Vector3<F> &weights) {
  return weights.x * a + weights.y * b + weights.z * c;
}
// Interpolates texture coordinates, in double.
template <class D> LANCER_LANE auto interpolate_uv(const D &a, const D &b, const D &c, const D &u, const D &v) {
  return narrow((D(1.0) - u - v) * a + u * b + v * c);
}

// The attribute number of a mesh's vertex positions before displacement. It is not the number of any name, so that no other
// attribute and no node can use it.
inline constexpr uint32_t kUndisplaced = UINT32_MAX;

// Returns the attribute with this name number; null if the mesh has none.
const MeshAttribute *find_attribute(const MeshView &mesh, uint32_t name);

// Reads an attribute at a triangle's corners. One channel is copied to x, y and z; with two or three, z is 0 and w is 1 if
// missing.
void corner_values(const MeshView &mesh, const MeshAttribute &attribute, uint32_t triangle, glm::vec4 (&values)[3]);

// Returns an attribute within a triangle; 0 with w of 1 if the mesh has none of this name. bary: weights of corners 1 and 2.
glm::vec4 attribute_at(const MeshView &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary);

// Reads the texture coordinates at a triangle's corners: the mesh's own (name 0) or an attribute's. Returns false if there are
// none.
bool corner_uvs(const MeshView &mesh, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]);
bool corner_uvs(const MeshView &mesh, const MeshAttribute *attribute, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]);
// Returns interpolated texture coordinates; 0 if there are none. bary: weights of vertices 1 and 2.
glm::vec2 uv_at(const MeshView &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary);

// Fills a ray that leaves the surface of a hit from an origin off the surface. The ray is written in place.
inline void write_ray(const Hit &hit, const glm::dvec3 &o, const glm::dvec3 &d, double tmax, uint32_t kinds, float time,
                      Ray &ray) {
  ray.o = o;
  ray.d = d;
  ray.tmax = tmax;
  ray.skip_instance = hit.instance;
  ray.skip_primitive = hit.primitive;
  ray.kinds = kinds;
  ray.time = time;
}

} // namespace lancer
