// One number for a colour, where a choice, a weight or a pixel's alpha needs one.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace lancer {

inline float mean(const glm::vec3 &v) { return (v.x + v.y + v.z) / 3.0f; }

inline float largest(const glm::vec3 &v) { return std::max({v.x, v.y, v.z}); }

// Of light: what is negative counts as dark.
inline double brightest(const glm::dvec3 &v) { return std::max({0.0, v.x, v.y, v.z}); }

} // namespace lancer
