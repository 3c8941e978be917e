// A material as described: lobes with parameters that are constants or results of nodes.
#pragma once

#include "scene/lobe_inputs.h"
#include "scene/node.h"
#include "scene/once.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lancer {

// The largest value of a colour, level or length of a material or a light.
inline constexpr float kBrightest = 1e30f;

struct PrincipledDescription {
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::MultiGgx;
  uint32_t option = 1; // of the diffuse lobe
  uint32_t subsurface_option = 0;
#define LANCER_MEMBER(kind, name, spoken, given) Parameter name;
  LANCER_PRINCIPLED_PARAMETERS(LANCER_MEMBER)
#undef LANCER_MEMBER
};

struct LobeDescription {
  LobeKind kind = LobeKind::Lambert;
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::Ggx;
  uint32_t option = 0;
  Parameter weight{glm::vec3(1.0f)}, color, roughness, ior{glm::vec3(1.5f)}, shininess, edge{glm::vec3(1.0f)}, anisotropy,
      rotation, normal, tangent, roughness_across, offset, film_thickness, film_ior{glm::vec3(1.33f)};
  std::optional<PrincipledDescription> principled;
};

// A portal of a lower mean weight is none, as in Cycles.
inline constexpr float kLeastPortal = 1e-5f;

// A part of a surface that light enters to go on elsewhere. weight: a part of the material's transmittance; position: where
// the light goes on if moves is set, in the user's world; direction: 0 = straight on.
struct Portal {
  bool moves = false;
  Parameter weight, position, direction;
};
// Returns the weight of a portal, 0 for one that is none.
inline glm::vec3 counted_portal(const glm::vec3 &weight) {
  return weight.x + weight.y + weight.z >= 3.0f * kLeastPortal ? weight : glm::vec3(0.0f);
}

struct ReadyLobe;     // bsdf/material_lobes.h
struct ReadyMaterial; // compile/scene.h

// The parameters of a material, and facts that follow from its description.
struct MaterialParameters {
  Parameter emission, transmittance, holdout, ambient, displacement, normal;
  uint32_t index = 0;
  uint32_t matte = 0; // id; 0 = none
  uint32_t flags = 0; // MaterialFlag

  bool layered_emission = false; // a Principled lobe emits
  bool has_sheets = false;       // a smooth sheet may let rays pass straight
  bool bends_exits = false;      // light from below leaves about other normals than that of the surface
  bool estimates = false;        // the value of a lobe is an estimate, by random numbers of its own

  bool emits() const { return layered_emission || emission.varies() || emission.value != glm::vec3(0.0f); }
  bool displaces() const { return displacement.varies() || displacement.value != glm::vec3(0.0f); }
  bool is_transparent() const { return has_sheets || transmittance.varies() || transmittance.value != glm::vec3(0.0f); }
};

struct MaterialView : MaterialParameters {
  std::span<const LobeDescription> lobes;
  std::span<const Portal> portals;
  std::span<const Output> outputs;
  ProgramView program;
  const ReadyLobe *ready = nullptr; // by number of lobe

  // The nodes that each query needs.
  ScheduleView surface_nodes;       // lobes, emission, transmittance, holdout, ambient, normal
  ScheduleView transmittance_nodes; // for shadow rays
  ScheduleView emission_nodes;      // for light samples, including layered emission
  ScheduleView displacement_nodes;
  ScheduleView output_nodes;

  bool fixed() const { return program.nodes.empty(); } // no node decides anything
};

// The memory of a material.
struct Material : MaterialParameters {
  std::string name;
  std::vector<LobeDescription> lobes;
  std::vector<Portal> portals;
  std::vector<Output> outputs;
  Program program;
  Schedule surface_nodes, transmittance_nodes, emission_nodes, displacement_nodes, output_nodes;

  Once<ReadyMaterial> ready; // made when a scene first needs it

  bool fixed() const { return program.nodes.empty(); }
  // Valid until the material changes.
  operator MaterialView() const {
    return {*this,          lobes,
            portals,        outputs,
            program,        nullptr,
            surface_nodes,  transmittance_nodes,
            emission_nodes, displacement_nodes,
            output_nodes};
  }
};

// For a scalar parameter.
inline bool may_be_positive(const Parameter &parameter) { return parameter.varies() || parameter.value.x > 0.0f; }

inline bool is_hair(const LobeDescription &lobe) { return lobe.kind == LobeKind::Hair || lobe.kind == LobeKind::HairFibre; }
inline bool is_huang(const LobeDescription &lobe) { return lobe.kind == LobeKind::HairFibre && lobe.option == 1; }
// Whether a lobe beside Principled may have a film.
inline bool has_film(const LobeDescription &lobe) {
  return (lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Conductor) && may_be_positive(lobe.film_thickness);
}

// Whether light may enter the surface by a lobe.
inline bool goes_below(const LobeDescription &lobe) {
  return lobe.kind == LobeKind::Subsurface || (lobe.principled && may_be_positive(lobe.principled->subsurface));
}

// Clamps; NaN becomes low.
template <class F> LANCER_LANE F within(F value, float low, float high) {
  return select(value > low, select(value < high, value, F(high)), F(low));
}

