// Mesh data at a hit, in lanes of F: named attributes, texture coordinates, normals, corners. Each lane reads its own triangle.
// Internal linkage, as in lanes.h.
#pragma once

#include "nodes/site.h"
#include "scene/surface.h"

namespace lancer {
namespace {

// An attribute of every lane's mesh.
template <class F> struct AttributeLanes {
  const MeshAttribute *of[Site<F>::kWidth];
  MaskOf<F> found;
};
template <class F> LANCER_LANE AttributeLanes<F> find_attributes(const Site<F> &site, uint32_t name) {
  AttributeLanes<F> r;
  for (int i = 0; i < Site<F>::kWidth; ++i)
    r.of[i] = !site.mesh[i]                               ? nullptr
              : i > 0 && site.mesh[i] == site.mesh[i - 1] ? r.of[i - 1]
                                                          : find_attribute(*site.mesh[i], name);
  r.found = by_lane<MaskOf<F>>([&](int i) { return r.of[i] != nullptr; });
  return r;
}

// An attribute at the corners of every lane's triangle, and whether it has one value per face; 0 in lanes without it.
template <class F> struct CornerValues {
  Value<F> corner[3];
  MaskOf<F> face;
};
template <class F> CornerValues<F> corner_values(const Site<F> &site, const AttributeLanes<F> &attribute) {
  constexpr int width = Site<F>::kWidth;
  alignas(64) float numbers[3][4][width];
  for (int i = 0; i < width; ++i) {
    glm::vec4 at[3] = {};
    if (attribute.of[i])
      corner_values(*site.mesh[i], *attribute.of[i], site.primitive[i], at);
    for (int corner = 0; corner < 3; ++corner)
      for (int k = 0; k < 4; ++k)
        numbers[corner][k][i] = (&at[corner].x)[k];
  }
  CornerValues<F> r;
  for (int corner = 0; corner < 3; ++corner) {
    const auto &n = numbers[corner];
    r.corner[corner] = {{load_lanes<width>(n[0]), load_lanes<width>(n[1]), load_lanes<width>(n[2])}, load_lanes<width>(n[3])};
  }
  r.face = by_lane<MaskOf<F>>([&](int i) { return attribute.of[i] && attribute.of[i]->domain == Domain::Face; });
  return r;
}

// Returns the attribute interpolated with these weights.
template <class F> LANCER_LANE Value<F> between(const CornerValues<F> &of, const Vector3<F> &weights) {
  const Value<F> &a = of.corner[0], &b = of.corner[1], &c = of.corner[2];
  const Value<F> mixed{interpolate(a.v, b.v, c.v, weights), weights.x * a.alpha + weights.y * b.alpha + weights.z * c.alpha};
  return select(of.face, a, mixed);
}
template <class F> LANCER_LANE Value<F> attribute_at(const Site<F> &site, const AttributeLanes<F> &attribute) {
  return between(corner_values(site, attribute), site.weights());
}

// Texture coordinates at the corners; found: whether they exist.
template <class F> struct CornerUVs {
  F u[3], v[3];
  MaskOf<F> found;
};
template <class F> CornerUVs<F> corner_uvs(const Site<F> &site, const AttributeLanes<F> &attribute, uint32_t name) {
  constexpr int width = Site<F>::kWidth;
  alignas(64) float numbers[2][3][width];
  uint32_t found = 0;
  for (int i = 0; i < width; ++i) {
    glm::vec2 uvs[3] = {};
    const bool is_map = !attribute.of[i] || attribute.of[i]->channels == 2;
    if (site.mesh[i] && is_map && corner_uvs(*site.mesh[i], attribute.of[i], name, site.primitive[i], uvs))
      found |= 1u << i;
    for (int corner = 0; corner < 3; ++corner) {
      numbers[0][corner][i] = uvs[corner].x;
      numbers[1][corner][i] = uvs[corner].y;
    }
  }
  CornerUVs<F> r;
  for (int corner = 0; corner < 3; ++corner) {
    r.u[corner] = load_lanes<width>(numbers[0][corner]);
    r.v[corner] = load_lanes<width>(numbers[1][corner]);
  }
  r.found = by_lane<MaskOf<F>>([&](int i) { return (found >> i & 1) != 0; });
  return r;
}

// Loads three floats per corner in each lane.
template <class F, class Read> LANCER_LANE void load_corners(const Site<F> &site, const Read &read, Vector3<F> (&r)[3]) {
  constexpr int width = Site<F>::kWidth;
  alignas(64) float numbers[3][3][width];
  for (int i = 0; i < width; ++i) {
    glm::vec3 at[3] = {};
    if (site.mesh[i])
      read(i, at);
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        numbers[corner][axis][i] = (&at[corner].x)[axis];
  }
  for (int corner = 0; corner < 3; ++corner)
    r[corner] = {load_lanes<width>(numbers[corner][0]), load_lanes<width>(numbers[corner][1]),
                 load_lanes<width>(numbers[corner][2])};
}

// Returns the interpolated normal in object space, of any length; 0 if the surface is flat.
template <class F> Vector3<F> interpolated_normal(const Site<F> &site) {
  Vector3<F> n[3];
  load_corners(
      site,
      [&](int i, glm::vec3(&at)[3]) {
        corner_normals(*site.mesh[i], site.instance[i]->shading, site.primitive[i], site.time[i], at);
      },
      n);
  return interpolate(n[0], n[1], n[2], site.weights());
}

// The triangle's edges from its first corner, in object space.
template <class F> struct Edges { Vector3<DoubleOf<F>> first, second; };
template <class F> Edges<F> edges_of(const Site<F> &site) {
  Vector3<F> v[3];
  load_corners(
      site,
      [&](int i, glm::vec3(&at)[3]) {
        const MeshView &mesh = *site.mesh[i];
        for (int corner = 0; corner < 3; ++corner)
          at[corner] = mesh.vertex(site.primitive[i], corner, site.time[i]);
      },
      v);
  const Vector3<DoubleOf<F>> v0 = widen(v[0]);
  return {widen(v[1]) - v0, widen(v[2]) - v0};
}

} // namespace
} // namespace lancer
