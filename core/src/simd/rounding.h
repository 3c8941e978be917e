// Whole numbers beside a number of any width, with the bits of ceil() and trunc(); and whether it is one.
#pragma once

#include "simd/scalar.h"

namespace lancer {

template <class F> LANCER_LANE F ceil(const F &a) { return -floor(-a); }
template <class F> LANCER_LANE F trunc(const F &a) { return copysign(floor(abs(a)), a); }

// Neither infinite nor none.
template <class F> LANCER_LANE MaskOf<F> is_finite(const F &x) { return x - x == F(0.0f); }

} // namespace lancer
