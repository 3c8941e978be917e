// Blinn-Phong: f = (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)) (N.H)^n, which reflects all light at normal incidence.
#pragma once

#include <cmath>
#include <numbers>

#include "bsdf/beckmann.h"
#include "bsdf/lobe.h"
#include "bsdf/lobe_value.h"
#include "bsdf/phong.h"
#include "sampling/elementary.h"

namespace lancer {

inline LobeValue blinn_phong_eval_pdf(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &h) {
  const float cos_oh = glm::dot(wo, h);
  if (!(h.z > 0.0f && cos_oh > 0.0f))
    return {};
  // cos^n from tan^2, which keeps its digits near n where the cosine has none.
  const float n = lobe.shininess;
  const float power = n > 0.0f ? exp(-0.5f * n * log1p(tan2_theta(h))) : 1.0f;
  const float f = (n + 2.0f) * (0.125f * kInvPi) * ((n + 4.0f) / (exp(-0.5f * std::numbers::ln2_v<float> * n) + n)) * power;
  // Half vectors of density (n + 1) / (2 pi) cos^n become directions of density / (4 wo.h), which a float cannot hold where
  // both directions are opposite along the horizon.
  const float pdf = (n + 1.0f) * (0.125f * kInvPi) * power / cos_oh;
  return std::isfinite(pdf) ? LobeValue{f, pdf} : LobeValue{};
}

inline LobeDirection blinn_phong_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  const glm::vec3 h = sample_cosine_power(lobe.shininess, u);
  return {reflect_about(wo, h), h};
}

} // namespace lancer
