// The Light Path node: data of the ray for which nodes are evaluated, and of the path before that ray.
#pragma once

#include "scene/enums.h"
#include "simd/scalar.h"

#include <algorithm>

namespace lancer {

// Bits beside RayKind for the scattering event that sent the ray: a single direction, reflection.
constexpr uint32_t kRaySingular = 256, kRayReflected = 512;

template <class F> struct LightPath {
  WordOf<F> kinds = WordOf<F>(0u); // RayKind, kRaySingular, kRayReflected; 0 for a sampled light
  F length = F(0.0f);              // of the ray, in the user's units
  // Scattering events before the ray: all, and by kind; surfaces passed straight through, portals included; portals.
  F depth = F(0.0f), diffuse = F(0.0f), glossy = F(0.0f), transmission = F(0.0f), transparent = F(0.0f), portal = F(0.0f);
  // The width of what a pixel sees at the end of the ray, normalised units, and its growth along the ray; for a direction of
  // the world both are the angle. For images with mipmaps: elsewhere they are not read.
  F width = F(0.0f), spread = F(0.0f);
};

// which: PathFact.
template <class F> LANCER_LANE F light_path_value(uint32_t which, const LightPath<F> &path) {
  constexpr uint32_t kBits[] = {RayKind::Camera, RayKind::Shadow, RayKind::Diffuse,      RayKind::Glossy,
                                kRaySingular,    kRayReflected,   RayKind::Transmission, RayKind::Volume};
  switch (which) {
  case PathFact::Length:
    return path.length;
  case PathFact::Depth:
    return path.depth;
  case PathFact::DiffuseDepth:
    return path.diffuse;
  case PathFact::GlossyDepth:
    return path.glossy;
  case PathFact::TransparentDepth:
    return path.transparent;
  case PathFact::TransmissionDepth:
    return path.transmission;
  case PathFact::PortalDepth:
    return path.portal;
  default:
    return select(equal(path.kinds & WordOf<F>(kBits[which]), WordOf<F>(0u)), F(0.0f), F(1.0f));
  }
}

// Data of a Light Path node about a path: the kind of its last scattering event, and counts by kind.
struct PathStory {
  uint16_t kinds = RayKind::Camera; // see LightPath::kinds
  uint8_t diffuse = 0, glossy = 0, transmission = 0, portals = 0;

  // The counts saturate at 255.
  void scatter(bool is_diffuse, bool transmitted, bool singular) {
    uint8_t &count = transmitted ? transmission : is_diffuse ? diffuse : glossy;
    count = uint8_t(std::min(count + 1, 255));
    kinds = uint16_t((is_diffuse ? RayKind::Diffuse : RayKind::Glossy) |
                     (transmitted ? uint32_t(RayKind::Transmission) : kRayReflected) | (singular ? kRaySingular : 0));
  }
  void pass_portal() { portals = uint8_t(std::min(portals + 1, 255)); }
  LightPath<float> told(float length, uint32_t scatterings, uint32_t passed_through) const {
    return {.kinds = kinds,
            .length = length,
            .depth = float(scatterings),
            .diffuse = float(diffuse),
            .glossy = float(glossy),
            .transmission = float(transmission),
            .transparent = float(passed_through),
            .portal = float(portals)};
  }
};

} // namespace lancer
