// Every lobe with more than single directions, at a given roughness.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string>

#include "bsdf/microfacet.h"
#include "bsdf_domain.h"
#include "principled_lab.h"

namespace lancer::testing {

// The long grids of `make test-slow`.
inline bool slow() { return std::getenv("LANCER_SLOW_TESTS") != nullptr; }

inline std::vector<double> roughnesses() {
  return slow() ? std::vector<double>{2e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.5, 0.7, 1.0} : std::vector<double>{2e-5, 1e-3, 0.3};
}
inline std::vector<double> heights() {
  return slow() ? std::vector<double>{1.0, 0.9, 0.5, 0.1, 1e-2, 1e-3} : std::vector<double>{0.9, 0.1, 1e-3};
}

struct Known {
  std::string name;
  std::function<void(Bsdf<float> &, const glm::vec3 &)> look; // for wo
  double width = 0.0;                                         // width of its narrowest lobe, in slopes of the half vector; 0:
                                                              // wide
  float ior = 1.0f;                                           // index of refraction from outside; 1: does not bend light
  // f(a, b) equals f(b, a), times ior^2 through the surface.
  bool reciprocal = true;

  Bsdf<float> from(const glm::vec3 &wo) const {
    Bsdf<float> bsdf;
    look(bsdf, wo);
    return bsdf;
  }
};

inline Known known(const std::string &name, std::vector<LobeInputs<float>> lobes, double width = 0.0, float ior = 1.0f,
                   bool reciprocal = true) {
  return {name, [lobes](Bsdf<float> &bsdf, const glm::vec3 &wo) { look(bsdf, lobes, wo); }, width, ior, reciprocal};
}

inline LobeInputs<float> at_alpha(LobeKind kind, Facets facets, double alpha, float ior = 1.5f) {
  const bool alpha_itself = kind == LobeKind::Beckmann;
  LobeInputs<float> inputs = described(kind, static_cast<float>(alpha_itself ? alpha : std::sqrt(alpha)), ior);
  inputs.distribution = facets;
  inputs.tangent = {1.0f, 0.0f, 0.0f};
  return inputs;
}

// Returns the shininess whose peak has the curvature of facets with this alpha.
inline float shininess_of(double alpha) { return static_cast<float>(std::max(0.0, 2.0 / (alpha * alpha) - 2.0)); }

// Single microfacet lobes.
inline std::vector<Known> facet_lobes(double alpha) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float below = 0.6f, above = 1.5f;
  std::vector<Known> all;
  const auto add = [&](const std::string &name, const LobeInputs<float> &inputs, float ior = 1.0f, double width = 0.0,
                       bool reciprocal = true) {
    all.push_back(known(name + ", alpha " + std::to_string(alpha), {inputs}, width > 0.0 ? width : alpha, ior, reciprocal));
  };
  for (const float ior : {above, infinity})
    add("coating of " + std::to_string(ior), at_alpha(LobeKind::Beckmann, Facets::Beckmann, alpha, ior));
  add("GGX", at_alpha(LobeKind::Glossy, Facets::Ggx, alpha));
  add("Beckmann", at_alpha(LobeKind::Glossy, Facets::Beckmann, alpha));
  // The returned energy depends on the side of wo.
  add("GGX of several bounces", at_alpha(LobeKind::Glossy, Facets::MultiGgx, alpha), 1.0f, alpha, false);
  for (const Facets facets : {Facets::Ggx, Facets::Beckmann}) {
    LobeInputs<float> stretched = at_alpha(LobeKind::Glossy, facets, 0.5 * alpha);
    stretched.anisotropy = 0.5f;
    add(facets == Facets::Ggx ? "stretched GGX" : "stretched Beckmann", stretched, 1.0f, 0.25 * alpha);
  }
  LobeInputs<float> metal = at_alpha(LobeKind::Conductor, Facets::Ggx, alpha);
  metal.color = {0.9f, 0.6f, 0.2f};
  metal.edge = {0.9f, 0.8f, 0.4f};
  add("metal by F82", metal);
  metal.option = 1;
  metal.color = {0.2f, 0.9f, 1.4f};
  metal.edge = {3.9f, 2.4f, 2.1f};
  add("metal by its index", metal);
  const auto covered = [](LobeInputs<float> inputs, Rules rules) {
    inputs.rules = rules;
    inputs.film_thickness = 400.0f;
    inputs.film_ior = 1.33f;
    return inputs;
  };
  add("metal by its index with a film", covered(metal, Rules::Blender50));
  metal.option = 0;
  metal.color = {0.9f, 0.6f, 0.2f};
  metal.edge = {0.9f, 0.8f, 0.4f};
  add("metal by F82 with a film", covered(metal, Rules::Blender50));
  for (const Rules rules : {Rules::Blender45, Rules::Blender50})
    // From inside, Cycles takes the film as if light had the wavelengths of air.
    add("glass with a film, " + std::to_string(int(rules)),
        covered(at_alpha(LobeKind::Glass, Facets::Ggx, alpha, above), rules), above, alpha, false);
  for (const float ior : {above, below}) {
    const std::string which = " of " + std::to_string(ior);
    add("glass" + which, at_alpha(LobeKind::Glass, Facets::Ggx, alpha, ior), ior);
    add("Beckmann glass" + which, at_alpha(LobeKind::Glass, Facets::Beckmann, alpha, ior), ior);
    add("refraction" + which, at_alpha(LobeKind::Refraction, Facets::Ggx, alpha, ior), ior);
  }
  add("glass of several bounces", at_alpha(LobeKind::Glass, Facets::MultiGgx, alpha, above), above, alpha, false);
  LobeInputs<float> old = at_alpha(LobeKind::Glossy, Facets::Ggx, alpha);
  old.rules = Rules::Blender3;
  add("GGX of Blender 3", old);
  return all;
}