// The results of nodes at one hit.
struct PlaceValues {
  std::span<const glm::vec4> values;
  glm::vec3 operator()(const Parameter &parameter) const { return value_of(parameter, values); }
};

// Reads parameters and clamps them to the range of their model; NaN becomes the lower end of the range, or 0. Values: a
// function that returns a parameter's value in every lane.
template <class F, class Values> struct ParameterReader {
  using V = Vec3<F>;
  Values values;

  LANCER_LANE V color(const Parameter &parameter, float high = kBrightest) const {
    const V c = values(parameter);
    return {within(c.x, 0.0f, high), within(c.y, 0.0f, high), within(c.z, 0.0f, high)};
  }
  // NaN becomes 0.
  LANCER_LANE V vector(const Parameter &parameter) const {
    const V v = values(parameter);
    const auto finite = [](F x) { return select(x == x, within(x, -kBrightest, kBrightest), F(0.0f)); };
    return {finite(v.x), finite(v.y), finite(v.z)};
  }
  LANCER_LANE F scalar(const Parameter &parameter, float low, float high) const {
    return within(values(parameter).x, low, high);
  }
  LANCER_LANE F share(const Parameter &parameter) const { return scalar(parameter, 0.0f, 1.0f); }
  LANCER_LANE F ior(const Parameter &parameter, float low) const { return scalar(parameter, low, __builtin_inff()); }
  LANCER_LANE F turns(const Parameter &parameter) const {
    const F value = values(parameter).x;
    return select(abs(value) < __builtin_inff(), value, F(0.0f));
  }
  // Returns a unit direction, or 0.
  LANCER_LANE V direction(const Parameter &parameter) const {
    const V v = values(parameter);
    const F length = sqrt(dot(v, v));
    return select((length > 0.0f) & (length < __builtin_inff()), v / length, V(F(0.0f)));
  }
  template <ParameterKind kind> LANCER_LANE ValueOf<F, kind> value(const Parameter &parameter) const {
    if constexpr (kind == ParameterKind::Color)
      return color(parameter);
    else if constexpr (kind == ParameterKind::Share)
      return share(parameter);
    else if constexpr (kind == ParameterKind::Amount)
      return scalar(parameter, 0.0f, kBrightest);
    else if constexpr (kind == ParameterKind::Signed)
      return scalar(parameter, -1.0f, 1.0f);
    else if constexpr (kind == ParameterKind::Index)
      return ior(parameter, kSmallestIor);
    else if constexpr (kind == ParameterKind::Denser)
      return ior(parameter, 1.0f);
    else if constexpr (kind == ParameterKind::Turns)
      return turns(parameter);
    else if constexpr (kind == ParameterKind::Vector)
      return vector(parameter);
    else
      return direction(parameter);
  }
};

// Evaluates a described lobe at a hit.
template <class F, class Values>
LANCER_LANE LobeInputs<F> evaluate(const LobeDescription &lobe, const ParameterReader<F, Values> &read) {
  LobeInputs<F> inputs;
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
  if (lobe.kind == LobeKind::Conductor || lobe.kind == LobeKind::HairFibre || lobe.kind == LobeKind::Subsurface)
    inputs.edge = read.color(lobe.edge, f82 ? 1.0f : kBrightest);
  inputs.anisotropy = read.scalar(lobe.anisotropy, -0.99f, 0.99f);
  inputs.rotation = read.turns(lobe.rotation);
  if (is_huang(lobe))
    inputs.roughness_across = read.scalar(lobe.roughness_across, 0.0f, kBrightest);
  else if (lobe.kind == LobeKind::Toon || is_hair(lobe))
    inputs.roughness_across = read.share(lobe.roughness_across);
  if (is_hair(lobe))
    inputs.offset = read.turns(lobe.offset);
  if (has_film(lobe)) {
    inputs.film_thickness = read.scalar(lobe.film_thickness, 0.0f, kBrightest);
    inputs.film_ior = read.ior(lobe.film_ior, kSmallestIor);
  }
  return inputs;
}
template <class F, class Values>
LANCER_LANE PrincipledInputs<F> evaluate(const PrincipledDescription &principled, const ParameterReader<F, Values> &read) {
  PrincipledInputs<F> inputs;
  inputs.rules = principled.rules;
  inputs.distribution = principled.distribution;
  inputs.option = principled.option;
  inputs.subsurface_option = principled.subsurface_option;
#define LANCER_READ(kind, name, spoken, given) inputs.name = read.template value<ParameterKind::kind>(principled.name);
  LANCER_PRINCIPLED_PARAMETERS(LANCER_READ)
#undef LANCER_READ
  return inputs;
}
inline LobeInputs<float> evaluate(const LobeDescription &lobe, std::span<const glm::vec4> values) {
  return evaluate(lobe, ParameterReader<float, PlaceValues>{{values}});
}
inline PrincipledInputs<float> evaluate(const PrincipledDescription &principled, std::span<const glm::vec4> values) {
  return evaluate(principled, ParameterReader<float, PlaceValues>{{values}});
}
// Evaluates a weight or an emission.
inline glm::vec3 evaluate(const Parameter &color, std::span<const glm::vec4> values) {
  return ParameterReader<float, PlaceValues>{{values}}.color(color);
}

} // namespace lancer
