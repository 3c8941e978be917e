// Lobes of a material with every parameter evaluated: the input from which a BSDF is built at a hit.
#pragma once

#include "scene/enums.h"
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
  Minnaert = 14,
  Toon = 15,
  Hair = 16,
  HairFibre = 17,
  Subsurface = 18
};
inline constexpr uint32_t kLobeKinds = 19;
// Maximum number of lobes of a material, and of a hit after Principled has become its lobes.
inline constexpr int kMaxLobes = 64;

// How light goes below a surface: by a profile, or by a random walk with the radii of Blender before 5.2, with radii that keep
// the visible blur, or with the mean free paths themselves.
enum class SubsurfaceMethod : uint32_t { Burley = 0, RandomWalkLegacy = 1, Skin = 2, RandomWalk = 3 };

// Microfacet distribution of a rough surface.
enum class Facets : uint32_t { Ggx = 0, Beckmann = 1, AshikhminShirley = 2, MultiGgx = 3 };
// The Blender versions whose definitions hold: 3.x, 4.0 to 4.4, 4.5, 5.0 and 5.1, 5.2 and newer.
enum class Rules : uint32_t { Blender3 = 0, Blender4 = 1, Blender45 = 2, Blender50 = 3, Blender52 = 4 };

// Blender's smallest index of refraction; the lobes of CLASSIC use any index.
inline constexpr float kSmallestIor = 1e-5f;

// Kinds of parameters, see lancer_parameter.
enum class ParameterKind { Color, Share, Amount, Signed, Index, Denser, Turns, Direction, Vector };
constexpr bool is_of_three(ParameterKind kind) {
  return kind == ParameterKind::Color || kind == ParameterKind::Direction || kind == ParameterKind::Vector;
}
template <class F, ParameterKind kind> using ValueOf = std::conditional_t<is_of_three(kind), Vec3<F>, F>;

// Values vary by lane; the kinds are the same in all lanes.
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
  F roughness_across{0.0f}, offset{0.0f};
  F film_thickness{0.0f}, film_ior{1.33f};
  V normal{F(0.0f)}, tangent{F(0.0f)}; // world; 0 = the shading normal, any tangent
};

// Returns the weight of a lobe whose colour scales it.
template <class F> LANCER_LANE Vec3<F> colored_weight(const LobeInputs<F> &inputs) {
  return inputs.weight * max(inputs.color, Vec3<F>(F(0.0f)));
}

// weight, normal and tangent are in the LobeInputs of the lobe that has this record.
template <class F> struct PrincipledInputs {
  Rules rules = Rules::Blender45;
  Facets distribution = Facets::MultiGgx;
  uint32_t option = 1; // of the diffuse lobe
  uint32_t subsurface_option = 0;
#define LANCER_MEMBER(kind, name, spoken, given) ValueOf<F, ParameterKind::kind> name{F(given)};
  LANCER_PRINCIPLED_PARAMETERS(LANCER_MEMBER)
#undef LANCER_MEMBER
};

} // namespace lancer
