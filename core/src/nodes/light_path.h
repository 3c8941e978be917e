// The Light Path: what is known of the ray for which nodes are asked, and of the path before it.
#pragma once

#include "lancer.h"
#include "simd/scalar.h"

namespace lancer {

// Beside LANCER_RAY_* bits, of the scattering that sent the ray: into one direction alone, to the side it came from.
constexpr uint32_t kRaySingular = 64, kRayReflected = 128;

template <class F> struct LightPath {
  WordOf<F> kinds = WordOf<F>(0u); // LANCER_RAY_*, kRaySingular, kRayReflected; a light that is sampled is asked for by none
  F length = F(0.0f);              // of the ray, in the user's units
  // Scatterings before the ray: all of them, and by what they were; surfaces passed straight through.
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

} // namespace lancer
