// Places on the axis of a table.
#pragma once

#include "simd/scalar.h"

namespace lancer {

// low ... 1. What is no number is low: it must not become a place beyond a table.
template <class F> LANCER_LANE F on_axis(F x, float low = 0.0f) { return min(max(F(low), x), F(1.0f)); }

} // namespace lancer
