// Modified Phong: f = (n + 2) / (2 pi) max(0, R.V)^n around the mirrored direction R, n the shininess.
#pragma once

#include <cmath>

#include "bsdf/frame.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"

namespace lancer {

// A direction around +z with density (n + 1) / (2 pi) cos^n: 1 - cos comes from expm1, which keeps narrow lobes apart.
inline glm::vec3 sample_cosine_power(float n, glm::vec2 u) {
  const float x = -expm1(log1p(-u.x) / (n + 1.0f));
  const float sin_theta = std::sqrt(x * (2.0f - x));
  const SinCos phi = sin_cos_turn(u.y);
  return {sin_theta * phi.cos, sin_theta * phi.sin, 1.0f - x};
}

inline LobeValue phong_eval_pdf(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  // 1 - R.V from the distance of both: near the peak a cosine has no digits left for the power.
  const glm::vec3 difference = reflect_local(wo) - wi;
  const float one_minus_cos = 0.5f * glm::dot(difference, difference);
  if (!(one_minus_cos < 1.0f))
    return {};
  const float n = lobe.shininess;
  const float power = exp(n * log1p(-one_minus_cos)) * (0.5f * kInvPi);
  return {(n + 2.0f) * power, (n + 1.0f) * power};
}

inline LobeDirection phong_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  const Frame around_mirror(reflect_local(wo));
  const glm::vec3 wi = around_mirror.to_world(sample_cosine_power(lobe.shininess, u));
  return {wi, half_vector(wo, wi)};
}

} // namespace lancer