// All other lobes, and mixtures.
inline std::vector<Known> other_lobes(double alpha) {
  const std::string rough = ", alpha " + std::to_string(alpha);
  const float shininess = shininess_of(alpha), infinity = std::numeric_limits<float>::infinity();
  const LobeInputs<float> diffuse = described(LobeKind::Lambert, 0.0f, 1.5f, 0.0f, {0.6f, 0.3f, 0.1f});
  const LobeInputs<float> coat = at_alpha(LobeKind::Beckmann, Facets::Beckmann, alpha);
  std::vector<Known> all;
  all.push_back(known("Lambert", {diffuse}));
  all.push_back(known("Phong" + rough, {described(LobeKind::Phong, 0.0f, 1.5f, shininess)}, alpha));
  all.push_back(known("Blinn-Phong" + rough, {described(LobeKind::BlinnPhong, 0.0f, 1.5f, shininess)}, alpha));
  all.push_back(known("Ashikhmin-Shirley" + rough, {at_alpha(LobeKind::Glossy, Facets::AshikhminShirley, alpha)}, alpha));
  LobeInputs<float> cloth = at_alpha(LobeKind::Sheen, Facets::Ggx, alpha), velvet = cloth;
  velvet.distribution = Facets::Beckmann;
  all.push_back(known("sheen" + rough, {cloth}, 0.0, 1.0f, false));
  all.push_back(known("velvet" + rough, {velvet}));
  LobeInputs<float> clay = at_alpha(LobeKind::Diffuse, Facets::Ggx, alpha * alpha);
  clay.color = {0.8f, 0.4f, 0.1f};
  all.push_back(known("Oren-Nayar" + rough, {clay}));
  clay.option = 1;
  all.push_back(known("preserving Oren-Nayar" + rough, {clay}));
  const LobeInputs<float> leaf = described(LobeKind::Translucent, 0.0f, 1.5f, 0.0f, {0.2f, 0.6f, 0.1f});
  all.push_back(known("translucent", {leaf}));
  for (const uint32_t option : {0u, 1u}) {
    LobeInputs<float> toon = described(LobeKind::Toon, 0.3f, 1.5f, 0.0f, {0.8f, 0.4f, 0.1f});
    toon.roughness_across = 0.4f;
    toon.option = option;
    all.push_back(known(option == 0 ? "toon" : "glossy toon", {toon}, 0.0, 1.0f, false));
  }
  all.push_back(known("coated" + rough, {diffuse, coat}, alpha));
  all.push_back(known("mirror of half" + rough,
                      {diffuse, described(LobeKind::Mirror, 0.0f, 1.5f, 0.0f, glm::vec3(0.5f)),
                       at_alpha(LobeKind::Beckmann, Facets::Beckmann, alpha, infinity)},
                      alpha));
  all.push_back(known("glossy leaf" + rough, {leaf, clay, at_alpha(LobeKind::Glossy, Facets::Ggx, alpha)}, alpha));
  for (const Rules rules : kAllRules) {
    PrincipledInputs<float> in = plain(rules);
    in.roughness = static_cast<float>(std::sqrt(alpha));
    in.coat_roughness = std::min(1.0f, 1.5f * in.roughness);
    in.metallic = 0.3f;
    in.coat = 0.4f;
    in.sheen = 0.3f;
    in.transmission = 0.2f;
    in.transmission_roughness = 0.3f * in.roughness;
    const auto look_at = [in](Bsdf<float> &bsdf, const glm::vec3 &wo) { look(bsdf, in, wo); };
    all.push_back({"Principled " + std::to_string(int(rules)) + rough, look_at, alpha, 1.5f, false});
  }
  // Light through a narrow sheet is about as narrow as the highlight, where no square of this catalogue is fine.
  if (alpha >= 0.3) {
    PrincipledInputs<float> in = plain(Rules::Blender52);
    in.roughness = static_cast<float>(std::sqrt(alpha));
    in.transmission = 0.5f;
    in.thin_wall = 1.0f;
    in.wall_scattering = 0.6f;
    in.wall_forward = 0.7f;
    in.diffuse_roughness = 0.5f;
    in.film_thickness = 400.0f;
    const auto look_at = [in](Bsdf<float> &bsdf, const glm::vec3 &wo) { look(bsdf, in, wo); };
    all.push_back({"sheet" + rough, look_at, alpha, 1.0f, false});
  }
  return all;
}

inline std::vector<Known> all_lobes(double alpha) {
  std::vector<Known> all = facet_lobes(alpha);
  const std::vector<Known> others = other_lobes(alpha);
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

} // namespace lancer::testing
