// The rough coating: f = D F G / (4 (l.n)(v.n)) with Beckmann's D, exact Fresnel F and Smith's G = G1(l) G1(v).
#pragma once

#include <cmath>

#include "bsdf/beckmann.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"

namespace lancer {

// Below this roughness a float half vector cannot tell directions of the lobe apart: it is a mirror weighted with F.
inline constexpr float kMirrorAlpha = 2e-5f;

inline LobeValue coating_eval_pdf(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi, const glm::vec3 &h) {
  if (!(h.z > 0.0f))
    return {};
  const float d = beckmann_d(tan2_theta(h), lobe.alpha_x);
  if (d == 0.0f)
    return {};
  const float cos_oh = glm::dot(wo, h);
  if (!(cos_oh > 0.0f))
    return {};
  // Each G1 is divided by its cosine at once: both vanish together at the horizon. Visible normals of density
  // G1 (wo.h) D / wo.z become directions of density / (4 wo.h), so that wo.h cancels.
  const float a_o = beckmann_a(wo, lobe.alpha_x), a_i = beckmann_a(wi, lobe.alpha_x);
  const float f = 0.25f * d * fresnel_dielectric(cos_oh, lobe.ior) * (beckmann_g1(a_o) / wo.z) * (beckmann_g1(a_i) / wi.z);
  return {f, 0.25f * d * (beckmann_g1_exact(a_o) / wo.z)};
}

inline LobeDirection coating_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  const glm::vec3 h = beckmann_sample_visible(wo, lobe.alpha_x, lobe.alpha_x, u);
  return {reflect_about(wo, h), h};
}

// About the share of light that the lobe reflects for wo: Fresnel at n, and at a facet that leans away by the roughness.
// Never 0 unless F is 0 for every direction (ior = 1).
inline float coating_albedo_estimate(const Lobe &lobe, const glm::vec3 &wo) {
  const float leaning = wo.z / std::sqrt(1.0f + lobe.alpha_x * lobe.alpha_x);
  return 0.75f * fresnel_dielectric(wo.z, lobe.ior) + 0.25f * fresnel_dielectric(leaning, lobe.ior);
}

} // namespace lancer
