// The picture of shadow catchers from its parts (Cycles' formulas, film_calculate_shadow_catcher).
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace lancer {

// Returns the light that all other objects leave to the shadow catchers of a pixel, as a factor. seen: the picture; matte: its
// part without catchers; alone: the light of the catchers without all other objects.
inline glm::dvec3 catcher_factor(const glm::dvec4 &seen, const glm::dvec3 &matte, const glm::dvec3 &alone) {
  const double alpha = std::clamp(seen.w, 0.0, 1.0);
  glm::dvec3 factor(1.0);
  for (int i = 0; i < 3; ++i)
    if (alone[i] != 0.0)
      factor[i] = (1.0 - alpha) + alpha * ((seen[i] - matte[i]) / alone[i]);
  return factor;
}

// Returns a matte over the shadow that a factor stands for.
inline glm::dvec4 over_shadow(const glm::dvec4 &matte, const glm::dvec3 &factor) {
  const double shadow = 1.0 - std::clamp((factor.x + factor.y + factor.z) / 3.0, 0.0, 1.0);
  const double alpha = std::clamp(matte.w, 0.0, 1.0);
  return glm::dvec4(glm::dvec3(matte), alpha + (1.0 - alpha) * shadow);
}

// Returns a matte with its shadow over the environment.
inline glm::dvec4 over_environment(const glm::dvec4 &matte, const glm::dvec3 &factor, const glm::dvec3 &environment) {
  const glm::dvec4 shadowed = over_shadow(matte, factor);
  return glm::dvec4(glm::dvec3(shadowed) + environment * (1.0 - shadowed.w), 1.0);
}

} // namespace lancer
