// A material as described: lobes whose parameters are constants or the results of nodes.
#pragma once

#include "bsdf/inputs.h"
#include "scene/node.h"
#include "scene/ready_lobes.h"

#include <memory>
#include <string>
#include <vector>

namespace lancer {

// No colour, level or length of a material or a light is taken as larger.
inline constexpr float kBrightest = 1e30f;

struct PrincipledDescription {
  PrincipledInputs constants; // rules, distribution, option, and what is not in parameters
  Parameter base_color, metallic, roughness, ior, diffuse_roughness, specular, specular_tint, anisotropic, anisotropic_rotation,
      transmission, transmission_roughness, coat, coat_roughness, coat_ior, coat_tint, coat_normal, sheen, sheen_roughness,
      sheen_tint, emission;
};

struct LobeDescription {
  LobeKind kind = LobeKind::Lambert;
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::Ggx;
  uint32_t option = 0;
  Parameter weight{glm::vec3(1.0f)}, color, roughness, ior{glm::vec3(1.5f)}, shininess, edge{glm::vec3(1.0f)}, anisotropy,
      rotation, normal, tangent;
  std::shared_ptr<const PrincipledDescription> principled;
};

struct Material {
  std::string name;
  std::vector<LobeDescription> lobes;
  Program program;
  Parameter emission, transmittance, holdout, ambient, displacement, normal;
  uint32_t index = 0;
  uint32_t flags = 0; // LANCER_MATERIAL_*

  std::vector<ReadyLobe> ready; // by number of lobe

  // Which nodes each question needs.
  Schedule surface_nodes;       // lobes, emission, transmittance, holdout, ambient, normal
  Schedule transmittance_nodes; // for shadow rays
  Schedule emission_nodes;      // for light samples, with those of layered emission
  Schedule displacement_nodes;

  bool layered_emission = false;                       // some Principled lobe emits
  bool fixed() const { return program.nodes.empty(); } // no node has a say
  bool emits() const { return layered_emission || emission.varies() || emission.value != glm::vec3(0.0f); }
  bool displaces() const { return displacement.varies() || displacement.value != glm::vec3(0.0f); }
  bool transmits() const { return transmittance.varies() || transmittance.value != glm::vec3(0.0f); }
};

// Of a scalar.
inline bool may_be_positive(const Parameter &parameter) { return parameter.varies() || parameter.value.x > 0.0f; }

// A described lobe with its values of one place, brought into the ranges that the models know; what is no number becomes 0.
glm::vec3 evaluate(const Parameter &color, std::span<const glm::vec4> values);
glm::vec3 in_range(const glm::vec3 &color);
LobeInputs evaluate(const LobeDescription &lobe, std::span<const glm::vec4> values);
PrincipledInputs evaluate(const PrincipledDescription &principled, std::span<const glm::vec4> values);

} // namespace lancer
