// Lobes and Principled layers of random inputs, the ends of their ranges among them.
#pragma once

#include "principled_lab.h"
#include "scene/lobe_inputs.h"
#include "statistics.h"
#include "widths/bsdf_kernel.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace lancer::testing {

inline float one_of(Random &random, std::initializer_list<float> numbers) {
  return numbers.begin()[random.next() % numbers.size()];
}
inline glm::vec3 unit(Random &random) {
  const float z = 2.0f * random.uniform() - 1.0f, phi = 6.28f * random.uniform(), s = std::sqrt(1.0f - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}
inline glm::vec3 near(Random &random, const glm::vec3 &n, float apart) { return glm::normalize(n + apart * unit(random)); }
// Black in one of three.
inline glm::vec3 color(Random &random) {
  const uint64_t kind = random.next() % 6;
  const glm::vec3 any(random.uniform(), random.uniform(), 1.2f * random.uniform());
  return kind < 2 ? glm::vec3(0.0f) : kind < 3 ? glm::vec3(1.0f) : any;
}
inline float share(Random &random) { return random.next() % 3 ? random.uniform() : one_of(random, {0.0f, 1.0f, 0.5f}); }
inline float roughness(Random &random) {
  return random.next() % 2 ? random.uniform() : one_of(random, {0.0f, 1e-5f, 3e-3f, 0.06f, 0.3f, 1.0f});
}
inline float index(Random &random) {
  return random.next() % 2 ? 0.5f + 1.5f * random.uniform()
                           : one_of(random, {1.0f, 1.5f, 1.00001f, 0.7f, std::numeric_limits<float>::infinity()});
}

// The thickness of a film, in nanometres.
inline float thickness(Random &random) {
  return random.next() % 2 ? one_of(random, {0.0f, 0.05f, 0.5f, 20.0f, 1e9f}) : 2000.0f * random.uniform();
}

// The members that are equal in all lanes.
struct Code {
  LobeKind kind;
  Rules rules;
  Facets distribution;
  uint32_t option;

  std::string name() const {
    return "kind " + std::to_string(int(kind)) + ", rules " + std::to_string(int(rules)) + ", facets " +
           std::to_string(int(distribution)) + ", option " + std::to_string(option);
  }
};

inline std::vector<Code> all_codes() {
  std::vector<Code> all;
  for (uint32_t number = 0; number < kLobeKinds; ++number)
    for (const Rules rules : kAllRules)
      for (const Facets facets : {Facets::Ggx, Facets::Beckmann, Facets::AshikhminShirley, Facets::MultiGgx})
        for (const uint32_t option : {0u, 1u, 2u, 3u, 6u}) {
          const LobeKind kind = static_cast<LobeKind>(number);
          const bool of_facets = kind == LobeKind::Glossy || kind == LobeKind::Glass || kind == LobeKind::Refraction ||
                                 kind == LobeKind::Conductor;
          const bool layered = kind == LobeKind::Principled, cloth = kind == LobeKind::Sheen;
          const bool there = facets == Facets::Ggx || (facets == Facets::Beckmann && (of_facets || cloth)) ||
                             (facets == Facets::AshikhminShirley && kind == LobeKind::Glossy) ||
                             (facets == Facets::MultiGgx && (of_facets || layered));
          const bool optional = layered || kind == LobeKind::Diffuse || kind == LobeKind::Conductor || kind == LobeKind::Toon ||
                                kind == LobeKind::Hair || kind == LobeKind::HairFibre;
          const bool below = kind == LobeKind::Subsurface;
          if (there && (below || option == 0 || (optional && option == 1)))
            all.push_back({kind, rules, facets, option});
        }
  return all;
}

inline Described described(Random &random, const Code &code, const glm::vec3 &ns) {
  Described d;
  LobeInputs<float> &lobe = d.lobe;
  lobe.kind = code.kind;
  lobe.rules = code.rules;
  lobe.distribution = code.distribution;
  lobe.option = code.option;
  lobe.weight = random.next() % 8 ? glm::max(color(random), random.uniform()) : glm::vec3(0.0f);
  lobe.color = color(random);
  lobe.roughness = roughness(random);
  // The value of Huang's fibre has some 5 / alpha nodes.
  if (code.kind == LobeKind::HairFibre && code.option == 1)
    lobe.roughness = 0.05f + 0.95f * lobe.roughness;
  lobe.ior = index(random);
  lobe.shininess = random.uniform() * one_of(random, {0.0f, 1.0f, 4.0f, 200.0f, 1e5f});
  lobe.edge = color(random);
  lobe.anisotropy = one_of(random, {0.0f, 1.0f}) * (1.8f * random.uniform() - 0.9f);
  lobe.rotation = one_of(random, {0.0f, 1.0f}) * random.uniform();
  lobe.roughness_across = share(random);
  lobe.offset = one_of(random, {0.0f, 1.0f}) * (random.uniform() - 0.5f);
  lobe.film_thickness = thickness(random);
  lobe.film_ior = 0.8f + random.uniform();
  if (random.next() % 2)
    lobe.normal = near(random, ns, 0.8f);
  if (random.next() % 2)
    lobe.tangent = unit(random);
  PrincipledInputs<float> &in = d.layers;
  in.rules = code.rules;
  in.distribution = code.distribution;
  in.option = code.option;
  in.base_color = color(random);
  in.metallic = share(random);
  in.roughness = roughness(random);
  in.ior = 0.6f + random.uniform();
  in.diffuse_roughness = roughness(random);
  in.specular = random.next() % 2 ? 0.5f : random.uniform();
  in.specular_tint = random.next() % 2 ? glm::vec3(1.0f) : color(random);
  in.anisotropic = one_of(random, {0.0f, 1.0f}) * random.uniform();
  in.anisotropic_rotation = one_of(random, {0.0f, 1.0f}) * random.uniform();
  in.transmission = share(random);
  in.transmission_roughness = roughness(random);
  in.coat = share(random);
  in.coat_roughness = roughness(random);
  in.coat_ior = 1.0f + random.uniform();
  in.coat_tint = random.next() % 2 ? glm::vec3(1.0f) : color(random);
  if (random.next() % 2)
    in.coat_normal = near(random, ns, 0.8f);
  in.sheen = share(random);
  in.sheen_roughness = roughness(random);
  in.sheen_tint = color(random);
  in.emission = color(random);
  in.film_thickness = thickness(random);
  in.film_ior = 0.8f + random.uniform();
  if (in.rules == Rules::Blender52) {
    in.thin_wall = one_of(random, {0.0f, 0.0f, 1.0f});
    in.wall_scattering = share(random);
    in.wall_forward = share(random);
  }
  in.subsurface_option = (static_cast<uint32_t>(code.rules) + 2 * code.option) % 4;
  in.subsurface = one_of(random, {0.0f, 1.0f}) * share(random);
  in.subsurface_radius = color(random);
  in.subsurface_color = color(random);
  in.subsurface_ior = index(random);
  in.subsurface_anisotropy = 2.0f * random.uniform() - 1.0f;
  return d;
}

} // namespace lancer::testing
