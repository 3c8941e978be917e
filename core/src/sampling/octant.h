// Sine and cosine of numbers of a sample, in float: the same bits from every library, compiler and number of lanes.
#pragma once

#include "simd/scalar.h"

namespace lancer {

// |x| <= pi/4. Fitted to a relative error of 4e-9: what is left is rounding, about one unit in the last place.
template <class F> LANCER_LANE F sin_octant(F x) {
  const F z = x * x;
  return x + x * z * (F(-0.16666655f) + z * (F(0.00833218f) + z * F(-0.00019517f)));
}
template <class F> LANCER_LANE F cos_octant(F x) {
  const F z = x * x;
  return F(1.0f) - F(0.5f) * z + z * z * (F(0.0416666456f) + z * (F(-0.00138873675f) + z * F(2.44384509e-5f)));
}

template <class T> struct SinCos { T sin, cos; };

// Of u turns, u in [0, 1].
template <FloatLanes F> LANCER_LANE SinCos<F> sin_cos_turn(F u) {
  using U = WordOf<F>;
  // Subtract the nearest quarter, which is exact, and turn back by it: swap the two in odd quarters, then set the signs.
  const U quarter = truncate(F(4.0f) * u + F(0.5f));
  const F x = F(6.28318531f) * (u - F(0.25f) * to_float(quarter));
  const F s = sin_octant(x), c = cos_octant(x);
  const MaskOf<F> odd = equal(quarter & U(1u), U(1u));
  return {as_float(as_word(select(odd, c, s)) ^ (quarter & U(2u)) << 30),
          as_float(as_word(select(odd, s, c)) ^ ((quarter + U(1u)) & U(2u)) << 30)};
}

} // namespace lancer
