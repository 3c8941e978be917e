// Lobes of microfacets: how they are set up, and what they scatter in all.
//
//   Lobe lobe = make_microfacet(Scatter::Reflect, frame, weight, alpha_x, alpha_y, rules);
//   set_...(lobe, ...);                              one of them: how the facets reflect
//   complete_microfacet(lobe, cos_o, preserving);    then: smoothness, energy, albedo
#pragma once

#include <algorithm>
#include <memory>

#include "bsdf/bsdf.h"

namespace lancer {

struct AlbedoRows;

// Below this product of both roughnesses Cycles takes a lobe for a mirror; ours is a little above it, where float half vectors
// stop telling directions apart (alpha 2e-5).
inline constexpr float kMirrorAlpha2 = 4e-10f;
inline constexpr float kMirrorAlpha2Blender3 = 1e-7f;

// From the roughness of nodes that stay within 0 ... 1.
inline float alpha_of(float roughness) {
  const float within = std::clamp(roughness, 0.0f, 1.0f);
  return within * within;
}

// The lobe reflects all (FresnelKind::None) until one of the following is set.
Lobe make_microfacet(Scatter scatter, uint8_t frame, const glm::vec3 &color, float alpha_x, float alpha_y, Rules rules);

// further: what each further bounce keeps; the node's colour, where color carries it together with other weights.
void set_constant(Lobe &lobe, const glm::vec3 &further);
// ior as seen from wo's side.
void set_dielectric(Lobe &lobe, float ior);
void set_conductor(Lobe &lobe, const glm::vec3 &n, const glm::vec3 &k);
// tint: factor on Schlick's curve at 82 degrees.
void set_f82(Lobe &lobe, const glm::vec3 &f0, const glm::vec3 &tint);
// f0 ... f90 along the curve of the dielectric; ior as seen from wo's side.
void set_schlick(Lobe &lobe, const glm::vec3 &f0, const glm::vec3 &f90, float ior, const glm::vec3 &reflection,
                 const glm::vec3 &transmission);
// f0 ... 1 along the curve of the dielectric, Blender 3.x.
void set_principled3(Lobe &lobe, const glm::vec3 &f0, float ior);

// cos_o: wo.z in the lobe's frame. preserving: gives back the light that single scattering loses (GGX only), with the colour
// that further bounces give it; afterwards color holds that share, too. The albedo is what Cycles takes for it: Fresnel
// averaged over the facets that are seen, or of a smooth surface.
void complete_microfacet(Lobe &lobe, float cos_o, bool preserving);

// The same in two steps, for lobes whose numbers are the same wherever they are met: the plan, then its look from wo.
struct MicrofacetPlan {
  Lobe lobe; // all but color, energy and albedo
  bool preserving = false;
  float roughness = 0.0f;
  glm::vec3 further{1.0f}; // share of the lost light that comes back, by colour
  // Tables along the cosine, where they are worth reading ahead.
  std::shared_ptr<const AlbedoRows> rows;
};
MicrofacetPlan plan_microfacet(const Lobe &lobe, bool preserving);
// Reads the tables ahead: for plans that are looked at many times.
void keep_rows(MicrofacetPlan &plan);
// color: the weight of the lobe.
Lobe seen_from(const MicrofacetPlan &plan, float cos_o, const glm::vec3 &color);

// The index above 1 whose reflectance at the normal is f0; Cycles ends at 0.99. f0_of_ior is in microfacet_fresnel.h.
float ior_of_f0(float f0);

// Adds a lobe unless it is black or no room is left; the lobe's albedo is there already.
void add(Bsdf &bsdf, const Lobe &lobe);

} // namespace lancer
