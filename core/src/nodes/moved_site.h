// Places beside a hit in its tangent plane. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/mesh_lanes.h"

namespace lancer {
namespace {

// The change of barycentric weights along a triangle's plane.
template <class F> struct Plane {
  using D = DoubleOf<F>;
  Vector3<D> e1, e2; // normalised world
  D g11, g12, g22, det;

  // Computes the change of the weights of vertices 1 and 2 by an offset.
  LANCER_LANE void step(const Vector3<D> &offset, D (&weights)[2]) const {
    const D zero(0.0), d1 = dot(e1, offset), d2 = dot(e2, offset);
    const auto solid = det > zero;
    weights[0] = select(solid, (g22 * d1 - g12 * d2) / det, zero);
    weights[1] = select(solid, (g11 * d2 - g12 * d1) / det, zero);
  }
};
template <class F> Plane<F> plane_of(const Site<F> &site) {
  const Edges<F> e = edges_of(site);
  Plane<F> r;
  r.e1 = vector_to_world(site, e.first);
  r.e2 = vector_to_world(site, e.second);
  r.g11 = dot(r.e1, r.e1);
  r.g12 = dot(r.e1, r.e2);
  r.g22 = dot(r.e2, r.e2);
  r.det = r.g11 * r.g22 - r.g12 * r.g12;
  return r;
}

// Moves a site, including the attributes that bumps read, by an offset in its tangent plane (normalised world).
template <class F> void move(const Plane<F> &plane, const Vector3<DoubleOf<F>> &offset, Site<F> &site) {
  using D = DoubleOf<F>;
  site.p += offset;
  if (!any(site.on_mesh))
    return;
  // On backfaces, attributes of a mesh move in the opposite direction, because Cycles flips the derivatives of the
  // parametrisation together with the normal.
  D weights[2];
  plane.step(select(site.backfacing, -offset, offset), weights);
  for (int k = 0; k < 2; ++k)
    site.bary[k] = select(site.on_mesh, site.bary[k] + weights[k], site.bary[k]);
}

} // namespace
} // namespace lancer
