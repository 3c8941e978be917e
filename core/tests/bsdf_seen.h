// Surfaces for tests: lobes described briefly, seen from wo in a frame with the world's axes.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "bsdf/build.h"

namespace lancer::testing {

inline glm::vec3 direction(double cosine, double phi = 0.8) {
  const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return glm::vec3(glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), cosine));
}

// roughness is alpha for Beckmann and the socket's value for Blender's lobes.
inline LobeInputs<float> described(LobeKind kind, float roughness = 0.0f, float ior = 1.5f, float shininess = 0.0f,
                                   const glm::vec3 &color = glm::vec3(1.0f)) {
  LobeInputs<float> inputs;
  inputs.kind = kind;
  inputs.roughness = roughness;
  inputs.ior = ior;
  inputs.shininess = shininess;
  inputs.color = color;
  return inputs;
}

// The plane z = 0, with its outward side up.
inline void look(Bsdf<float> &bsdf, const std::vector<LobeInputs<float>> &lobes, const glm::vec3 &wo) {
  const bool inside = wo.z < 0.0f;
  const glm::vec3 n(0.0f, 0.0f, inside ? -1.0f : 1.0f);
  bsdf.begin(wo, n, n, inside, true);
  for (const LobeInputs<float> &lobe : lobes)
    add_lobe(bsdf, lobe);
  bsdf.complete();
}

inline Bsdf<float> seen(const std::vector<LobeInputs<float>> &lobes, const glm::vec3 &wo) {
  Bsdf<float> bsdf;
  look(bsdf, lobes, wo);
  return bsdf;
}

// Applies a half turn to a direction, which swaps the sides of the plane; in the frame of the other side nothing has moved.
inline glm::vec3 turned_over(const glm::vec3 &w) { return {w.x, -w.y, -w.z}; }

} // namespace lancer::testing
