// Facets of a lobe for many lanes at once: GGX, Fresnel, what is reflected and let through; as in ggx.h, fresnel.h,
// microfacet_fresnel.h and microfacet_terms.h. For kernels only, like simd/lanes.h.
#pragma once

#include "sampling/warp.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE F clamp01(F x) { return min(max(x, F(0.0f)), F(1.0f)); }
LANCER_LANE V3 clamp01(const V3 &x) { return {clamp01(x.x), clamp01(x.y), clamp01(x.z)}; }

// A lobe as wo sees it.
struct WideTerm {
  M lambert, facets; // what it is
  M f82, schlick, dielectric;
  M glass; // lets light through, too
  M delta, delta_through;
  V3 color, albedo;
  F probability;
  F alpha_x, alpha_y, energy;
  V3 f0, f90, b, reflection, transmission;
  F ior, lowest, per_range;
  F g1; // of wo: 1 / (wo.z + hidden), and what is hidden
  F hidden;
};

LANCER_LANE F ggx_hidden(const V3 &w, F alpha_x, F alpha_y) {
  const F x = alpha_x * w.x, y = alpha_y * w.y;
  const F along = sqrt(x * x + y * y), z = abs(w.z);
  const F all = z + sqrt(z * z + along * along);
  return select(all > F(0.0f), F(0.5f) * along * (along / all), F(0.0f));
}

// As fresnel() of fresnel.h.
struct WideFresnel {
  F reflectance, cos_t, transmittance;
};
LANCER_LANE WideFresnel fresnel_dielectric(F cos_i, F eta) {
  const F zero(0.0f), one(1.0f);
  const D c = min(max(widen(cos_i), D(0.0)), D(1.0));
  const D n = widen(eta), e = D(1.0) / n;
  const D cos2_t = (n - D(1.0)) * e * ((n + D(1.0)) * e) + (e * c) * (e * c);
  const D g = sqrt(cos2_t);
  const D rs = (e * c - g) / (e * c + g);
  const D rp = (c - e * g) / (c + e * g);
  const D f = D(0.5) * (rs * rs + rp * rp);
  WideFresnel r{narrow(f), narrow(g), narrow(D(1.0) - f)};
  // Grazing, totally reflecting, and what bends nothing at all or everything.
  const M total = !(cos2_t > D(0.0)), mirror = eta == F(__builtin_inff()), all = (c == D(0.0)) | total | mirror;
  const M straight = eta == one;
  r.reflectance = select(straight, zero, select(all, one, r.reflectance));
  r.cos_t = select(straight, narrow(c), select(mirror, one, select(total, zero, r.cos_t)));
  r.transmittance = select(straight, one, select(all, zero, r.transmittance));
  return r;
}

LANCER_LANE V3 fresnel_f82(F cos_i, const V3 &f0, const V3 &b) {
  const F s = clamp01(F(1.0f) - cos_i), s2 = s * s, s5 = s2 * s2 * s;
  const F edge = cos_i * s5 * s;
  const V3 one{F(1.0f), F(1.0f), F(1.0f)};
  return clamp01(f0 + (one - f0) * s5 - b * edge);
}

struct WideResponse {
  V3 reflected, through;
  F cos_t; // of the refracted direction, against the facet
};

// What facets reflect and let through, by the cosine of wo against them.
LANCER_LANE WideResponse facet_response(const WideTerm &term, F cos_i) {
  const F zero(0.0f), one(1.0f);
  WideResponse r{{one, one, one}, {zero, zero, zero}, zero};
  if (any(term.schlick | term.dielectric)) {
    const WideFresnel boundary = fresnel_dielectric(cos_i, term.ior);
    const F along = clamp01((boundary.reflectance - term.lowest) * term.per_range);
    const V3 curve = (term.f0 + (term.f90 - term.f0) * along) * term.reflection;
    r.reflected = select(term.schlick, curve, select(term.dielectric, boundary.reflectance * term.reflection, r.reflected));
    // Nothing goes through where the boundary reflects totally.
    r.cos_t = boundary.cos_t;
    if (any(term.glass)) {
      const F left = min(boundary.transmittance * term.per_range, one);
      const V3 through = ((V3{one, one, one} - term.f90) + (term.f90 - term.f0) * left) * term.transmission;
      r.through = select(term.glass & (boundary.cos_t > zero), through, r.through);
    }
  }
  if (any(term.f82))
    r.reflected = select(term.f82, fresnel_f82(cos_i, term.f0, term.b), r.reflected);
  return r;
}

// The probability of choosing reflection.
LANCER_LANE F reflected_share(const WideResponse &response) {
  const F zero(0.0f), one(1.0f);
  const V3 &r = response.reflected, &t = response.through;
  const M opaque = black(t);
  const F whole = select(black(r), zero, one);
  if (!any(!opaque))
    return whole;
  const F reflected = r.x + r.y + r.z, through = t.x + t.y + t.z;
  return select(opaque, whole, select(reflected > zero, reflected / (reflected + through), zero));
}

LANCER_LANE F facet_d(const WideTerm &term, const V3 &h) {
  const F x = h.x / term.alpha_x, y = h.y / term.alpha_y, length2 = x * x + y * y + h.z * h.z;
  return F(kInvPi) / (term.alpha_x * term.alpha_y * length2 * length2);
}

// facet_g2() of microfacet_terms.h.
LANCER_LANE F facet_g2(const WideTerm &term, const V3 &wo, const V3 &wi) {
  const F zero(0.0f), z = abs(wi.z), i = ggx_hidden(wi, term.alpha_x, term.alpha_y);
  const F seen = (wo.z + term.hidden) * z + wo.z * i;
  return select(seen > zero, z / seen, zero);
}

LANCER_LANE V3 refraction_half_vector(const V3 &wo, const V3 &wi, F eta) {
  const V3 sum = wo + eta * wi;
  const F length2 = dot(sum, sum), zero(0.0f);
  const V3 h = copysign(F(1.0f) / sqrt(length2), sum.z) * sum;
  return select((length2 > zero) & (length2 < F(__builtin_inff())), h, V3{zero, zero, zero});
}

} // namespace
} // namespace lancer
