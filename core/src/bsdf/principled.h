// Principled's two forms, and what of the layered one can be made ahead.
#pragma once

#include <algorithm>
#include <optional>

#include "bsdf/build.h"
#include "bsdf/microfacet.h"

namespace lancer {

// Layers and shares smaller than this are not there, as in Cycles.
inline constexpr float kLeastLayer = 1e-5f;

inline float unit(float x) { return std::clamp(x, 0.0f, 1.0f); }
inline glm::vec3 unit(const glm::vec3 &x) { return glm::clamp(x, 0.0f, 1.0f); }

// Both roughnesses that all lobes of the base share.
struct Grain {
  float alpha_x = 0.0f, alpha_y = 0.0f;
  bool stretched = false; // along the turned tangent
};
inline Grain grain_of(const LobeInputs &lobe, float roughness, float anisotropic) {
  const float alpha = roughness * roughness;
  if (!(anisotropic > 0.0f) || lobe.tangent == glm::vec3(0.0f))
    return {alpha, alpha, false};
  const float aspect = std::sqrt(std::max(0.0f, 1.0f - 0.9f * anisotropic));
  return {unit(alpha / aspect), alpha * aspect, true};
}

inline float cos_in(const Bsdf &bsdf, uint8_t frame) { return std::max(0.0f, bsdf.wo_local[frame].z); }

// The sides of the surface that a plan is for.
enum class Sides { Outside, Inside, Both };

// The layers of Blender 4 and newer, as far as neither wo nor what lies above changes them. A layer that is not there is
// planned where it is needed.
struct LayerPlan {
  std::optional<MicrofacetPlan> coat, metal, glass[2], gloss; // glass: from outside, from inside

  // Nothing lies above the diffuse base, and nothing shines below.
  bool only_diffuse(const PrincipledInputs &in) const {
    return !coat && !metal && !glass[0] && !glass[1] && !gloss && !(in.sheen > kLeastLayer) && in.emission == glm::vec3(0.0f);
  }
};
// What is kept already is left out.
LayerPlan plan_layers(const LobeInputs &lobe, const PrincipledInputs &in, Sides sides, const LayerPlan &kept = {});
// For plans that are looked at many times.
void keep_rows(LayerPlan &plan);
void add_layers(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &in, const LayerPlan &kept);

// Blender 3.
void add_sum3(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &in);

} // namespace lancer
