// A face of an emitting mesh relative to the shaded point: a near face is sampled by solid angle, a far one by area. F is a
// float, or lanes of floats.
#pragma once

#include "sampling/warp.h"
#include "scene/hit_surface.h"

namespace lancer {

template <class F> struct SeenFace {
  using D = DoubleOf<F>;
  using D3 = Double3Of<F>;
  // A face whose area is below kFar times the squared distance of its middle is sampled by area, which has as little noise at
  // that distance. Solid angles below kLeastAngle or above kMostAngle occur where the face is seen edge on or the point lies on
  // it.
  static constexpr double kFar = 0.01, kLeastAngle = 1e-6, kMostAngle = 6.28;

  D3 v0, e1, e2;
  D area;
  SphericalTriangle<D> directions; // of near faces
  MaskOf<F> by_angle;              // lanes that sample by solid angle

  // corner: in the object's space.
  LANCER_LANE SeenFace(const MapLanes<F> &to_world, const Vector3<F> (&corner)[3], const D3 &p)
      : v0(to_world.point(widen(corner[0])) - p), e1(to_world.vector(widen(corner[1]) - widen(corner[0]))),
        e2(to_world.vector(widen(corner[2]) - widen(corner[0]))), area(D(0.5) * sqrt(dot(cross(e1, e2), cross(e1, e2)))),
        directions(v0, v0 + e1, v0 + e2) {
    const D3 middle = v0 + (e1 + e2) / D(3.0);
    by_angle = (area > D(kFar) * dot(middle, middle)) & (directions.solid_angle > D(kLeastAngle)) &
               (directions.solid_angle < D(kMostAngle));
  }

  // Returns the weights of corners 1 and 2 of the sampled point.
  LANCER_LANE Vector2<D> sample(F u, F v) const {
    const Vector2<F> by_area = warp_triangle(u, v);
    const Vector2<D> weights{widen(by_area.x), widen(by_area.y)};
    if (!any(by_angle))
      return weights;
    const Vector2<D> met = weights_towards(directions.sample(widen(u), widen(v)));
    return {select(by_angle, met.x, weights.x), select(by_angle, met.y, weights.y)};
  }

  // Returns the density per solid angle of a point of the face. v: towards the point, of any length; ng: unit, of the face.
  LANCER_LANE D pdf(const D3 &v, const Vector3<F> &ng) const {
    const D zero(0.0), d2 = dot(v, v), cosine = abs(dot(widen(ng), v)) / sqrt(d2);
    const D density = select(by_angle, D(1.0) / directions.solid_angle, d2 / (cosine * area));
    return select((cosine > zero) & (d2 > zero), density, zero);
  }

private:
  // Returns the weights of corners 1 and 2 where a direction hits the face's plane; those of the face's middle where rounding
  // makes the direction parallel to the plane.
  LANCER_LANE Vector2<D> weights_towards(const D3 &wi) const {
    const D zero(0.0), one(1.0), third(1.0 / 3.0);
    const D3 across = cross(wi, e2);
    const D cosine = dot(across, e1), scale = one / cosine;
    const D u = min(max(-dot(v0, across) * scale, zero), one);
    const D w = min(max(-dot(wi, cross(v0, e1)) * scale, zero), one - u);
    const auto along = cosine == zero;
    return {select(along, third, u), select(along, third, w)};
  }
};

} // namespace lancer
