// What the facets of a lobe reflect and let through.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

namespace lancer {

struct FacetResponse {
  glm::vec3 reflected{0.0f}, through{0.0f}; // shares of light, tints included
  float cos_t = 0.0f;                       // of the refracted direction, against the facet

  // The probability of choosing reflection.
  float reflected_share() const {
    if (through == glm::vec3(0.0f))
      return reflected == glm::vec3(0.0f) ? 0.0f : 1.0f;
    const float r = reflected.x + reflected.y + reflected.z, t = through.x + through.y + through.z;
    return r > 0.0f ? r / (r + t) : 0.0f;
  }
  bool black() const { return reflected == glm::vec3(0.0f) && through == glm::vec3(0.0f); }
};

inline bool reflects(const Lobe &lobe) { return (lobe.variant & static_cast<uint8_t>(Scatter::Reflect)) != 0; }
inline bool refracts(const Lobe &lobe) { return (lobe.variant & static_cast<uint8_t>(Scatter::Refract)) != 0; }

// Reflectance of a dielectric at the normal.
inline float f0_of_ior(float ior) {
  if (std::isinf(ior))
    return 1.0f;
  const float r = (ior - 1.0f) / (ior + 1.0f);
  return r * r;
}

// Schlick's curve less b cos (1 - cos)^6: Lazanyi's term, which darkens metals before the rim.
inline glm::vec3 fresnel_f82(float cos_i, const glm::vec3 &f0, const glm::vec3 &b) {
  const float s = std::clamp(1.0f - cos_i, 0.0f, 1.0f), s2 = s * s, s5 = s2 * s2 * s;
  return glm::clamp(f0 + (1.0f - f0) * s5 - b * (cos_i * s5 * s), 0.0f, 1.0f);
}

// f0 ... f90, as far as the dielectric's own curve is from its lowest value to 1.
inline glm::vec3 schlick(const Lobe &lobe, float reflectance) {
  return lobe.f0 + (lobe.f90 - lobe.f0) * std::clamp((reflectance - lobe.lowest) * lobe.per_range, 0.0f, 1.0f);
}

// cos_i: wo against the facet. Of a lobe that only reflects.
inline glm::vec3 facet_reflected(const Lobe &lobe, float cos_i) {
  switch (lobe.fresnel) {
  case FresnelKind::None:
    break;
  case FresnelKind::Dielectric:
    return fresnel_dielectric(cos_i, lobe.ior) * lobe.reflection;
  case FresnelKind::Conductor: {
    glm::vec3 f;
    for (int c = 0; c < 3; ++c)
      f[c] = fresnel_conductor(cos_i, lobe.f0[c], lobe.f90[c]);
    return f;
  }
  case FresnelKind::F82:
    return fresnel_f82(cos_i, lobe.f0, lobe.b);
  case FresnelKind::Schlick:
  case FresnelKind::Principled3:
    return schlick(lobe, fresnel_dielectric(cos_i, lobe.ior)) * lobe.reflection;
  }
  return glm::vec3(1.0f);
}

// cos_i: wo against the facet.
inline FacetResponse facet_response(const Lobe &lobe, float cos_i) {
  FacetResponse r;
  if (!refracts(lobe)) {
    r.reflected = facet_reflected(lobe, cos_i);
    return r;
  }
  // Only boundaries of dielectrics let light through.
  const Fresnel boundary = fresnel(cos_i, lobe.ior);
  r.cos_t = boundary.cos_t;
  switch (lobe.fresnel) {
  case FresnelKind::Dielectric:
    r.reflected = boundary.reflectance * lobe.reflection;
    r.through = boundary.transmittance * lobe.transmission;
    break;
  case FresnelKind::Schlick:
  case FresnelKind::Principled3: {
    r.reflected = schlick(lobe, boundary.reflectance) * lobe.reflection;
    // Nothing goes through where the boundary reflects totally, whatever f90.
    const float left = std::min(boundary.transmittance * lobe.per_range, 1.0f);
    if (boundary.cos_t > 0.0f)
      r.through = ((1.0f - lobe.f90) + (lobe.f90 - lobe.f0) * left) * lobe.transmission;
    break;
  }
  default:
    r.reflected = glm::vec3(1.0f);
    r.through = glm::vec3(boundary.reflectance < 1.0f ? 1.0f : 0.0f);
    break;
  }
  if (!reflects(lobe))
    r.reflected = glm::vec3(0.0f);
  return r;
}

} // namespace lancer
