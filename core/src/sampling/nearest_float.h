// Rounding of doubles to finite floats.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace lancer {

// The nearest float that is finite: what a scene tells of places beyond float's range is at its edge.
inline float nearest_float(double value) {
  constexpr double largest = double(std::numeric_limits<float>::max());
  return float(std::clamp(value, -largest, largest));
}
inline glm::vec2 nearest_float(const glm::dvec2 &v) { return {nearest_float(v.x), nearest_float(v.y)}; }
inline glm::vec3 nearest_float(const glm::dvec3 &v) { return {nearest_float(v.x), nearest_float(v.y), nearest_float(v.z)}; }

} // namespace lancer
