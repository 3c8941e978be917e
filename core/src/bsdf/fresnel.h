// Unpolarised Fresnel reflectance of a smooth dielectric boundary, and the direction that goes through it.
#pragma once

#include "sampling/elementary.h"
#include "simd/vectors.h"

namespace lancer {

template <class F> struct Fresnel {
  F reflectance;   // F
  F cos_t;         // cosine of the refracted direction; 0 under total internal reflection
  F transmittance; // 1 - F, with all digits where F is nearly 1
};

// cos_i: cosine on the incident side, taken as at least 0. eta: index beyond the boundary over index before it; infinite =
// mirror. Double carries the whole range of float indices: e^2 neither overflows nor vanishes, and the small differences near
// eta = 1 keep at least 8 digits. So one form serves everywhere, and F is exact to the rounding of the result.
template <class F> LANCER_LANE Fresnel<F> fresnel(F cos_i, F eta) {
  using D = DoubleOf<F>;
  const D c = min(max(widen(cos_i), D(0.0)), D(1.0));
  // Snell's law; total internal reflection where no cosine is left.
  const D n = widen(eta), e = D(1.0) / n;
  const D cos2_t = (n - D(1.0)) * e * ((n + D(1.0)) * e) + (e * c) * (e * c);
  const D g = sqrt(cos2_t);
  // Amplitudes of both polarisations.
  const D rs = (e * c - g) / (e * c + g);
  const D rp = (c - e * g) / (c + e * g);
  const D f = D(0.5) * (rs * rs + rp * rp);
  // Grazing, totally reflecting, and what bends nothing at all or everything.
  const auto total = !(cos2_t > D(0.0)), mirror = eta == F(__builtin_inff());
  const auto all = (c == D(0.0)) | total | mirror, straight = eta == F(1.0f);
  return {select(straight, F(0.0f), select(all, F(1.0f), narrow(f))),
          select(straight, narrow(c), select(mirror, F(1.0f), select(total, F(0.0f), narrow(g)))),
          select(straight, F(1.0f), select(all, F(0.0f), narrow(D(1.0) - f)))};
}

template <class F> LANCER_LANE F fresnel_dielectric(F cos_i, F eta) { return fresnel(cos_i, eta).reflectance; }

// Unpolarised reflectance of a metal of index n + i k, seen from the vacuum.
template <class F> LANCER_LANE F fresnel_conductor(F cos_i, F n, F k) {
  const F zero(0.0f), c = clamp01(cos_i), c2 = c * c, sin2 = (1.0f - c) * (1.0f + c);
  // The square root u + i v of (n + i k)^2 - sin^2.
  const F re = (n - k) * (n + k) - sin2, im = 2.0f * n * k;
  const F length = hypot(re, im);
  const F u2 = max(0.5f * (length + re), zero), v2 = max(0.5f * (length - re), zero);
  const F u = sqrt(u2);
  // Polarised across the plane of incidence, then along it: rp = rs times a further ratio.
  const F across = (c - u) * (c - u) + v2, across_sum = (c + u) * (c + u) + v2;
  const F rs = select(across_sum > zero, across / across_sum, F(1.0f));
  const F mean = (u2 + v2) * c2 + sin2 * sin2, mixed = 2.0f * c * u * sin2;
  const F rp = select(mean + mixed > zero, rs * (mean - mixed) / (mean + mixed), rs);
  return 0.5f * (rs + rp);
}

// The refracted direction for wo with wo.z > 0; cos_t from fresnel(wo.z, eta). It leaves on the other side, z < 0.
template <class F> LANCER_LANE Vec3<F> refract_local(const Vec3<F> &wo, F eta, F cos_t) {
  return normalize(Vec3<F>(-wo.x / eta, -wo.y / eta, -cos_t));
}

} // namespace lancer
