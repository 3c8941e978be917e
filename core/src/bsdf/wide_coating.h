// The rough coating for many lanes at once, with the bits of coating.h, beckmann.h and fresnel.h. For kernels only, like
// simd/lanes.h.
#pragma once

#include "bsdf/wide_bsdf.h"
#include "sampling/exponential.h"

namespace lancer {
namespace {

// beckmann_g1() of beckmann_a(), over the cosine.
LANCER_LANE F masked_over_cosine(const V3 &w, F alpha) {
  const F one(1.0f), a = w.z / (alpha * sqrt(w.x * w.x + w.y * w.y));
  const F g1 = min(one, a * (F(3.535f) + F(2.181f) * a) / (one + a * (F(2.276f) + F(2.577f) * a)));
  return select(a < F(1.6f), g1, one) / w.z;
}

// f of coating_eval_pdf() in the lanes of m, where both directions are above the surface; 0 in the others. masked: of wo.
LANCER_LANE F coating_value(const V3 &wo, F masked, const V3 &wi, F alpha, F ior, M m) {
  const F zero(0.0f), alpha2 = alpha * alpha;
  const V3 h = half_vector(wo, wi);
  const F tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z), cos_oh = dot(wo, h);
  m = m & (h.z > zero) & (tan2 <= F(87.0f) * alpha2) & (cos_oh > zero);
  if (!any(m))
    return zero;
  const F sec2 = F(1.0f) + tan2;
  const F d = narrow(exp_within(widen(-tan2 / alpha2))) * sec2 * sec2 * F(kInvPi) / alpha2;
  const F f = F(0.25f) * d * fresnel_dielectric(cos_oh, ior).reflectance * masked * masked_over_cosine(wi, alpha);
  return select(m & (d != zero), f, zero);
}

} // namespace
} // namespace lancer
