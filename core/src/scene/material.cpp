#include "scene/material.h"

#include <cmath>

namespace lancer {

namespace {

// Comparisons are turned so that NaN gives low.
float within(float value, float low, float high) { return value > low ? (value < high ? value : high) : low; }

glm::vec3 within(const glm::vec3 &c, float high) {
  return {within(c.x, 0.0f, high), within(c.y, 0.0f, high), within(c.z, 0.0f, high)};
}

// Reads the parameters of one lobe at one place.
class Reader {
public:
  explicit Reader(std::span<const glm::vec4> values) : values_(values) {}

  glm::vec3 color(const Parameter &parameter, float high = kBrightest) const {
    return within(value_of(parameter, values_), high);
  }
  float scalar(const Parameter &parameter, float low, float high) const {
    return within(value_of(parameter, values_).x, low, high);
  }
  float share(const Parameter &parameter) const { return scalar(parameter, 0.0f, 1.0f); }
  float ior(const Parameter &parameter, float low) const { return scalar(parameter, low, INFINITY); }
  float turns(const Parameter &parameter) const {
    const float value = value_of(parameter, values_).x;
    return std::isfinite(value) ? value : 0.0f;
  }
  // Unit, or 0.
  glm::vec3 direction(const Parameter &parameter) const {
    const glm::vec3 v = value_of(parameter, values_);
    const float length = glm::length(v);
    return length > 0.0f && std::isfinite(length) ? v / length : glm::vec3(0.0f);
  }

private:
  std::span<const glm::vec4> values_;
};

// Blender's smallest index; the course's lobes take what they are given.
constexpr float kSmallestIor = 1e-5f;

} // namespace

glm::vec3 evaluate(const Parameter &color, std::span<const glm::vec4> values) { return Reader(values).color(color); }

glm::vec3 in_range(const glm::vec3 &color) { return within(color, kBrightest); }

LobeInputs evaluate(const LobeDescription &lobe, std::span<const glm::vec4> values) {
  const Reader read(values);
  LobeInputs inputs;
  inputs.kind = lobe.kind;
  inputs.rules = lobe.rules;
  inputs.distribution = lobe.distribution;
  inputs.option = lobe.option;
  inputs.weight = read.color(lobe.weight);
  inputs.normal = read.direction(lobe.normal);
  inputs.tangent = read.direction(lobe.tangent);
  if (lobe.principled)
    return inputs;
  const bool f82 = lobe.kind == LobeKind::Conductor && lobe.option == 0;
  inputs.color = read.color(lobe.color, f82 ? 1.0f : kBrightest);
  inputs.roughness = read.share(lobe.roughness);
  inputs.ior = read.ior(lobe.ior, lobe.kind < LobeKind::Diffuse ? 0.0f : kSmallestIor);
  inputs.shininess = read.scalar(lobe.shininess, 0.0f, 1e8f);
  if (lobe.kind == LobeKind::Conductor)
    inputs.edge = read.color(lobe.edge, f82 ? 1.0f : kBrightest);
  inputs.anisotropy = read.scalar(lobe.anisotropy, -0.99f, 0.99f);
  inputs.rotation = read.turns(lobe.rotation);
  return inputs;
}

PrincipledInputs evaluate(const PrincipledDescription &principled, std::span<const glm::vec4> values) {
  const Reader read(values);
  PrincipledInputs inputs = principled.constants;
  inputs.base_color = read.color(principled.base_color);
  inputs.metallic = read.share(principled.metallic);
  inputs.roughness = read.share(principled.roughness);
  inputs.ior = read.ior(principled.ior, kSmallestIor);
  inputs.diffuse_roughness = read.share(principled.diffuse_roughness);
  inputs.specular = read.scalar(principled.specular, 0.0f, kBrightest);
  inputs.specular_tint = read.color(principled.specular_tint);
  inputs.anisotropic = read.share(principled.anisotropic);
  inputs.anisotropic_rotation = read.turns(principled.anisotropic_rotation);
  inputs.transmission = read.share(principled.transmission);
  inputs.transmission_roughness = read.share(principled.transmission_roughness);
  inputs.coat = read.scalar(principled.coat, 0.0f, kBrightest);
  inputs.coat_roughness = read.share(principled.coat_roughness);
  inputs.coat_ior = read.ior(principled.coat_ior, 1.0f);
  inputs.coat_tint = read.color(principled.coat_tint);
  inputs.coat_normal = read.direction(principled.coat_normal);
  inputs.sheen = read.scalar(principled.sheen, 0.0f, kBrightest);
  inputs.sheen_roughness = read.share(principled.sheen_roughness);
  inputs.sheen_tint = read.color(principled.sheen_tint);
  inputs.emission = read.color(principled.emission);
  return inputs;
}

} // namespace lancer
