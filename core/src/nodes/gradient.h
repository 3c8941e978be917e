// The Gradient Texture: a ramp from 0 to 1 along, around or away from an axis.
#pragma once

#include "sampling/angle.h"
#include "scene/enums.h"
#include "simd/vectors.h"

namespace lancer {

// kind: GradientKind.
template <class F> LANCER_LANE F gradient_texture(uint32_t kind, const Vector3<F> &p) {
  const F zero(0.0f), one(1.0f);
  F value = p.x;
  switch (kind) {
  case GradientKind::Linear:
    break;
  case GradientKind::Quadratic:
    value = max(zero, p.x) * max(zero, p.x);
    break;
  case GradientKind::Easing: {
    const F r = min(one, max(zero, p.x)), square = r * r;
    value = F(3.0f) * square - F(2.0f) * square * r;
    break;
  }
  case GradientKind::Diagonal:
    value = (p.x + p.y) * F(0.5f);
    break;
  case GradientKind::Radial:
    value = narrow(angle(widen(p.y), widen(p.x)) * DoubleOf<F>(0.15915494309189535)) + F(0.5f);
    break;
  default: {
    // Slightly below 1, so that unit vectors give 0 despite rounding.
    const F r = max(zero, F(0.999999f) - sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
    value = kind == GradientKind::QuadraticSphere ? r * r : r;
  }
  }
  return min(one, max(zero, value));
}

} // namespace lancer
