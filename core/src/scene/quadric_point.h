// Exact surfaces in their unit frames: the nearest surface point, its parametrisation and parts.
#pragma once

#include "scene/geometry.h"
#include "simd/vectors.h"

namespace lancer {

// The shape of each lane; lanes in none of the masks are spheres.
template <class F> struct QuadricKinds { MaskOf<F> plane, cylinder, cone; };

template <class F> struct QuadricPoint {
  Double3Of<F> p; // on the surface
  Double3Of<F> n; // outward geometric normal, unit
};

// Returns the nearest point of a cylinder or cone: on the side or on a disk.
template <class F> LANCER_LANE QuadricPoint<F> tube_point(MaskOf<F> cone, const Double3Of<F> &at) {
  using D = DoubleOf<F>;
  using D3 = Double3Of<F>;
  const D zero(0.0), one(1.0), half(0.5), root5(2.23606797749978969641);
  const D r = sqrt(at.x * at.x + at.y * at.y);
  const D radius = select(cone, half * (one - at.z), one);
  const D to_side = abs(r - radius) * select(cone, D(2.0) / root5, one);
  const D to_disk = select(cone, abs(at.z + one), abs(abs(at.z) - one));
  const MaskOf<F> off_axis = r > zero, on_disk = to_disk < to_side;
  const D x = select(off_axis, at.x / r, one), y = select(off_axis, at.y / r, zero);
  const D inside = min(r, one), end = select(cone, D(-1.0), sign(at.z));
  const D z = select(at.z < D(-1.0), D(-1.0), select(one < at.z, one, at.z));
  const D width = select(cone, half * (one - z), one);
  const D3 slope = select(off_axis, D3{D(2.0) * x / root5, D(2.0) * y / root5, one / root5}, D3{zero, zero, one});
  return {select(on_disk, D3{x * inside, y * inside, end}, D3{x * width, y * width, z}),
          select(on_disk, D3{zero, zero, end}, select(cone, slope, D3{x, y, zero}))};
}

template <class F> LANCER_LANE QuadricPoint<F> quadric_point(const QuadricKinds<F> &kinds, const Double3Of<F> &at) {
  using D = DoubleOf<F>;
  using D3 = Double3Of<F>;
  const D zero(0.0);
  const D length = sqrt(dot(at, at));
  const D3 up{zero, zero, D(1.0)}, on_sphere = select(length > zero, at / length, up);
  QuadricPoint<F> point{select(kinds.plane, D3{at.x, at.y, zero}, on_sphere), select(kinds.plane, up, on_sphere)};
  const MaskOf<F> tube = kinds.cylinder | kinds.cone;
  if (any(tube)) {
    const QuadricPoint<F> of_tube = tube_point<F>(kinds.cone, at);
    point.p = select(tube, of_tube.p, point.p);
    point.n = select(tube, of_tube.n, point.n);
  }
  return point;
}

// Points of exact surfaces in their unit frames (see lancer.h): position and parametrisation.

inline QuadricKinds<float> kinds_of(ShapeKind kind) {
  return {kind == ShapeKind::Plane, kind == ShapeKind::Cylinder, kind == ShapeKind::Cone};
}

struct SurfacePoint {
  glm::dvec3 p; // on the surface, object space
  glm::dvec3 n; // outward geometric normal, unit, object space
};

// Returns the point o + t d of an object-space ray, projected onto the surface.
SurfacePoint quadric_point(ShapeKind kind, const glm::dvec3 &o, const glm::dvec3 &d, double t);

// Returns the parametrisation at an object-space surface point. Sphere: longitude, latitude; cylinder and cone: angle, height;
// all in [0, 1]. Plane: x, y.
glm::dvec2 quadric_uv(ShapeKind kind, const glm::dvec3 &p);

} // namespace lancer
