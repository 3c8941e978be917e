// Rounding for any width, with the bits of ceil() and trunc(); is_finite(); the nearest finite float.
#pragma once

#include "simd/scalar.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace lancer {

template <class F> LANCER_LANE F ceil(const F &a) { return -floor(-a); }
template <class F> LANCER_LANE F trunc(const F &a) { return copysign(floor(abs(a)), a); }

// Returns false for infinities and NaN.
template <class F> LANCER_LANE MaskOf<F> is_finite(const F &x) { return x - x == F(0.0f); }

// Returns the nearest finite float: values beyond the range of float are clamped to its ends.
inline float nearest_float(double value) {
  constexpr double largest = double(std::numeric_limits<float>::max());
  return float(std::clamp(value, -largest, largest));
}
inline glm::vec2 nearest_float(const glm::dvec2 &v) { return {nearest_float(v.x), nearest_float(v.y)}; }
inline glm::vec3 nearest_float(const glm::dvec3 &v) { return {nearest_float(v.x), nearest_float(v.y), nearest_float(v.z)}; }

} // namespace lancer
