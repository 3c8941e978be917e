// The Light Path node: data of the ray for which nodes are evaluated, and of the path before that ray.
#pragma once

#include "lancer.h"
#include "simd/scalar.h"

#include <algorithm>

namespace lancer {

// Bits beside LANCER_RAY_* for the scattering event that sent the ray: a single direction, reflection.
constexpr uint32_t kRaySingular = 64, kRayReflected = 128;

template <class F> struct LightPath {
  WordOf<F> kinds = WordOf<F>(0u); // LANCER_RAY_*, kRaySingular, kRayReflected; 0 for a sampled light
  F length = F(0.0f);              // of the ray, in the user's units
  // Scattering events before the ray: all, and by kind; surfaces passed straight through.
  F depth = F(0.0f), diffuse = F(0.0f), glossy = F(0.0f), transmission = F(0.0f), transparent = F(0.0f), portal = F(0.0f);
};

// which: LANCER_PATH_*.
template <class F> LANCER_LANE F light_path_value(uint32_t which, const LightPath<F> &path) {
  constexpr uint32_t kBits[] = {LANCER_RAY_CAMERA, LANCER_RAY_SHADOW, LANCER_RAY_DIFFUSE,      LANCER_RAY_GLOSSY,
                                kRaySingular,      kRayReflected,     LANCER_RAY_TRANSMISSION, LANCER_RAY_VOLUME};
  switch (which) {
  case LANCER_PATH_LENGTH:
    return path.length;
  case LANCER_PATH_DEPTH:
    return path.depth;
  case LANCER_PATH_DIFFUSE_DEPTH:
    return path.diffuse;
  case LANCER_PATH_GLOSSY_DEPTH:
    return path.glossy;
  case LANCER_PATH_TRANSPARENT_DEPTH:
    return path.transparent;
  case LANCER_PATH_TRANSMISSION_DEPTH:
    return path.transmission;
  case LANCER_PATH_PORTAL_DEPTH:
    return path.portal;
  default:
    return select(equal(path.kinds & WordOf<F>(kBits[which]), WordOf<F>(0u)), F(0.0f), F(1.0f));
  }
}

// Data of a Light Path node about a path: the kind of its last scattering event, and counts by kind.
struct PathStory {
  uint8_t kinds = LANCER_RAY_CAMERA; // see LightPath::kinds
  uint8_t diffuse = 0, glossy = 0, transmission = 0;

  // The counts saturate at 255.
  void scatter(bool is_diffuse, bool transmitted, bool singular) {
    uint8_t &count = transmitted ? transmission : is_diffuse ? diffuse : glossy;
    count = uint8_t(std::min(count + 1, 255));
    kinds = uint8_t((is_diffuse ? LANCER_RAY_DIFFUSE : LANCER_RAY_GLOSSY) |
                    (transmitted ? uint32_t(LANCER_RAY_TRANSMISSION) : kRayReflected) | (singular ? kRaySingular : 0));
  }
  LightPath<float> told(float length, uint32_t scatterings, uint32_t passed_through) const {
    return {.kinds = kinds,
            .length = length,
            .depth = float(scatterings),
            .diffuse = float(diffuse),
            .glossy = float(glossy),
            .transmission = float(transmission),
            .transparent = float(passed_through)};
  }
};

} // namespace lancer
