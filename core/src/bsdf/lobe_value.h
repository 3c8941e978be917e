// What every smooth lobe answers. Directions are in the local frame, turned so that wo.z > 0 and wi.z > 0.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace lancer {

struct LobeValue {
  float f = 0.0f;   // without the lobe's colour and without the cosine, 1/sr
  float pdf = 0.0f; // per solid angle of wi
};

struct LobeDirection {
  glm::vec3 wi{0.0f}; // wi.z <= 0: below the horizon, no sample
  glm::vec3 h{0.0f};  // the half vector; from the sampler where that has it with more digits than wo + wi
};

// The zero vector where both directions are so close to the horizon that nothing is left of their sum.
inline glm::vec3 half_vector(const glm::vec3 &wo, const glm::vec3 &wi) {
  const glm::vec3 sum = wo + wi;
  const float length2 = glm::dot(sum, sum);
  return length2 > 0.0f ? sum / std::sqrt(length2) : glm::vec3(0.0f);
}

inline glm::vec3 reflect_about(const glm::vec3 &wo, const glm::vec3 &h) { return 2.0f * glm::dot(wo, h) * h - wo; }

} // namespace lancer
