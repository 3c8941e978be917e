// Lobes as a material describes them, with every parameter a value: what the BSDF of one place is built from.
#pragma once

#include "scene/principled_table.h"
#include "simd/vectors.h"

#include <cstdint>
#include <type_traits>

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
// Of one material, and of one place once Principled has become its lobes.
inline constexpr int kMaxLobes = 64;

// How the facets of a rough surface are distributed.
enum class Facets : uint32_t { Ggx = 0, Beckmann = 1, AshikhminShirley = 2, MultiGgx = 3 };
// Whose definitions hold: Blender 3.x, 4.0 ... 4.4, 4.5 and newer.
enum class Rules : uint32_t { Blender3 = 0, Blender4 = 1, Blender45 = 2 };

// What a parameter is: as lancer_parameter says.
enum class ParameterKind { Color, Share, Amount, Index, Denser, Turns, Direction };
template <class F, ParameterKind kind>
using ValueOf = std::conditional_t<kind == ParameterKind::Color || kind == ParameterKind::Direction, Vec3<F>, F>;

// Their numbers are those of every lane; what they are is the same in all lanes.
template <class F> struct LobeInputs {
  using V = Vec3<F>;
  LobeKind kind = LobeKind::Lambert;
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::Ggx;
  uint32_t option = 0;
  V weight{F(1.0f)};
  V color{F(0.0f)};
  F roughness{0.0f}, ior{1.5f}, shininess{0.0f};
  V edge{F(1.0f)};
  F anisotropy{0.0f}, rotation{0.0f};
  V normal{F(0.0f)}, tangent{F(0.0f)}; // world; 0 = the shading normal, any tangent
};

// The weight of a lobe that its colour scales.
template <class F> LANCER_LANE Vec3<F> colored_weight(const LobeInputs<F> &inputs) {
  return inputs.weight * max(inputs.color, Vec3<F>(F(0.0f)));
}

// weight, normal and tangent are those of the lobe that carries the record.
template <class F> struct PrincipledInputs {
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::MultiGgx;
  uint32_t option = 1; // of the diffuse lobe
#define LANCER_MEMBER(kind, name, spoken, given) ValueOf<F, ParameterKind::kind> name{F(given)};
  LANCER_PRINCIPLED_PARAMETERS(LANCER_MEMBER)
#undef LANCER_MEMBER
};

} // namespace lancer
