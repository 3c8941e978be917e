// A lobe at a hit in every lane, ready for evaluation and sampling: the material after nodes, layers and wo.
#pragma once

#include "scene/lobe_inputs.h"
#include "simd/vectors.h"

namespace lancer {

// Returns how far anisotropy in 0 ... 1 stretches facets: roughness along the tangent is divided by it, across multiplied.
template <class F> LANCER_LANE F aspect_of(F anisotropy) { return sqrt(max(F(0.0f), 1.0f - 0.9f * anisotropy)); }

// The formulas of a lobe.
enum class LobeShape : uint8_t {
  Lambert = 0,    // color / pi
  Beckmann = 1,   // coating of CLASSIC: exact Fresnel, Walter's G1
  Mirror = 2,     // one direction
  Dielectric = 3, // smooth glass: one or two directions
  Phong = 4,
  BlinnPhong = 5,
  Matte = 6,      // Oren-Nayar, Burley, velvet, translucent, Minnaert: smooth and wide, distinguished by variant
  Microfacet = 7, // GGX or Beckmann, reflection, refraction or both, smooth or rough
  Ashikhmin = 8,  // Ashikhmin-Shirley, the clear coat of 3.x
  Sheen = 9       // microfibres
};
inline constexpr uint32_t kLobeShapes = 10;
constexpr uint32_t shape_bit(LobeShape shape) { return 1u << static_cast<uint32_t>(shape); }
inline constexpr uint32_t kAllShapes = (1u << kLobeShapes) - 1u;

// The kinds of light that passes and ray visibility distinguish.
enum class Component : uint8_t { Diffuse = 0, Glossy = 1, Transmission = 2 };
constexpr bool operator==(uint32_t number, Component component) { return number == static_cast<uint32_t>(component); }

// Where the facets of Microfacet send light; stored in Lobe::variant.
enum class Scatter : uint8_t { Reflect = 1, Refract = 2, Both = 3 };

// The Fresnel curve of a microfacet: F of the half vector's cosine.
enum class FresnelKind : uint8_t {
  None = 0,           // 1 reflected, 1 refracted: color is the full weight; f0 is the mean of further bounces
  Dielectric = 1,     // of ior
  Conductor = 2,      // n = f0, k = f90
  F82 = 3,            // f0 at the normal, b the Lazanyi term
  Schlick = 4,        // f0 ... f90 along the dielectric curve of ior
  Principled3 = 5,    // the same by the rules of Blender 3.x
  StrongConductor = 6 // n = f0, k = f90, approximated for strong absorption
};

inline constexpr int kMaxFrames = 16;

// Kinds are the same in all lanes; numbers differ.
template <class F> struct Lobe {
  using V = Vec3<F>;
  using B = MaskOf<F>;

  LobeShape shape = LobeShape::Lambert;
  uint8_t variant = 0;                      // of Matte, Ashikhmin; Scatter of Microfacet
  Component component = Component::Diffuse; // of the light on wo's side, if a lobe reflects and transmits
  uint8_t frame = 0;                        // index into Bsdf::frames
  bool beckmann = false;                    // distribution of the facets; else GGX
  FresnelKind fresnel = FresnelKind::None;
  Rules rules = Rules::Blender45;

  B delta = uniform<F>(false);         // a single direction: too smooth for evaluation
  B delta_through = uniform<F>(false); // Microfacet refracts in a single direction, even if its reflection is rough
  V color{F(0.0f)};                    // factor of the whole lobe
  F probability{0.0f};                 // of being selected, set by Bsdf::complete()
  F alpha_x{0.0f}, alpha_y{0.0f};      // a single roughness is in alpha_x
  F ior{1.5f};                         // from wo's side: beyond over before
  F shininess{0.0f};
  F energy{1.0f}; // factor of single scattering that adds multiple scattering
  F shown{0.0f};  // the passes' colour is color times this; 0: the albedo
  V f0{F(0.0f)}, f90{F(1.0f)}, b{F(0.0f)};
  F lowest{0.0f}, per_range{1.0f};              // Schlick: reflectance of ior at normal incidence, and 1 over the rest to 1
  V reflection{F(1.0f)}, transmission{F(1.0f)}; // tints
  V albedo{F(0.0f)};                            // scattered share of light from wo, color included
  V through{F(0.0f)};                           // transmitted part of albedo, if a lobe reflects and transmits
  F hidden{0.0f}, g1{0.0f};                     // of Microfacet, for wo: facet_hidden(), facet_g1()
};

// Value of a smooth lobe. Directions are in the local frame, oriented so that wo.z > 0 and wi.z > 0.
template <class F> struct LobeValue {
  F f{0.0f};   // without the lobe's colour and the cosine, 1/sr
  F pdf{0.0f}; // per solid angle of wi
};

// Coloured value with the cosine; pdf per solid angle of wi.
template <class F> struct ColorValue {
  Vec3<F> f{F(0.0f)};
  F pdf{0.0f};
};
template <class F> LANCER_LANE ColorValue<F> where(const MaskOf<F> &m, const ColorValue<F> &value) {
  return {select(m, value.f, Vec3<F>(F(0.0f))), select(m, value.pdf, F(0.0f))};
}
template <class F> LANCER_LANE LobeValue<F> where(const MaskOf<F> &m, const LobeValue<F> &value) {
  return {select(m, value.f, F(0.0f)), select(m, value.pdf, F(0.0f))};
}

// Returns the zero vector if the directions are so close to the horizon that their sum vanishes.
template <class V> LANCER_LANE V half_vector(const V &wo, const V &wi) {
  using F = NumberOf<V>;
  const V sum = wo + wi;
  const F length2 = dot(sum, sum);
  return select(length2 > 0.0f, sum / sqrt(length2), V(F(0.0f)));
}

template <class V> LANCER_LANE V reflect_about(const V &wo, const V &h) { return 2.0f * dot(wo, h) * h - wo; }

} // namespace lancer
