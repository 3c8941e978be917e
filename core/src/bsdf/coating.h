// The rough coating: f = D F G / (4 (l.n)(v.n)) with Beckmann's D, exact Fresnel F and Smith's G = G1(l) G1(v).
#pragma once

#include "bsdf/beckmann.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"

namespace lancer {

// Below this roughness a float half vector cannot tell directions of the lobe apart: it is a mirror weighted with F.
inline constexpr float kMirrorAlpha = 2e-5f;

// D, where the half vector is one of a reflection.
template <class F> LANCER_LANE F coating_d(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &h) {
  return select((h.z > 0.0f) & (dot(wo, h) > 0.0f), beckmann_d(tan2_theta(h), lobe.alpha_x), F(0.0f));
}

// f; d: coating_d().
template <class F>
LANCER_LANE F coating_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, const Vec3<F> &h, F d) {
  // Each G1 is divided by its cosine at once: both vanish together at the horizon.
  const F a_o = beckmann_a(wo, lobe.alpha_x), a_i = beckmann_a(wi, lobe.alpha_x);
  const F reflectance = fresnel_dielectric(dot(wo, h), lobe.ior);
  return select(d != F(0.0f), 0.25f * d * reflectance * (beckmann_g1(a_o) / wo.z) * (beckmann_g1(a_i) / wi.z), F(0.0f));
}

template <class F>
LANCER_LANE LobeValue<F> coating_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, const Vec3<F> &h) {
  const F d = coating_d(lobe, wo, h);
  const auto there = d != F(0.0f);
  if (!any(there))
    return {};
  // Visible normals of density G1 (wo.h) D / wo.z become directions of density / (4 wo.h), so that wo.h cancels.
  const F seen = beckmann_g1_exact(beckmann_a(wo, lobe.alpha_x)) / wo.z;
  return where<F>(there, LobeValue<F>{coating_eval(lobe, wo, wi, h, d), 0.25f * d * seen});
}

// About the share of light that the lobe reflects for wo: Fresnel at n, and at a facet that leans away by the roughness.
// Never 0 unless F is 0 for every direction (ior = 1).
template <class F> LANCER_LANE F coating_albedo_estimate(const Lobe<F> &lobe, const Vec3<F> &wo) {
  const F leaning = wo.z / sqrt(1.0f + lobe.alpha_x * lobe.alpha_x);
  return 0.75f * fresnel_dielectric(wo.z, lobe.ior) + 0.25f * fresnel_dielectric(leaning, lobe.ior);
}

} // namespace lancer
