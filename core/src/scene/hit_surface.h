// The surface at a hit: a template over the number type; surface_at() is its width 1.
#pragma once

#include "scene/affine.h"
#include "scene/quadric_point.h"
#include "simd/memory.h"

namespace lancer {

// The placement of each lane's instance: the doubles of Instance from to_world on.
template <class F> struct Placements {
  static constexpr int kWidth = LanesOf<F>::kWidth;
  static constexpr int kToWorld = 0, kToObject = 12, kThere = 24, kMoved = 25, kBack = 26, kMovedBack = 27;

  const double *const *of;
  bool same; // whether all lanes have the same placement

  LANCER_LANE explicit Placements(const double *const *lanes) : of(lanes), same(all_equal<kWidth>(lanes)) {}

  LANCER_LANE DoubleOf<F> operator[](int at) const {
    if constexpr (kWidth == 1)
      return of[0][at];
    else {
      if (same)
        return DoubleOf<F>(of[0][at]);
      alignas(64) double values[kWidth];
      for (int i = 0; i < kWidth; ++i)
        values[i] = of[i][at];
      return load_lanes<kWidth>(values);
    }
  }
  LANCER_LANE Double3Of<F> vector(int first) const { return {(*this)[first], (*this)[first + 1], (*this)[first + 2]}; }
};

// A 3 x 3 matrix in columns, and a translation.
template <class F> struct MapLanes {
  using D3 = Double3Of<F>;
  D3 x, y, z, translation;

  LANCER_LANE explicit MapLanes(const Affine &map)
      : x(broadcast(map.linear[0])), y(broadcast(map.linear[1])), z(broadcast(map.linear[2])),
        translation(broadcast(map.translation)) {}
  LANCER_LANE MapLanes(const Placements<F> &placements, int at)
      : x(placements.vector(at)), y(placements.vector(at + 3)), z(placements.vector(at + 6)),
        translation(placements.vector(at + 9)) {}
  LANCER_LANE D3 vector(const D3 &v) const {
    return {x.x * v.x + y.x * v.y + z.x * v.z, x.y * v.x + y.y * v.y + z.y * v.z, x.z * v.x + y.z * v.y + z.z * v.z};
  }
  LANCER_LANE D3 point(const D3 &p) const { return vector(p) + translation; }
  LANCER_LANE D3 transposed(const D3 &v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }

private:
  static LANCER_LANE D3 broadcast(const glm::dvec3 &v) { return {DoubleOf<F>(v.x), DoubleOf<F>(v.y), DoubleOf<F>(v.z)}; }
};

template <class D> LANCER_LANE D largest_of(const Vector3<D> &v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Normalises a vector that is not zero.
template <class F> LANCER_LANE Vector3<F> unit(const Double3Of<F> &v) {
  using D = DoubleOf<F>;
  const D length2 = dot(v, v);
  const MaskOf<F> within = (length2 > D(1e-200)) & (length2 < D(1e200));
  Vector3<F> result = narrow(v * (D(1.0) / sqrt(length2)));
  // Squares of very small or large normals leave the range of double: scale by the largest component first.
  if (!all(within))
    result = select(within, result, narrow(normalize(v / largest_of(v))));
  return result;
}

// Returns a bound on the distance between the computed point and the surface after a round trip through the maps. Each
// coordinate of M p + T is three products and three sums, with an error of at most gamma(4) times the sum of absolute values.
// The ray that leaves is mapped back with an error of the same kind, which M enlarges again. 2^-49 is eight times the unit
// roundoff of double.
template <class F>
LANCER_LANE DoubleOf<F> position_bound(const Placements<F> &placed, const Double3Of<F> &p_object, const Double3Of<F> &p_world) {
  using P = Placements<F>;
  const DoubleOf<F> reach = placed[P::kThere];
  const DoubleOf<F> there = reach * largest_of(p_object) + placed[P::kMoved];
  const DoubleOf<F> back = reach * (placed[P::kBack] * largest_of(p_world) + placed[P::kMovedBack]);
  return (there + back) * DoubleOf<F>(0x1p-49);
}

// See Surface.
template <class F> struct SurfaceLanes {
  Double3Of<F> p;
  DoubleOf<F> offset;
  Vector3<F> ng, ns; // outwards
};

// Returns the surface at a point of a triangle given by the weights of its corners 1 and 2. n: normals of the corners, read in
// the lanes of smooth.
template <class F>
LANCER_LANE SurfaceLanes<F> triangle_surface(const Placements<F> &placed, const Vector3<F> (&v)[3], const Vector3<F> (&n)[3],
                                             MaskOf<F> smooth, DoubleOf<F> u, DoubleOf<F> w) {
  using D3 = Double3Of<F>;
  const MapLanes<F> to_world(placed, Placements<F>::kToWorld), to_object(placed, Placements<F>::kToObject);
  SurfaceLanes<F> surface;
  // Compute the point from its weights: it lies in the triangle's plane for a ray of any length.
  const DoubleOf<F> first = DoubleOf<F>(1.0) - u - w;
  const D3 v0 = widen(v[0]), v1 = widen(v[1]), v2 = widen(v[2]);
  surface.p = to_world.point(first * v0 + u * v1 + w * v2);
  surface.offset = position_bound(placed, max(abs(v0), max(abs(v1), abs(v2))), surface.p);
  // The inverse transpose keeps the outward side of a normal, also for mirrored maps.
  surface.ng = unit<F>(to_object.transposed(cross(v1 - v0, v2 - v0)));
  surface.ns = surface.ng;
  if (any(smooth)) {
    const Vector3<F> between = narrow(first) * n[0] + narrow(u) * n[1] + narrow(w) * n[2];
    surface.ns = select(smooth & !black(between), unit<F>(to_object.transposed(widen(between))), surface.ng);
  }
  return surface;
}

// Returns the surface at a hit on an exact surface. o, d: the ray; t: the hit.
template <class F>
LANCER_LANE SurfaceLanes<F> quadric_surface(const Placements<F> &placed, const QuadricKinds<F> &kinds, const Double3Of<F> &o,
                                            const Double3Of<F> &d, DoubleOf<F> t) {
  const MapLanes<F> to_world(placed, Placements<F>::kToWorld), to_object(placed, Placements<F>::kToObject);
  const QuadricPoint<F> point = quadric_point(kinds, Double3Of<F>(to_object.point(o) + t * to_object.vector(d)));
  SurfaceLanes<F> surface;
  surface.p = to_world.point(point.p);
  surface.offset = position_bound(placed, max(abs(point.p), Double3Of<F>(DoubleOf<F>(1.0))), surface.p);
  surface.ng = surface.ns = unit<F>(to_object.transposed(point.n));
  return surface;
}

// Returns the origin of a ray that leaves a surface towards d: on the side of d, beyond the error bound of p. ng: outwards.
template <class D>
LANCER_LANE Vector3<D> origin_towards(const Vector3<D> &p, D offset, const Vector3<D> &ng, const Vector3<D> &d) {
  const D side = select(dot(ng, d) < D(0.0), D(-1.0), D(1.0));
  return p + side * offset * ng;
}

} // namespace lancer
