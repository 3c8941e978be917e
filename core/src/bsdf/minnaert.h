// Minnaert: f = (k + 1) / (2 pi) (cos_i cos_o)^(k - 1), the reciprocal law of limb darkening (Minnaert 1941; scaled as the
// diffuse lobe of Lafortune et al. 1997), k = Lobe::shininess. k = 1 is Lambert; above, the rim is darker; below, brighter.
//
// Energy: the albedo of colour rho is rho cos_o^(k - 1): rho from straight above, and for k < 1 more than 1 towards the
// horizon. So no cosine counts as less than m = rho^(1 / (1 - k)), at which that albedo is 1; rho is the colour's largest
// channel. With
//   c = max(cos, m) in both powers, and A = integral of c_i^(k - 1) cos_i = 2 pi ((1 - m^(k+1)) / (k + 1) + m^(k+1) / 2),
//   f = (c_i c_o)^(k - 1) / A, albedo rho c_o^(k - 1) <= 1, equal to rho at c_o = 1.
// f stays reciprocal, is the plain law where m vanishes (k >= 1, or a dark colour), and Lambert for k < 1 and white.
#pragma once

#include "bsdf/beckmann.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"
#include "bsdf/phong.h"

namespace lancer {

// No logarithm of a cosine is less: powers of two of them stay within a float.
inline constexpr float kLowestLogCosine = -40.0f;

// log max(cos, m), from the tangent, which keeps its digits near the normal; behind the surface as on the horizon.
template <class F> LANCER_LANE F minnaert_log_cosine(const Lobe<F> &lobe, const Vec3<F> &w) {
  return select(w.z > 0.0f, max(-0.5f * log1p(tan2_theta(w)), lobe.alpha_x), lobe.alpha_x);
}

// (cos of w)^(k - 1), bounded.
template <class F> LANCER_LANE F minnaert_power(const Lobe<F> &lobe, const Vec3<F> &w) {
  return exp((lobe.shininess - 1.0f) * minnaert_log_cosine(lobe, w));
}

// The parts of A / (2 pi) above m and below it.
template <class F> struct MinnaertParts { F above, below; };
template <class F> LANCER_LANE MinnaertParts<F> minnaert_parts(const Lobe<F> &lobe) {
  const F exponent = (lobe.shininess + 1.0f) * lobe.alpha_x; // of m^(k + 1)
  return {-expm1(exponent) / (lobe.shininess + 1.0f), 0.5f * exp(exponent)};
}

// lobe: its colour and k are set; alpha_x becomes log m, alpha_y 1 / A, energy what f owes to wo. rho: the largest channel of
// the surface's own colour, without the weights of mixtures.
template <class F> LANCER_LANE void complete_minnaert(Lobe<F> &lobe, F rho, const Vec3<F> &wo) {
  const F k = lobe.shininess, lowest(kLowestLogCosine);
  lobe.alpha_x = select(k < 1.0f, max(log(min(rho, F(1.0f))) / (1.0f - k), lowest), lowest);
  const MinnaertParts<F> parts = minnaert_parts(lobe);
  lobe.alpha_y = 1.0f / (2.0f * kPi * (parts.above + parts.below));
  lobe.energy = minnaert_power(lobe, wo);
  lobe.albedo = lobe.color * lobe.energy;
}

// f cos, and the density of minnaert_sample.
template <class F> LANCER_LANE LobeValue<F> minnaert_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wi) {
  const F pdf = lobe.alpha_y * minnaert_power(lobe, wi) * wi.z;
  return {lobe.energy * pdf, pdf};
}

template <class F> LANCER_LANE Vec3<F> minnaert_sample(const Lobe<F> &lobe, F u, F v) {
  // Above m the share of directions within an angle is 1 - cos^(k + 1), below it the rest falls as sin^2 there.
  const MinnaertParts<F> parts = minnaert_parts(lobe);
  const F inside = u * (parts.above + parts.below);
  const auto high = (inside < parts.above) | (parts.below == F(0.0f));
  const Vec3<F> above = sample_cosine_power(lobe.shininess, min(inside * (lobe.shininess + 1.0f), F(1.0f)), v);
  const F rest = (1.0f - u) * (parts.above + parts.below) / parts.below;
  const F cosine = exp(lobe.alpha_x) * sqrt(min(rest, F(1.0f)));
  const F sine = sqrt((1.0f - cosine) * (1.0f + cosine));
  const SinCos<F> phi = sin_cos_turn(v);
  return select(high, above, Vec3<F>(sine * phi.cos, sine * phi.sin, cosine));
}

} // namespace lancer
