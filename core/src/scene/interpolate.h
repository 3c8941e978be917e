// Between the corners of a triangle.
#pragma once

#include "simd/vectors.h"

namespace lancer {

template <class F>
LANCER_LANE Vector3<F> interpolate(const Vector3<F> &a, const Vector3<F> &b, const Vector3<F> &c, const Vector3<F> &weights) {
  return weights.x * a + weights.y * b + weights.z * c;
}
// Of texture coordinates, in double.
template <class D> LANCER_LANE auto interpolate_uv(const D &a, const D &b, const D &c, const D &u, const D &v) {
  return narrow((D(1.0) - u - v) * a + u * b + v * c);
}

} // namespace lancer
