// One number for a colour, where a choice, a weight or a pixel's alpha needs one.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace lancer {

inline float mean(const glm::vec3 &v) { return (v.x + v.y + v.z) / 3.0f; }

// Of linear light with the primaries of ITU-R BT.709.
inline float luminance(const glm::vec3 &v) { return 0.2126f * v.x + 0.7152f * v.y + 0.0722f * v.z; }

inline float largest(const glm::vec3 &v) { return std::max({v.x, v.y, v.z}); }

// Of light: what is negative counts as dark.
inline double brightest(const glm::dvec3 &v) { return std::max({0.0, v.x, v.y, v.z}); }

} // namespace lancer
