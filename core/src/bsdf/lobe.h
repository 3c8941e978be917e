// A lobe at a hit in every lane, ready for evaluation and sampling: the material after nodes, layers and wo; and the frame of
// its directions.
#pragma once

#include "scene/lobe_inputs.h"
#include "simd/vectors.h"

namespace lancer {

// The local frame of a surface point: n becomes +z.
template <class F> struct Frame {
  using V = Vec3<F>;
  V t, b, n; // orthonormal, right-handed

  Frame() = default;

  // n must be unit. Duff et al. 2017: no direction is near a singularity.
  LANCER_LANE explicit Frame(const V &normal) : n(normal) {
    const F sign = copysign(F(1.0f), n.z);
    const F a = -1.0f / (sign + n.z);
    const F c = n.x * n.y * a;
    t = V(1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x);
    b = V(c, sign + n.y * n.y * a, -n.y);
  }

  // t lies in the plane of n and tangent; it is arbitrary if they are parallel.
  LANCER_LANE Frame(const V &normal, const V &tangent) : Frame(normal) {
    const V across = cross(normal, tangent);
    const F length2 = dot(across, across);
    const auto apart = length2 > 0.0f;
    b = select(apart, across / sqrt(length2), b);
    t = select(apart, cross(b, normal), t);
  }

  LANCER_LANE V to_local(const V &w) const { return {dot(w, t), dot(w, b), dot(w, n)}; }
  LANCER_LANE V to_world(const V &w) const { return w.x * t + w.y * b + w.z * n; }
};
Frame(const glm::vec3 &)->Frame<float>;
Frame(const glm::vec3 &, const glm::vec3 &)->Frame<float>;

// Returns a / b, or 0 for b = 0.
template <class F> LANCER_LANE F quotient(F a, F b) { return select(b != F(0.0f), a / b, F(0.0f)); }

// Returns the mirrored direction in the local frame, and the one mirrored at the surface.
template <class V> LANCER_LANE V reflect_local(const V &w) { return {-w.x, -w.y, w.z}; }
template <class V> LANCER_LANE V mirrored_beyond(const V &w) { return {w.x, w.y, -w.z}; }

// Returns tan^2 of a direction's angle to n. Not computed from 1 - cos^2, which loses a small roughness in rounding.
template <class V> LANCER_LANE NumberOf<V> tan2_theta(const V &w) { return (w.x * w.x + w.y * w.y) / (w.z * w.z); }

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
  Sheen = 9,      // microfibres
  Toon = 10,
  Hair = 11,
  Subsurface = 12 // light enters, to leave the surface elsewhere
};
inline constexpr uint32_t kLobeShapes = 13;
constexpr uint32_t shape_bit(LobeShape shape) { return 1u << static_cast<uint32_t>(shape); }
inline constexpr uint32_t kAllShapes = (1u << kLobeShapes) - 1u;

// The kinds of light that passes and ray visibility distinguish.
enum class Component : uint8_t { Diffuse = 0, Glossy = 1, Transmission = 2 };
constexpr bool operator==(uint32_t number, Component component) { return number == static_cast<uint32_t>(component); }

// Where the facets of Microfacet send light; stored in Lobe::variant. Through: as Reflect, then mirrored at the surface, as by
// a sheet of glass.
enum class Scatter : uint8_t { Reflect = 1, Refract = 2, Both = 3, Through = 5 };

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
  uint8_t variant = 0;                      // of Matte, Ashikhmin, Toon, Hair, Subsurface; Scatter of Microfacet
  Component component = Component::Diffuse; // of the light on wo's side, if a lobe reflects and transmits
  uint8_t frame = 0;                        // index into Bsdf::frames
  bool beckmann = false;                    // distribution of the facets; else GGX
  FresnelKind fresnel = FresnelKind::None;
  bool film = false; // a film may cover the facets: thin_film.h
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
