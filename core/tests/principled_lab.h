// Principled for tests: described briefly, seen from wo above or below the plane z = 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "bsdf/principled.h"
#include "bsdf_seen.h"

namespace lancer::testing {

inline constexpr Rules kAllRules[] = {Rules::Blender3, Rules::Blender4, Rules::Blender45, Rules::Blender50, Rules::Blender52};

inline PrincipledInputs<float> plain(Rules rules) {
  PrincipledInputs<float> in;
  in.rules = rules;
  in.base_color = {0.8f, 0.5f, 0.2f};
  if (rules == Rules::Blender3) {
    in.distribution = Facets::Ggx;
    in.specular_tint = in.sheen_tint = glm::vec3(0.0f);
  }
  return in;
}

inline void look(Bsdf<float> &bsdf, const PrincipledInputs<float> &in, const glm::vec3 &wo,
                 const glm::vec3 &weight = glm::vec3(1.0f)) {
  const bool inside = wo.z < 0.0f;
  const glm::vec3 n(0.0f, 0.0f, inside ? -1.0f : 1.0f);
  bsdf.begin(wo, n, n, inside, true);
  LobeInputs<float> lobe = described(LobeKind::Principled);
  lobe.rules = in.rules;
  lobe.weight = weight;
  lobe.tangent = {1.0f, 0.0f, 0.0f};
  add_principled(bsdf, lobe, in);
  bsdf.complete();
}

inline glm::vec3 value(const PrincipledInputs<float> &in, const glm::vec3 &wo, const glm::vec3 &wi,
                       const glm::vec3 &weight = glm::vec3(1.0f)) {
  Bsdf<float> bsdf;
  look(bsdf, in, wo, weight);
  return bsdf.eval(wi).f();
}

inline glm::vec3 emitted(const PrincipledInputs<float> &in, const glm::vec3 &wo) {
  Bsdf<float> bsdf;
  look(bsdf, in, wo);
  return bsdf.emission;
}

inline void expect_near(const glm::vec3 &a, const glm::vec3 &b, float relative, const char *what) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(a[i], b[i], relative * std::max(std::abs(a[i]), std::abs(b[i]))) << what << " channel " << i;
}

// A few dozen float roundings.
inline constexpr float kRounding = 4e-6f;

} // namespace lancer::testing
