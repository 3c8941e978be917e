// The local frame of a surface point: n becomes +z.
#pragma once

#include "simd/vectors.h"

namespace lancer {

template <class F> struct Frame {
  using V = Vec3<F>;
  V t, b, n; // orthonormal, right-handed

  Frame() = default;

  // n must be unit. Duff et al. 2017: no direction is near a singularity.
  LANCER_LANE explicit Frame(const V &normal) : n(normal) {
    const F sign = copysign(F(1.0f), n.z);
    const F a = -1.0f / (sign + n.z);
    const F c = n.x * n.y * a;
    t = V(1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x);
    b = V(c, sign + n.y * n.y * a, -n.y);
  }

  // t lies in the plane of n and tangent; it is arbitrary if they are parallel.
  LANCER_LANE Frame(const V &normal, const V &tangent) : Frame(normal) {
    const V across = cross(normal, tangent);
    const F length2 = dot(across, across);
    const auto apart = length2 > 0.0f;
    b = select(apart, across / sqrt(length2), b);
    t = select(apart, cross(b, normal), t);
  }

  LANCER_LANE V to_local(const V &w) const { return {dot(w, t), dot(w, b), dot(w, n)}; }
  LANCER_LANE V to_world(const V &w) const { return w.x * t + w.y * b + w.z * n; }
};
Frame(const glm::vec3 &)->Frame<float>;
Frame(const glm::vec3 &, const glm::vec3 &)->Frame<float>;

// Returns the mirrored direction in the local frame.
template <class V> LANCER_LANE V reflect_local(const V &w) { return {-w.x, -w.y, w.z}; }

// Returns tan^2 of a direction's angle to n. Not computed from 1 - cos^2, which loses a small roughness in rounding.
template <class V> LANCER_LANE NumberOf<V> tan2_theta(const V &w) { return (w.x * w.x + w.y * w.y) / (w.z * w.z); }

} // namespace lancer
