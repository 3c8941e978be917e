// Unpolarised Fresnel reflectance of a smooth dielectric boundary, and the refracted direction.
#pragma once

#include "bsdf/lobe.h"
#include "sampling/elementary.h"
#include "simd/vectors.h"

#include <cmath>

namespace lancer {

template <class F> struct Fresnel {
  F reflectance;   // F
  F cos_t;         // cosine of the refracted direction; 0 under total internal reflection
  F transmittance; // 1 - F, with all digits if F is nearly 1
};

// cos_i: cosine on the incident side, clamped to at least 0. eta: index beyond the boundary over index before it; infinite =
// mirror. The computation is in double, for the whole range of float indices: e^2 neither overflows nor vanishes, and the small
// differences near eta = 1 keep at least 8 digits. So one formula covers all cases, and F is exact to the rounding of the
// result.
template <class F> LANCER_LANE Fresnel<F> fresnel(F cos_i, F eta) {
  using D = DoubleOf<F>;
  const D c = min(max(widen(cos_i), D(0.0)), D(1.0));
  // Snell's law; total internal reflection if cos^2 is not positive.
  const D n = widen(eta), e = D(1.0) / n;
  const D cos2_t = (n - D(1.0)) * e * ((n + D(1.0)) * e) + (e * c) * (e * c);
  const D g = sqrt(cos2_t);
  // Amplitudes of both polarisations.
  const D rs = (e * c - g) / (e * c + g);
  const D rp = (c - e * g) / (c + e * g);
  const D f = D(0.5) * (rs * rs + rp * rp);
  // Special cases: grazing incidence, total reflection, eta of 1 or infinity.
  const MaskOf<F> total = !(cos2_t > D(0.0)), mirror = eta == F(__builtin_inff()), straight = eta == F(1.0f);
  const MaskOf<F> all = MaskOf<F>(c == D(0.0)) | total | mirror;
  return {select(straight, F(0.0f), select(all, F(1.0f), narrow(f))),
          select(straight, narrow(c), select(mirror, F(1.0f), select(total, F(0.0f), narrow(g)))),
          select(straight, F(1.0f), select(all, F(0.0f), narrow(D(1.0) - f)))};
}

template <class F> LANCER_LANE F fresnel_dielectric(F cos_i, F eta) { return fresnel(cos_i, eta).reflectance; }

// Returns the unpolarised reflectance of a metal of index n + i k, seen from vacuum.
template <class F> LANCER_LANE F fresnel_conductor(F cos_i, F n, F k) {
  const F zero(0.0f), c = clamp01(cos_i), c2 = c * c, sin2 = (1.0f - c) * (1.0f + c);
  // The square root u + i v of (n + i k)^2 - sin^2.
  const F re = (n - k) * (n + k) - sin2, im = 2.0f * n * k;
  const F length = hypot(re, im);
  const F u2 = max(0.5f * (length + re), zero), v2 = max(0.5f * (length - re), zero);
  const F u = sqrt(u2);
  // Polarised perpendicular to the plane of incidence, then parallel: rp = rs times a further ratio.
  const F across = (c - u) * (c - u) + v2, across_sum = (c + u) * (c + u) + v2;
  const F rs = select(across_sum > zero, across / across_sum, F(1.0f));
  const F mean = (u2 + v2) * c2 + sin2 * sin2, mixed = 2.0f * c * u * sin2;
  const F rp = select(mean + mixed > zero, rs * (mean - mixed) / (mean + mixed), rs);
  return 0.5f * (rs + rp);
}

// Returns the reflectance of a metal under the assumption n^2 + k^2 >> 1, which Cycles before 5.0 makes.
template <class F> LANCER_LANE F fresnel_strong_conductor(F cos_i, F n, F k) {
  const F c = clamp01(cos_i), size = n * n + k * k, twice = 2.0f * n * c, one(1.0f);
  const F parallel = (size * c * c - twice + one) / (size * c * c + twice + one);
  const F across_sum = size + twice + c * c;
  const F across = select(across_sum > F(0.0f), (size - twice + c * c) / across_sum, one);
  return 0.5f * (parallel + across);
}

// Returns the refracted direction for wo with wo.z > 0; cos_t from fresnel(wo.z, eta). The refracted direction has z < 0.
template <class F> LANCER_LANE Vec3<F> refract_local(const Vec3<F> &wo, F eta, F cos_t) {
  return normalize(Vec3<F>(-wo.x / eta, -wo.y / eta, -cos_t));
}

// Reflected and transmitted shares at a lobe's facets.

template <class F> struct FacetResponse {
  using V = Vec3<F>;
  V reflected{F(0.0f)}, through{F(0.0f)}; // shares of light, tints included
  F cos_t{0.0f};                          // cosine of the refracted direction to the facet

  // Returns the probability of choosing reflection.
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

// Schlick's curve at cosine 1/7, and the factor that gives b from a difference there.
inline constexpr float kSix7 = 6.0f / 7.0f, kFifth = kSix7 * kSix7 * kSix7 * kSix7 * kSix7;
inline constexpr float kEdgeScale = 7.0f / (kFifth * kSix7);

template <class F> bool reflects(const Lobe<F> &lobe) { return (lobe.variant & static_cast<uint8_t>(Scatter::Reflect)) != 0; }
template <class F> bool refracts(const Lobe<F> &lobe) { return (lobe.variant & static_cast<uint8_t>(Scatter::Refract)) != 0; }

// Returns the reflectance of a dielectric at normal incidence.
template <class F> LANCER_LANE F f0_of_ior(F ior) {
  const F r = (ior - 1.0f) / (ior + 1.0f);
  return select(abs(ior) < __builtin_inff(), r * r, F(1.0f));
}

// Schlick's curve minus b cos (1 - cos)^6: Lazanyi's term, which darkens metals before the rim.
template <class F> LANCER_LANE Vec3<F> fresnel_f82(F cos_i, const Vec3<F> &f0, const Vec3<F> &b) {
  const F s = clamp01(1.0f - cos_i), s2 = s * s, s5 = s2 * s2 * s;
  const Vec3<F> one(F(1.0f));
  return clamp01(f0 + (one - f0) * s5 - b * (cos_i * s5 * s));
}

// Interpolates f0 ... f90 by the dielectric's own curve, normalised from its lowest value to 1.
template <class F> LANCER_LANE Vec3<F> schlick(const Lobe<F> &lobe, F reflectance) {
  return lobe.f0 + (lobe.f90 - lobe.f0) * clamp01((reflectance - lobe.lowest) * lobe.per_range);
}

template <class F> LANCER_LANE Vec3<F> conductor_response(const Lobe<F> &lobe, F cos_i) {
  if (lobe.fresnel == FresnelKind::StrongConductor)
    return {fresnel_strong_conductor(cos_i, lobe.f0.x, lobe.f90.x), fresnel_strong_conductor(cos_i, lobe.f0.y, lobe.f90.y),
            fresnel_strong_conductor(cos_i, lobe.f0.z, lobe.f90.z)};
  return {fresnel_conductor(cos_i, lobe.f0.x, lobe.f90.x), fresnel_conductor(cos_i, lobe.f0.y, lobe.f90.y),
          fresnel_conductor(cos_i, lobe.f0.z, lobe.f90.z)};
}

// The response of facets without a film.
template <class F> LANCER_LANE FacetResponse<F> bare_response(const Lobe<F> &lobe, F cos_i) {
  using V = Vec3<F>;
  FacetResponse<F> r;
  r.reflected = V(F(1.0f));
  switch (lobe.fresnel) {
  case FresnelKind::Conductor:
  case FresnelKind::StrongConductor:
    r.reflected = conductor_response(lobe, cos_i);
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
  // Only dielectric boundaries transmit.
  const Fresnel<F> boundary = fresnel(abs(cos_i), lobe.ior);
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
      // Total reflection transmits nothing, whatever f90.
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

#include "bsdf/thin_film.h"

namespace lancer {

// cos_i: of wo to the facet; below 0 where a normal faces away from wo, of which dielectrics take the magnitude, as Cycles
// does.
template <class F> LANCER_LANE FacetResponse<F> facet_response(const Lobe<F> &lobe, F cos_i) {
  FacetResponse<F> response = bare_response(lobe, cos_i);
  if (lobe.film)
    add_film(lobe, cos_i, response);
  return response;
}

} // namespace lancer
