// Where a table is read.
#pragma once

#include <algorithm>

namespace lancer {

// low ... 1. What is no number is low: it must not become a place beyond a table.
inline float on_axis(float x, float low = 0.0f) { return std::min(std::max(low, x), 1.0f); }

} // namespace lancer
