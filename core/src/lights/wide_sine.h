// sine_of() for many lanes at once, with the bits of light_importance.h. For kernels only, like simd/lanes.h.
#pragma once

#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE F sine_of(F cosine) { return sqrt(max(F(0.0f), (F(1.0f) - cosine) * (F(1.0f) + cosine))); }

} // namespace
} // namespace lancer
