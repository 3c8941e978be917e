// Evaluation and sampling of Microfacet lobes, in the lobe's frame with wo.z > 0. Values are f |cos(wi)| without the colour.
#pragma once

#include "bsdf/beckmann.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "sampling/warp.h"
#include "simd/vectors.h"

namespace lancer {

// The GGX distribution of microfacets, anisotropic along the frame's axes: density, masking, sampling of visible normals.

// D: density of microfacet normals per solid angle. A sum of squares loses no digit for small roughness.
template <class F> LANCER_LANE F ggx_d(const Vec3<F> &h, F alpha_x, F alpha_y) {
  const F x = h.x / alpha_x, y = h.y / alpha_y, length2 = x * x + y * y + h.z * h.z;
  return kInvPi / (alpha_x * alpha_y * length2 * length2);
}

// Returns the area of facets hidden from w: Smith's Lambda times |cos|, finite at grazing angles.
template <class F> LANCER_LANE F ggx_hidden(const Vec3<F> &w, F alpha_x, F alpha_y) {
  const F along = squeezed(w, alpha_x, alpha_y), z = abs(w.z);
  const F all = z + sqrt(z * z + along * along);
  return select(all > 0.0f, 0.5f * along * (along / all), F(0.0f));
}

// Samples a normal h visible from wo (wo.z > 0), density G1(wo) max(0, wo.h) D(h) / wo.z. Dupuy and Benyoub 2023: reflected at
// facets of roughness 1, a view is uniform on a spherical cap.
template <class F> LANCER_LANE Vec3<F> ggx_sample_visible(const Vec3<F> &wo, F alpha_x, F alpha_y, F u, F v) {
  const Vec3<F> w = normalize(Vec3<F>(alpha_x * wo.x, alpha_y * wo.y, wo.z));
  // Use 1 - cos of the angle on the cap, which keeps the digits near its apex.
  const F s = u * (1.0f + w.z);
  const F sin_theta = sqrt(max(F(0.0f), s * (2.0f - s)));
  const SinCos<F> phi = sin_cos_turn(v);
  const Vec3<F> h(sin_theta * phi.cos + w.x, sin_theta * phi.sin + w.y, (1.0f - u) * (1.0f + w.z));
  return normalize(Vec3<F>(alpha_x * h.x, alpha_y * h.y, h.z));
}

// An index closer to 1 than this does not bend light, as in Cycles.
inline constexpr float kStraightIor = 1e-4f;

template <class F> LANCER_LANE F facet_hidden(const Lobe<F> &lobe, const Vec3<F> &w) {
  return lobe.beckmann ? beckmann_hidden(w, lobe.alpha_x, lobe.alpha_y) : ggx_hidden(w, lobe.alpha_x, lobe.alpha_y);
}

template <class F> LANCER_LANE F facet_d(const Lobe<F> &lobe, const Vec3<F> &h) {
  return lobe.beckmann ? beckmann_d(h, lobe.alpha_x, lobe.alpha_y) : ggx_d(h, lobe.alpha_x, lobe.alpha_y);
}

// Returns the exact visible share of Beckmann's facets from w.
template <class F> LANCER_LANE F beckmann_seen(const Lobe<F> &lobe, const Vec3<F> &w) {
  return beckmann_g1_exact(abs(w.z) / squeezed(w, lobe.alpha_x, lobe.alpha_y));
}

// Returns the exact G1 / wo.z, for the density of the sampler; hidden: of wo.
template <class F> LANCER_LANE F facet_g1(const Lobe<F> &lobe, const Vec3<F> &wo, F hidden) {
  return lobe.beckmann ? beckmann_seen(lobe, wo) / wo.z : 1.0f / (wo.z + hidden);
}

// Returns G2 / wo.z: masking and shadowing, height-correlated from Blender 4.0 on, separable before.
template <class F> LANCER_LANE F facet_g2(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F o = lobe.hidden, i = facet_hidden(lobe, wi), z = abs(wi.z);
  const F seen = lobe.rules == Rules::Blender3 ? (wo.z + o) * (z + i) : (wo.z + o) * z + wo.z * i;
  const F both = select(seen > 0.0f, z / seen, F(0.0f));
  if (!lobe.beckmann)
    return both;
  // By Cycles' fit, the share of facets visible from both directions exceeds the share visible from one of them by up to 0.3 %,
  // which would be a gain of energy.
  return min(both, min(beckmann_seen(lobe, wo), beckmann_seen(lobe, wi)) / wo.z);
}

template <class F>
LANCER_LANE ColorValue<F> microfacet_eval_reflected(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi,
                                                    const Vec3<F> &h) {
  if (!reflects(lobe))
    return {};
  const F cos_oh = dot(wo, h), d = facet_d(lobe, h);
  const auto there = (h.z > 0.0f) & (cos_oh > 0.0f) & (d != F(0.0f));
  if (!any(there))
    return {};
  const FacetResponse<F> response = facet_response(lobe, cos_oh);
  // Visible normals of density G1 (wo.h) D / wo.z become directions of density / (4 wo.h).
  const F common = 0.25f * d;
  return where<F>(there, {response.reflected * (lobe.energy * common * facet_g2(lobe, wo, wi)),
                          response.reflected_share() * common * lobe.g1});
}

// Returns the facet normal that refracts wo into wi, on the side of n; eta: index beyond over index before. Returns the zero
// vector if the directions do not define it.
template <class F> LANCER_LANE Vec3<F> refraction_half_vector(const Vec3<F> &wo, const Vec3<F> &wi, F eta) {
  const Vec3<F> sum = wo + eta * wi;
  const F length2 = dot(sum, sum);
  const auto says = (length2 > 0.0f) & (length2 < __builtin_inff());
  return select(says, copysign(1.0f / sqrt(length2), sum.z) * sum, Vec3<F>(F(0.0f)));
}

// any_sides: also evaluate directions on the same side of h, which no facet connects; see Bsdf::eval_lit.
template <class F>
LANCER_LANE ColorValue<F> microfacet_eval_through(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, const Vec3<F> &h,
                                                  bool any_sides = false) {
  const F zero(0.0f);
  if (!refracts(lobe))
    return {};
  const F cos_oh = dot(wo, h), cos_ih = dot(wi, h);
  const F d = facet_d(lobe, h);
  // Solid angle of normals per solid angle of wi: eta^2 |wi.h| / (wo.h + eta wi.h)^2.
  const F stretch = cos_oh / lobe.ior + cos_ih;
  const F common = d * abs(cos_oh * cos_ih) / (stretch * stretch);
  // The directions must be on opposite sides of the facet.
  auto there = (!lobe.delta_through) & (wo.z > zero) & (h.z > zero) & (d != zero) & (abs(common) < __builtin_inff());
  if (!any_sides)
    there = there & (cos_oh > zero) & (cos_ih < zero);
  if (!any(there))
    return {};
  const FacetResponse<F> response = facet_response(lobe, abs(cos_oh));
  return where<F>(there, {response.through * (lobe.energy * common * facet_g2(lobe, wo, wi)),
                          (1.0f - response.reflected_share()) * common * lobe.g1});
}

// Scatter::Through takes the value of reflection for the direction mirrored at the surface, with its half vector.
template <class F> bool passes_through(const Lobe<F> &lobe) { return lobe.variant == static_cast<uint8_t>(Scatter::Through); }

// A sampled direction. delta: single, with the weight of the lobe over the probability of the choice.
template <class F> struct MicrofacetDirection {
  Vec3<F> wi, weight;
  F probability;
  MaskOf<F> delta, valid;
};

// Samples reflection or refraction at a visible facet h, or at the smooth surface, by their shares.
template <class F>
LANCER_LANE MicrofacetDirection<F> microfacet_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u_side, const Vec3<F> &h) {
  using V = Vec3<F>;
  const F zero(0.0f), one(1.0f), eta = lobe.ior;
  MicrofacetDirection<F> result;
  const V back = select(lobe.delta, reflect_local(wo), reflect_about(wo, h));
  result.delta = lobe.delta;
  result.wi = back;
  result.weight = V(zero);
  result.probability = one;
  result.valid = back.z > zero;
  // Without refraction there is no choice, and a reflected direction is weighted later.
  if (!refracts(lobe) && !any(lobe.delta))
    return result;
  const F cos_oh = select(lobe.delta, wo.z, dot(wo, h));
  const FacetResponse<F> response = facet_response(lobe, cos_oh);
  const F share = response.reflected_share(), rest = 1.0f - share;
  const MaskOf<F> choice = uniform<F>(refracts(lobe)) | lobe.delta, reflected = (u_side < share) | !choice;
  result.weight = response.reflected * (lobe.energy / share);
  result.probability = share;
  if (any(!reflected)) {
    // Refract wo at the facet: wi = (wo.h / eta - cos_t) h - wo / eta. Cycles omits shadowing if light is not bent.
    const V at_facet = (cos_oh / eta - response.cos_t) * h - wo / eta;
    const V at_surface(-wo.x / eta, -wo.y / eta, -response.cos_t);
    const V through = select(eta == one, -wo, normalize(select(lobe.delta, at_surface, at_facet)));
    const MaskOf<F> straight = lobe.delta | (abs(eta - 1.0f) < kStraightIor);
    const F shadowing = select(straight, one, facet_g2(lobe, wo, through) / lobe.g1);
    result.wi = select(reflected, back, through);
    result.weight = select(reflected, result.weight, response.through * (lobe.energy * shadowing / rest));
    result.probability = select(reflected, share, rest);
    result.delta = lobe.delta | (lobe.delta_through & !reflected);
  }
  // A direction on the wrong side is shadowed; only single scattering is followed.
  const MaskOf<F> right = ((result.wi.z > zero) & reflected) | ((result.wi.z < zero) & !reflected);
  result.valid = select(choice, right & !response.is_black(), result.valid);
  return result;
}

} // namespace lancer
