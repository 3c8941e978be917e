// Named attributes of a mesh at a point of a triangle.
#pragma once

#include "scene/geometry.h"
#include "simd/vectors.h"

namespace lancer {

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
const MeshAttribute *find_attribute(const Mesh &mesh, uint32_t name);

// Reads an attribute at a triangle's corners. One channel is copied to x, y and z; with two or three, z is 0 and w is 1 if
// missing.
void corner_values(const Mesh &mesh, const MeshAttribute &attribute, uint32_t triangle, glm::vec4 (&values)[3]);

// Reads the texture coordinates at a triangle's corners: the mesh's own (name 0) or an attribute's. Returns false if there are
// none.
bool corner_uvs(const Mesh &mesh, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]);
bool corner_uvs(const Mesh &mesh, const MeshAttribute *attribute, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]);
// Returns interpolated texture coordinates; 0 if there are none. bary: weights of vertices 1 and 2.
glm::vec2 uv_at(const Mesh &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary);

} // namespace lancer
