// Two lobes of a power of a cosine, n the shininess. Modified Phong: f = (n + 2) / (2 pi) max(0, R.V)^n around the mirrored
// direction R. Blinn-Phong: f = (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)) (N.H)^n, which reflects all light at normal incidence.
#pragma once

#include <numbers>

#include "bsdf/beckmann.h"
#include "bsdf/frame.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"

namespace lancer {

// A direction around +z with density (n + 1) / (2 pi) cos^n: 1 - cos comes from expm1, which keeps narrow lobes apart.
template <class F> LANCER_LANE Vec3<F> sample_cosine_power(F n, F u, F v) {
  const F x = -expm1(log1p(-u) / (n + 1.0f));
  const F sin_theta = sqrt(x * (2.0f - x));
  const SinCos<F> phi = sin_cos_turn(v);
  return {sin_theta * phi.cos, sin_theta * phi.sin, 1.0f - x};
}

template <class F> LANCER_LANE LobeValue<F> phong_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  // 1 - R.V from the distance of both: near the peak a cosine has no digits left for the power.
  const Vec3<F> difference = reflect_local(wo) - wi;
  const F one_minus_cos = 0.5f * dot(difference, difference);
  const auto near = one_minus_cos < 1.0f;
  const F n = lobe.shininess;
  const F power = exp(n * log1p(-one_minus_cos)) * (0.5f * kInvPi);
  return where<F>(near, LobeValue<F>{(n + 2.0f) * power, (n + 1.0f) * power});
}

template <class F> LANCER_LANE Vec3<F> phong_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const Frame<F> around_mirror(reflect_local(wo));
  return around_mirror.to_world(sample_cosine_power(lobe.shininess, u, v));
}

template <class F> LANCER_LANE LobeValue<F> blinn_phong_eval_pdf(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &h) {
  const F cos_oh = dot(wo, h), n = lobe.shininess;
  // cos^n from tan^2, which keeps its digits near n where the cosine has none.
  const F power = select(n > 0.0f, exp(-0.5f * n * log1p(tan2_theta(h))), F(1.0f));
  const F f = (n + 2.0f) * (0.125f * kInvPi) * ((n + 4.0f) / (exp(-0.5f * std::numbers::ln2_v<float> * n) + n)) * power;
  // Half vectors of density (n + 1) / (2 pi) cos^n become directions of density / (4 wo.h), which a float cannot hold where
  // both directions are opposite along the horizon.
  const F pdf = (n + 1.0f) * (0.125f * kInvPi) * power / cos_oh;
  return where<F>((h.z > 0.0f) & (cos_oh > 0.0f) & (abs(pdf) < __builtin_inff()), LobeValue<F>{f, pdf});
}

} // namespace lancer
