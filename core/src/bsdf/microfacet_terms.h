// Evaluation and sampling of Microfacet lobes, in the lobe's frame with wo.z > 0. Values are f |cos(wi)| without the colour.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/beckmann.h"
#include "bsdf/ggx.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_fresnel.h"
#include "sampling/elementary.h"

namespace lancer {

// Closer to 1 than this the index bends nothing, as in Cycles.
inline constexpr float kStraightIor = 1e-4f;

// A direction drawn. delta: single, with the weight of the lobe over the probability of the choice.
struct MicrofacetDirection {
  glm::vec3 wi{0.0f};
  glm::vec3 h{0.0f};
  bool delta = false;
  glm::vec3 weight{0.0f};
  float probability = 0.0f;
};

// The same for Beckmann by Walter's rational fit of Lambda, as Cycles has it: exactly 0 for small slopes.
inline float beckmann_hidden(const glm::vec3 &w, float alpha_x, float alpha_y) {
  const float along = squeezed(w, alpha_x, alpha_y), a = std::abs(w.z) / along;
  if (!(a * a * 0.39f <= 1.0f))
    return 0.0f;
  return along * std::max(0.0f, (1.0f + a * (0.396f * a - 1.259f)) / (3.535f + 2.181f * a));
}

inline float facet_hidden(const Lobe &lobe, const glm::vec3 &w) {
  return lobe.beckmann ? beckmann_hidden(w, lobe.alpha_x, lobe.alpha_y) : ggx_hidden(w, lobe.alpha_x, lobe.alpha_y);
}

inline float facet_d(const Lobe &lobe, const glm::vec3 &h) {
  if (!lobe.beckmann)
    return ggx_d(h, lobe.alpha_x, lobe.alpha_y);
  const float x = h.x / lobe.alpha_x, y = h.y / lobe.alpha_y, z2 = h.z * h.z, exponent = (x * x + y * y) / z2;
  // Beyond exp(-87) of the top a float holds 0.
  return exponent <= 87.0f ? exp(-exponent) * kInvPi / (lobe.alpha_x * lobe.alpha_y * z2 * z2) : 0.0f;
}

// The share of the facets of Beckmann that w sees, exactly.
inline float beckmann_seen(const Lobe &lobe, const glm::vec3 &w) {
  return beckmann_g1_exact(std::abs(w.z) / squeezed(w, lobe.alpha_x, lobe.alpha_y));
}

// G1 / wo.z, exact, as the density of the sampler needs it.
inline float facet_g1(const Lobe &lobe, const glm::vec3 &wo) {
  return lobe.beckmann ? beckmann_seen(lobe, wo) / wo.z : 1.0f / (wo.z + ggx_hidden(wo, lobe.alpha_x, lobe.alpha_y));
}

// G2 / wo.z: masking and shadowing, correlated by height from Blender 4.0 on, of each direction by itself before.
inline float facet_g2(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  const float o = facet_hidden(lobe, wo), i = facet_hidden(lobe, wi), z = std::abs(wi.z);
  const float seen = lobe.rules == Rules::Blender3 ? (wo.z + o) * (z + i) : (wo.z + o) * z + wo.z * i;
  const float both = seen > 0.0f ? z / seen : 0.0f;
  // By Cycles' fit both directions may see up to 0.3 % more of the facets than one does: more light than came.
  return lobe.beckmann ? std::min(both, std::min(beckmann_seen(lobe, wo), beckmann_seen(lobe, wi)) / wo.z) : both;
}

inline ColorValue microfacet_eval_reflected(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi, const glm::vec3 &h) {
  const float cos_oh = glm::dot(wo, h);
  if (!reflects(lobe) || !(h.z > 0.0f && cos_oh > 0.0f))
    return {};
  const float d = facet_d(lobe, h);
  if (d == 0.0f)
    return {};
  const FacetResponse response = facet_response(lobe, cos_oh);
  // Visible normals of density G1 (wo.h) D / wo.z become directions of density / (4 wo.h).
  const float common = 0.25f * d;
  return {response.reflected * (lobe.energy * common * facet_g2(lobe, wo, wi)),
          response.reflected_share() * common * facet_g1(lobe, wo)};
}

// The facet that bends wo into wi, turned to the side of n; eta: index beyond over index before. The zero vector where the
// directions do not say.
inline glm::vec3 refraction_half_vector(const glm::vec3 &wo, const glm::vec3 &wi, float eta) {
  const glm::vec3 sum = wo + eta * wi;
  const float length2 = glm::dot(sum, sum);
  if (!(length2 > 0.0f && std::isfinite(length2)))
    return glm::vec3(0.0f);
  return std::copysign(1.0f / std::sqrt(length2), sum.z) * sum;
}

// any_sides: also where both directions lie on one side of h, as no facet sends light; see Bsdf::eval_lit.
inline ColorValue microfacet_eval_through(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi, const glm::vec3 &h,
                                          bool any_sides = false) {
  const float cos_oh = glm::dot(wo, h), cos_ih = glm::dot(wi, h);
  if (!refracts(lobe) || lobe.delta_through || !(wo.z > 0.0f && h.z > 0.0f))
    return {};
  // A facet has both directions on its two sides.
  if (!any_sides && !(cos_oh > 0.0f && cos_ih < 0.0f))
    return {};
  const float d = facet_d(lobe, h);
  if (d == 0.0f)
    return {};
  const FacetResponse response = facet_response(lobe, std::abs(cos_oh));
  // Solid angle of normals per solid angle of wi: eta^2 |wi.h| / (wo.h + eta wi.h)^2.
  const float stretch = cos_oh / lobe.ior + cos_ih;
  const float common = d * std::abs(cos_oh * cos_ih) / (stretch * stretch);
  if (!std::isfinite(common))
    return {};
  return {response.through * (lobe.energy * common * facet_g2(lobe, wo, wi)),
          (1.0f - response.reflected_share()) * common * facet_g1(lobe, wo)};
}

// wo bent at a facet: wi = (wo.h / eta - cos_t) h - wo / eta.
inline glm::vec3 refract_about(const glm::vec3 &wo, const glm::vec3 &h, float eta, float cos_t) {
  if (eta == 1.0f)
    return -wo;
  return glm::normalize((glm::dot(wo, h) / eta - cos_t) * h - wo / eta);
}

// A smooth surface: one or two single directions.
inline MicrofacetDirection microfacet_sample_smooth(const Lobe &lobe, const glm::vec3 &wo, float u_side) {
  const FacetResponse response = facet_response(lobe, wo.z);
  if (response.black())
    return {};
  const float reflected = response.reflected_share();
  MicrofacetDirection result;
  result.delta = true;
  if (u_side < reflected) {
    result.wi = reflect_local(wo);
    result.weight = response.reflected * (lobe.energy / reflected);
    result.probability = reflected;
  } else {
    result.wi = lobe.ior == 1.0f ? -wo : refract_local(wo, lobe.ior, response.cos_t);
    result.weight = response.through * (lobe.energy / (1.0f - reflected));
    result.probability = 1.0f - reflected;
  }
  return result;
}

// wi = 0: no sample.
inline MicrofacetDirection microfacet_sample(const Lobe &lobe, const glm::vec3 &wo, float u_side, glm::vec2 u) {
  MicrofacetDirection result;
  const glm::vec3 h = lobe.beckmann ? beckmann_sample_visible(wo, lobe.alpha_x, lobe.alpha_y, u)
                                    : ggx_sample_visible(wo, lobe.alpha_x, lobe.alpha_y, u);
  // Where nothing goes through there is no choice, and what is reflected is weighed later.
  if (!refracts(lobe)) {
    result.h = h;
    result.wi = reflect_about(wo, h);
    return result.wi.z > 0.0f ? result : MicrofacetDirection{};
  }
  // Choose the side at the facet that was drawn, by what it sends there.
  const FacetResponse response = facet_response(lobe, glm::dot(wo, h));
  if (response.black())
    return {};
  const float reflected = response.reflected_share();
  result.h = h;
  if (u_side < reflected) {
    result.wi = reflect_about(wo, h);
    // Seen again from below: shadowed, one bounce is all that is followed.
    return result.wi.z > 0.0f ? result : MicrofacetDirection{};
  }
  result.wi = refract_about(wo, h, lobe.ior, response.cos_t);
  if (!(result.wi.z < 0.0f))
    return {};
  if (lobe.delta_through) {
    result.delta = true;
    result.probability = 1.0f - reflected;
    // Where nothing is bent nothing is shadowed either, in Cycles.
    const bool straight = std::abs(lobe.ior - 1.0f) < kStraightIor;
    const float shadowing = straight ? 1.0f : facet_g2(lobe, wo, result.wi) / facet_g1(lobe, wo);
    result.weight = response.through * (lobe.energy * shadowing / (1.0f - reflected));
  }
  return result;
}

} // namespace lancer
