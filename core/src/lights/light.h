// A light as the integrators read it: in the normalised world, ready to sample; and its members in lanes. Formulas read a light
// by its members, as light[&Light::radius], for one light in all lanes as for one light in each lane. F is a float, or lanes of
// floats.
#pragma once

#include "scene/light.h"
#include "scene/ray.h"
#include "simd/memory.h"
#include "simd/vectors.h"

#include <glm/gtc/constants.hpp>

namespace lancer {

// The properties of a light that only CLASSIC uses.
struct ClassicLight {
  Falloff falloff = Falloff::Physical;
  double radius = 0.0;     // normalised units
  double world_unit = 1.0; // length of one world unit, in normalised units
  glm::vec3 ambient_color{1.0f}, diffuse_color{1.0f}, specular_color{1.0f};
};

struct Light {
  LightKind kind = LightKind::Point;
  glm::dvec3 position{0.0};
  glm::dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}; // unit axes; the light shines along -z
  // POINT, SPOT: intensity in normalised units; SUN: irradiance; AREA: radiance. In double, because intensities scale with
  // squared lengths.
  glm::dvec3 emission{0.0};
  double radius = 0.0;
  bool soft_falloff = true;
  double cos_half_angle = -1.0, blend_width = 0.0; // SPOT
  bool spot_cosine = false;
  // SPOT: of the cone's cross-section. Where the cone is skewed, x, y and z are not orthogonal: a direction has the local
  // coordinates dot(x) / stretch_x, dot(y) / stretch_y and dot(z), and the cone lies before the plane of normal z.
  double stretch_x = 1.0, stretch_y = 1.0;
  bool stretched = false, skewed_cone = false;
  double one_minus_cos_sun = 0.0;                // SUN: 1 - cos of half its angle
  double flat_radius = 0.0;                      // SUN: radius of the flat disk at distance 1; 0 = uniform radiance
  double half_x = 0.0, half_y = 0.0, area = 0.0; // AREA
  double skew = 0.0;                             // AREA: how far along x the side at half_y lies from that of a rectangle
  bool ellipse = false;
  double tan_half_spread = 0.0, spread_scale = 0.0; // AREA; scale 0 = no limit
  double plane_tolerance = 0.0; // AREA: a face at most this far before the lamp's plane is meant to lie in the plane
  uint32_t hidden_from = 0;     // RayKind bits
  bool no_shadow = false;
  uint32_t light_group = 0; // 0 = none
  LightLinks links;
  uint32_t lit_surfaces = 0; // 0: all
  uint32_t shader = kNone;   // index of LampShaders: its strength multiplies the light; kNone: 1
  double level = 1.0;        // mean strength, for the choice of a light
  ClassicLight classic;
};

// A point of a light as seen from p. The estimate of the irradiance at normal incidence is radiance / pdf; for delta lights (a
// single direction), radiance is that irradiance and pdf is 1. pdf is per solid angle, without the probability of choosing the
// light; 0 = no sample.
struct LightSample {
  glm::dvec3 target{0.0}; // where the shadow ray ends: the point, or just before it; only where finite
  glm::dvec3 wi{0.0};     // unit, towards the light
  double distance = 0.0;  // infinite for a sun
  glm::vec3 radiance{0.0f};
  double pdf = 0.0;
  bool delta = false;
};

// A light hit by the ray from o along the unit wi.
struct LightHit {
  glm::vec3 radiance{0.0f};
  double pdf = 0.0;      // as sample() from o would return it; 0 = not hit
  double distance = 0.0; // of the target that sample() would return; infinite for a sun
};

inline bool has_extent(const Light &light) {
  if (light.kind == LightKind::Sun)
    return light.one_minus_cos_sun > 0.0;
  return light.kind == LightKind::Area ? light.area > 0.0 : light.radius > 0.0;
}

// One light for all lanes.
template <class F> struct OneLight {
  const Light &light;

  LANCER_LANE WordOf<F> kind() const { return WordOf<F>(static_cast<uint32_t>(light.kind)); }
  LANCER_LANE DoubleOf<F> operator[](double Light::*number) const { return DoubleOf<F>(light.*number); }
  LANCER_LANE MaskOf<F> operator[](bool Light::*holds) const { return equal(WordOf<F>(light.*holds ? 1u : 0u), WordOf<F>(1u)); }
  LANCER_LANE Double3Of<F> operator[](glm::dvec3 Light::*vector) const { return light.*vector; }
};

// One light for each lane.
template <class F> struct EachLight {
  static constexpr int kWidth = LanesOf<F>::kWidth;

  const Light *const *lights;

  LANCER_LANE WordOf<F> kind() const {
    return words([](const Light &light) __attribute__((always_inline)) { return static_cast<uint32_t>(light.kind); });
  }
  LANCER_LANE DoubleOf<F> operator[](double Light::*number) const {
    return doubles([=](const Light &light) __attribute__((always_inline)) { return light.*number; });
  }
  LANCER_LANE MaskOf<F> operator[](bool Light::*holds) const {
    const auto word = [=](const Light &light) __attribute__((always_inline)) { return light.*holds ? 1u : 0u; };
    return equal(words(word), WordOf<F>(1u));
  }
  LANCER_LANE Double3Of<F> operator[](glm::dvec3 Light::*vector) const {
    return {doubles([=](const Light &light) __attribute__((always_inline)) { return (light.*vector).x; }),
            doubles([=](const Light &light) __attribute__((always_inline)) { return (light.*vector).y; }),
            doubles([=](const Light &light) __attribute__((always_inline)) { return (light.*vector).z; })};
  }

private:
  template <class Get> LANCER_LANE DoubleOf<F> doubles(Get get) const {
    alignas(64) double values[kWidth];
    for (int i = 0; i < kWidth; ++i)
      values[i] = get(*lights[i]);
    return load_lanes<kWidth>(values);
  }
  template <class Get> LANCER_LANE WordOf<F> words(Get get) const {
    alignas(64) uint32_t values[kWidth];
    for (int i = 0; i < kWidth; ++i)
      values[i] = get(*lights[i]);
    return load_lanes<kWidth>(values);
  }
};

// LightSample and LightHit of each lane.
template <class F> struct LightSampleLanes {
  Double3Of<F> target, wi;
  DoubleOf<F> distance, pdf;
  Vector3<F> radiance;
  MaskOf<F> delta;
};
template <class F> struct LightHitLanes {
  Vector3<F> radiance;
  DoubleOf<F> pdf, distance;
};

} // namespace lancer
