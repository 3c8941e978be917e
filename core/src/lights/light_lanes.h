// The members of lights for lanes, and the records that lanes get from lights. Formulas read a light by its members, as
// light[&Light::radius], for one light in all lanes as for one light in each lane. F is a float, or lanes of floats.
#pragma once

#include "lights/light.h"
#include "simd/memory.h"
#include "simd/vectors.h"

namespace lancer {

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
