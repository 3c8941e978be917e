// Named attributes of a mesh, at a place of one of its triangles.
#pragma once

#include "scene/geometry.h"
#include "simd/vectors.h"

namespace lancer {

// Between the corners of a triangle.

template <class F>
LANCER_LANE Vector3<F> interpolate(const Vector3<F> &a, const Vector3<F> &b, const Vector3<F> &c, const Vector3<F> &weights) {
  return weights.x * a + weights.y * b + weights.z * c;
}
// Of texture coordinates, in double.
template <class D> LANCER_LANE auto interpolate_uv(const D &a, const D &b, const D &c, const D &u, const D &v) {
  return narrow((D(1.0) - u - v) * a + u * b + v * c);
}

// The number under which a mesh keeps its vertices as they were before displacement: it stands for no name, so that no
// attribute or node can use it by mistake.
inline constexpr uint32_t kUndisplaced = UINT32_MAX;

// The attribute with this number of a name; null where the mesh has none.
const MeshAttribute *find_attribute(const Mesh &mesh, uint32_t name);

// At a triangle's corners. One channel is in all of x, y, z; two or three leave z at 0 and w at 1.
void corner_values(const Mesh &mesh, const MeshAttribute &attribute, uint32_t triangle, glm::vec4 (&values)[3]);

// The texture coordinates at a triangle's corners: the mesh's own (name 0) or an attribute, which may have been found before;
// false where there are none.
bool corner_uvs(const Mesh &mesh, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]);
bool corner_uvs(const Mesh &mesh, const MeshAttribute *attribute, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]);
// Between them; 0 where there are none. bary: weights of vertex 1 and 2.
glm::vec2 uv_at(const Mesh &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary);

} // namespace lancer
