// What the facets of a lobe reflect and let through.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

#include <cmath>

namespace lancer {

template <class F> struct FacetResponse {
  using V = Vec3<F>;
  V reflected{F(0.0f)}, through{F(0.0f)}; // shares of light, tints included
  F cos_t{0.0f};                          // of the refracted direction, against the facet

  // The probability of choosing reflection.
  LANCER_LANE F reflected_share() const {
    const F zero(0.0f);
    const MaskOf<F> opaque = black(through);
    const F whole = select(black(reflected), zero, F(1.0f));
    if (all(opaque))
      return whole;
    const F r = reflected.x + reflected.y + reflected.z, t = through.x + through.y + through.z;
    return select(opaque, whole, select(r > zero, r / (r + t), zero));
  }
  LANCER_LANE MaskOf<F> is_black() const { return black(reflected) & black(through); }
};

template <class F> bool reflects(const Lobe<F> &lobe) { return (lobe.variant & static_cast<uint8_t>(Scatter::Reflect)) != 0; }
template <class F> bool refracts(const Lobe<F> &lobe) { return (lobe.variant & static_cast<uint8_t>(Scatter::Refract)) != 0; }

// Reflectance of a dielectric at the normal.
template <class F> LANCER_LANE F f0_of_ior(F ior) {
  const F r = (ior - 1.0f) / (ior + 1.0f);
  return select(abs(ior) < __builtin_inff(), r * r, F(1.0f));
}

// Schlick's curve less b cos (1 - cos)^6: Lazanyi's term, which darkens metals before the rim.
template <class F> LANCER_LANE Vec3<F> fresnel_f82(F cos_i, const Vec3<F> &f0, const Vec3<F> &b) {
  const F s = clamp01(1.0f - cos_i), s2 = s * s, s5 = s2 * s2 * s;
  const Vec3<F> one(F(1.0f));
  return clamp01(f0 + (one - f0) * s5 - b * (cos_i * s5 * s));
}

// f0 ... f90, as far as the dielectric's own curve is from its lowest value to 1.
template <class F> LANCER_LANE Vec3<F> schlick(const Lobe<F> &lobe, F reflectance) {
  return lobe.f0 + (lobe.f90 - lobe.f0) * clamp01((reflectance - lobe.lowest) * lobe.per_range);
}

// cos_i: wo against the facet.
template <class F> LANCER_LANE FacetResponse<F> facet_response(const Lobe<F> &lobe, F cos_i) {
  using V = Vec3<F>;
  FacetResponse<F> r;
  r.reflected = V(F(1.0f));
  switch (lobe.fresnel) {
  case FresnelKind::Conductor:
    r.reflected = {fresnel_conductor(cos_i, lobe.f0.x, lobe.f90.x), fresnel_conductor(cos_i, lobe.f0.y, lobe.f90.y),
                   fresnel_conductor(cos_i, lobe.f0.z, lobe.f90.z)};
    return r;
  case FresnelKind::F82:
    r.reflected = fresnel_f82(cos_i, lobe.f0, lobe.b);
    return r;
  case FresnelKind::None:
    if (!refracts(lobe))
      return r;
    break;
  default:
    break;
  }
  // Only boundaries of dielectrics let light through.
  const Fresnel<F> boundary = fresnel(cos_i, lobe.ior);
  r.cos_t = boundary.cos_t;
  switch (lobe.fresnel) {
  case FresnelKind::Dielectric:
    r.reflected = boundary.reflectance * lobe.reflection;
    if (refracts(lobe))
      r.through = boundary.transmittance * lobe.transmission;
    break;
  case FresnelKind::Schlick:
  case FresnelKind::Principled3:
    r.reflected = schlick(lobe, boundary.reflectance) * lobe.reflection;
    if (refracts(lobe)) {
      // Nothing goes through where the boundary reflects totally, whatever f90.
      const F left = min(boundary.transmittance * lobe.per_range, F(1.0f));
      const V through = ((V(F(1.0f)) - lobe.f90) + (lobe.f90 - lobe.f0) * left) * lobe.transmission;
      r.through = select(boundary.cos_t > 0.0f, through, r.through);
    }
    break;
  default:
    r.through = V(select(boundary.reflectance < 1.0f, F(1.0f), F(0.0f)));
    break;
  }
  if (!reflects(lobe))
    r.reflected = V(F(0.0f));
  return r;
}

} // namespace lancer
