// The Gradient Texture: a ramp from 0 to 1 along, around or away from an axis.
#pragma once

#include "lancer.h"
#include "sampling/angle.h"
#include "simd/vectors.h"

namespace lancer {

// kind: LANCER_GRADIENT_*.
template <class F> LANCER_LANE F gradient_texture(uint32_t kind, const Vector3<F> &p) {
  const F zero(0.0f), one(1.0f);
  F value = p.x;
  switch (kind) {
  case LANCER_GRADIENT_LINEAR:
    break;
  case LANCER_GRADIENT_QUADRATIC:
    value = max(zero, p.x) * max(zero, p.x);
    break;
  case LANCER_GRADIENT_EASING: {
    const F r = min(one, max(zero, p.x)), square = r * r;
    value = F(3.0f) * square - F(2.0f) * square * r;
    break;
  }
  case LANCER_GRADIENT_DIAGONAL:
    value = (p.x + p.y) * F(0.5f);
    break;
  case LANCER_GRADIENT_RADIAL:
    value = narrow(angle(widen(p.y), widen(p.x)) * DoubleOf<F>(0.15915494309189535)) + F(0.5f);
    break;
  default: {
    // Slightly below 1, so that unit vectors give 0 despite rounding.
    const F r = max(zero, F(0.999999f) - sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
    value = kind == LANCER_GRADIENT_QUADRATIC_SPHERE ? r * r : r;
  }
  }
  return min(one, max(zero, value));
}

} // namespace lancer
