// A material as described: lobes whose parameters are constants or textures.
#pragma once

#include "bsdf/bsdf.h"
#include "scene/surface.h"

#include <string>
#include <vector>

namespace lancer {

// One value of a material. texture < 0: the constant; every other parameter of every lobe takes the same road.
struct Parameter {
  glm::vec3 value{0.0f};
  int32_t texture = -1;
};

struct LobeDescription {
  LobeKind kind = LobeKind::Lambert;
  Parameter color, roughness, ior, shininess;
};

struct Material {
  std::string name;
  std::vector<LobeDescription> lobes;
  Parameter emission, opacity, ambient;
  uint32_t index = 0;

  bool textured = false; // any lobe parameter with a texture
  Bsdf constant;         // the lobes where nothing is textured, made once

  bool emits() const { return emission.texture >= 0 || emission.value != glm::vec3(0.0f); }
};

// The value of a parameter at a surface point.
inline glm::vec3 evaluate(const Parameter &parameter, const Surface &) { return parameter.value; }

inline Lobe evaluate(const LobeDescription &lobe, const Surface &surface) {
  Lobe result;
  result.kind = lobe.kind;
  result.color = evaluate(lobe.color, surface);
  result.alpha = evaluate(lobe.roughness, surface).x;
  result.ior = evaluate(lobe.ior, surface).x;
  result.shininess = evaluate(lobe.shininess, surface).x;
  return result;
}

// The material's BSDF at a surface point; scratch is filled only where a texture makes the lobes differ from place to place.
inline const Bsdf &evaluate(const Material &material, const Surface &surface, Bsdf &scratch) {
  if (!material.textured)
    return material.constant;
  scratch = Bsdf{};
  for (const LobeDescription &lobe : material.lobes)
    scratch.lobes[scratch.count++] = evaluate(lobe, surface);
  return scratch;
}

} // namespace lancer
