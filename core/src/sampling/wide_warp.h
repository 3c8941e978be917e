// warp_disk() for many lanes at once. For kernels only, like simd/lanes.h.
#pragma once

#include "sampling/octant.h"
#include "sampling/warp.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE void warp_disk(F u, F v, F &x, F &y) {
  const F a = F(2.0f) * u - F(1.0f), b = F(2.0f) * v - F(1.0f);
  const M wide = abs(a) > abs(b), middle = (a == F(0.0f)) & (b == F(0.0f));
  const F phi = F(0.25f * kPi) * select(wide, b / a, a / b);
  const F s = sin_octant(phi), c = cos_octant(phi);
  x = select(middle, F(0.0f), select(wide, a * c, b * s));
  y = select(middle, F(0.0f), select(wide, a * s, b * c));
}

} // namespace
} // namespace lancer
