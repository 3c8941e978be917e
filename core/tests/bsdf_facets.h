// Rough lobes for tests, and their albedo by exact integrals.
#pragma once

#include "bsdf_domain.h"
#include "bsdf_seen.h"

namespace lancer::testing {

inline constexpr double kUlp = 0x1p-24;

inline LobeInputs<float> rough(LobeKind kind, Facets facets, float roughness, float ior = 1.5f) {
  LobeInputs<float> inputs = described(kind, roughness, ior);
  inputs.distribution = facets;
  return inputs;
}

// Returns wo refracted at the facet h; cos_t: cosine beyond it.
inline glm::vec3 bent_about(const glm::vec3 &wo, const glm::vec3 &h, float eta, float cos_t) {
  return eta == 1.0f ? -wo : glm::normalize((glm::dot(wo, h) / eta - cos_t) * h - wo / eta);
}

// Returns the integral of f cos over the upper side, by half vectors with slopes about alpha.
inline double reflected(const Bsdf<float> &bsdf, double alpha) {
  const Domain domain = half_vector_domain(bsdf.wo, alpha);
  return integrate_square(domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).f().x}; }), 16, 4e-7);
}

// The same for transmitted light.
inline double through(const Bsdf<float> &bsdf, double alpha, double ior) {
  const Domain domain = bent_domain(bsdf.wo, alpha, ior);
  return integrate_square(domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).f().x}; }), 16, 4e-7);
}

} // namespace lancer::testing
