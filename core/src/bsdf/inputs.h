// Lobes as a material describes them, with every parameter a value: what the BSDF of one place is built from.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lancer {

// In the order of lancer.h.
enum class LobeKind : uint32_t {
  Lambert = 0,
  Beckmann = 1,
  Mirror = 2,
  Dielectric = 3,
  Phong = 4,
  BlinnPhong = 5,
  Diffuse = 6,
  Glossy = 7,
  Glass = 8,
  Refraction = 9,
  Conductor = 10,
  Sheen = 11,
  Translucent = 12,
  Principled = 13,
  Minnaert = 14
};
inline constexpr uint32_t kLobeKinds = 15;

// How the facets of a rough surface are distributed.
enum class Facets : uint32_t { Ggx = 0, Beckmann = 1, AshikhminShirley = 2, MultiGgx = 3 };
// Whose definitions hold: Blender 3.x, 4.0 ... 4.4, 4.5 and newer.
enum class Rules : uint32_t { Blender3 = 0, Blender4 = 1, Blender45 = 2 };

struct LobeInputs {
  LobeKind kind = LobeKind::Lambert;
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::Ggx;
  uint32_t option = 0;
  glm::vec3 weight{1.0f};
  glm::vec3 color{0.0f};
  float roughness = 0.0f, ior = 1.5f, shininess = 0.0f;
  glm::vec3 edge{1.0f};
  float anisotropy = 0.0f, rotation = 0.0f;
  glm::vec3 normal{0.0f}, tangent{0.0f}; // world; 0 = the shading normal, any tangent
};

// The weight of a lobe that its colour scales.
inline glm::vec3 colored_weight(const LobeInputs &inputs) { return inputs.weight * glm::max(inputs.color, 0.0f); }

// weight, normal and tangent are those of the lobe that carries the record.
struct PrincipledInputs {
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::MultiGgx;
  uint32_t option = 1; // of the diffuse lobe
  glm::vec3 base_color{0.8f};
  float metallic = 0.0f, roughness = 0.5f, ior = 1.5f, diffuse_roughness = 0.0f;
  float specular = 0.5f;
  glm::vec3 specular_tint{1.0f};
  float anisotropic = 0.0f, anisotropic_rotation = 0.0f;
  float transmission = 0.0f, transmission_roughness = 0.0f;
  float coat = 0.0f, coat_roughness = 0.03f, coat_ior = 1.5f;
  glm::vec3 coat_tint{1.0f}, coat_normal{0.0f};
  float sheen = 0.0f, sheen_roughness = 0.5f;
  glm::vec3 sheen_tint{1.0f};
  glm::vec3 emission{0.0f};
};

} // namespace lancer
