// The Principled BSDF of Blender 4 and newer: from the artist's sliders to lobes, layer upon layer.
#include <algorithm>
#include <cmath>

#include "bsdf/fresnel.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_fresnel.h"
#include "bsdf/principled.h"
#include "bsdf/sheen.h"
#include "sampling/elementary.h"

namespace lancer {

namespace {

glm::vec3 positive(const glm::vec3 &x) { return glm::max(x, 0.0f); }

// What a layer leaves for those below it: one factor for all colours, by the channel that it takes most of.
glm::vec3 below(const glm::vec3 &weight, const glm::vec3 &albedo) {
  float taken = 0.0f;
  for (int i = 0; i < 3; ++i)
    if (weight[i] != 0.0f)
      taken = std::max(taken, albedo[i] / weight[i]);
  return weight * unit(1.0f - taken);
}

// The light that a coat's colour lets pass on a slanted way down: Beer's law over 1/cos of the refracted direction.
glm::vec3 through_coat(const glm::vec3 &tint, float cos_o, float ior, float coat) {
  const float sin = std::sqrt(std::max(0.0f, (1.0f - cos_o) * (1.0f + cos_o))) / ior;
  const float depth = 1.0f / std::sqrt((1.0f - sin) * (1.0f + sin));
  return glm::mix(glm::vec3(1.0f), glm::vec3(pow(tint.x, depth), pow(tint.y, depth), pow(tint.z, depth)), coat);
}

Grain base_grain(const LobeInputs &lobe, const PrincipledInputs &in) {
  return grain_of(lobe, unit(in.roughness), unit(in.anisotropic));
}

MicrofacetPlan plan_coat(const PrincipledInputs &in) {
  const float alpha = alpha_of(in.coat_roughness);
  Lobe lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), alpha, alpha, in.rules);
  set_dielectric(lobe, std::max(in.coat_ior, 1.0f));
  // From Blender 4.5 on it keeps all its light.
  return plan_microfacet(lobe, in.rules == Rules::Blender45);
}

MicrofacetPlan plan_metal(const PrincipledInputs &in, const Grain &grain) {
  Lobe lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), grain.alpha_x, grain.alpha_y, in.rules);
  set_f82(lobe, unit(positive(in.base_color)), unit(positive(in.specular_tint)));
  return plan_microfacet(lobe, in.distribution == Facets::MultiGgx);
}

MicrofacetPlan plan_glass(const PrincipledInputs &in, bool inside) {
  const float alpha = alpha_of(in.roughness), ior = std::max(in.ior, 1e-5f);
  Lobe lobe = make_microfacet(Scatter::Both, 0, glm::vec3(1.0f), alpha, alpha, in.rules);
  set_schlick(lobe, unit(f0_of_ior(ior) * positive(in.specular_tint)), glm::vec3(1.0f), inside ? 1.0f / ior : ior,
              glm::vec3(1.0f), glm::sqrt(unit(positive(in.base_color))));
  return plan_microfacet(lobe, in.distribution == Facets::MultiGgx);
}

// Nothing where the surface bends no light.
std::optional<MicrofacetPlan> plan_gloss(const PrincipledInputs &in, const Grain &grain) {
  // The plastic's index bends with the artist's level, on its own side of 1.
  const float ior = std::max(in.ior, 1e-5f);
  float eta = ior, f0 = f0_of_ior(ior);
  if (in.specular != 0.5f) {
    f0 *= 2.0f * std::max(in.specular, 0.0f);
    eta = ior_of_f0(f0);
    if (ior < 1.0f)
      eta = 1.0f / eta;
  }
  if (eta == 1.0f)
    return {};
  Lobe lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), grain.alpha_x, grain.alpha_y, in.rules);
  set_schlick(lobe, unit(f0 * positive(in.specular_tint)), glm::vec3(1.0f), eta, glm::vec3(1.0f), glm::vec3(0.0f));
  return plan_microfacet(lobe, in.distribution == Facets::MultiGgx);
}

Lobe placed(const MicrofacetPlan &plan, const Bsdf &bsdf, uint8_t frame, const glm::vec3 &weight) {
  Lobe lobe = seen_from(plan, cos_in(bsdf, frame), weight);
  lobe.frame = frame;
  return lobe;
}

} // namespace

LayerPlan plan_layers(const LobeInputs &lobe, const PrincipledInputs &in, Sides sides, const LayerPlan &kept) {
  LayerPlan plan;
  const Grain grain = base_grain(lobe, in);
  const float metallic = unit(in.metallic), transmission = unit(in.transmission);
  if (in.coat > kLeastLayer && !kept.coat)
    plan.coat = plan_coat(in);
  if (metallic > kLeastLayer && !kept.metal)
    plan.metal = plan_metal(in, grain);
  if (metallic < 1.0f && transmission > kLeastLayer)
    for (const bool inside : {false, true})
      if (!kept.glass[inside] && (sides == Sides::Both || inside == (sides == Sides::Inside)))
        plan.glass[inside] = plan_glass(in, inside);
  if (metallic < 1.0f && transmission < 1.0f && !kept.gloss)
    plan.gloss = plan_gloss(in, grain);
  return plan;
}

void keep_rows(LayerPlan &plan) {
  for (std::optional<MicrofacetPlan> *layer : {&plan.coat, &plan.metal, &plan.glass[0], &plan.glass[1], &plan.gloss})
    if (*layer)
      keep_rows(**layer);
}

void add_layers(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &in, const LayerPlan &kept) {
  const LayerPlan planned = plan_layers(lobe, in, bsdf.inside ? Sides::Inside : Sides::Outside, kept);
  const auto layer = [](const std::optional<MicrofacetPlan> &first, const std::optional<MicrofacetPlan> &second) {
    return first ? &*first : second ? &*second : nullptr;
  };
  const glm::vec3 n = normal_or_shading(bsdf, lobe.normal), n_reflect = reflecting_normal(bsdf, lobe.normal);
  const glm::vec3 n_coat = normal_or_shading(bsdf, in.coat_normal);
  const glm::vec3 color = positive(in.base_color);
  glm::vec3 weight = lobe.weight;

  // Cloth on top of all, its normal between the base's and the coat's.
  if (in.sheen > kLeastLayer) {
    const glm::vec3 n_cloth = n_coat == n ? n : glm::mix(n, n_coat, unit(in.coat));
    const uint8_t frame = add_frame(bsdf, n_cloth, glm::vec3(0.0f));
    Lobe sheen = make_sheen(in.sheen * positive(in.sheen_tint) * weight, unit(in.sheen_roughness), cos_in(bsdf, frame));
    sheen.frame = frame;
    sheen.rules = in.rules;
    add(bsdf, sheen);
    weight = below(weight, sheen.albedo);
  }

  // The coat reflects, and colours what passes it twice.
  if (in.coat > kLeastLayer) {
    const MicrofacetPlan *coat = layer(kept.coat, planned.coat);
    const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, n_coat), glm::vec3(0.0f));
    const Lobe reflection = placed(*coat, bsdf, frame, in.coat * weight);
    add(bsdf, reflection);
    weight = below(weight, reflection.albedo);
    if (in.coat_tint != glm::vec3(1.0f))
      weight *= through_coat(positive(in.coat_tint), cos_in(bsdf, frame), coat->lobe.ior, in.coat);
  }

  bsdf.emission += in.emission * weight;

  // Metal, glass and plastic share what is left.
  const bool stretched = base_grain(lobe, in).stretched;
  const glm::vec3 tangent = stretched ? turn_about(lobe.tangent, n, in.anisotropic_rotation) : glm::vec3(0.0f);
  const uint8_t frame = add_frame(bsdf, n_reflect, tangent);
  const float metallic = unit(in.metallic), transmission = unit(in.transmission);
  if (metallic > kLeastLayer) {
    add(bsdf, placed(*layer(kept.metal, planned.metal), bsdf, frame, metallic * weight));
    weight *= 1.0f - metallic;
  }
  if (metallic < 1.0f && transmission > kLeastLayer) {
    add(bsdf, placed(*layer(kept.glass[bsdf.inside], planned.glass[bsdf.inside]), bsdf, frame, transmission * weight));
    weight *= 1.0f - transmission;
  }
  if (weight == glm::vec3(0.0f))
    return;
  if (const MicrofacetPlan *plastic = layer(kept.gloss, planned.gloss)) {
    const Lobe gloss = placed(*plastic, bsdf, frame, weight);
    add(bsdf, gloss);
    weight = below(weight, gloss.albedo);
  }

  const uint8_t matte_frame = n == n_reflect ? frame : add_frame(bsdf, n, glm::vec3(0.0f));
  Lobe diffuse = make_diffuse(color * weight, color, unit(in.diffuse_roughness), in.option == 1, cos_in(bsdf, matte_frame));
  diffuse.frame = matte_frame;
  diffuse.rules = in.rules;
  add(bsdf, diffuse);
}

void add_principled(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &principled) {
  if (principled.rules == Rules::Blender3)
    add_sum3(bsdf, lobe, principled);
  else
    add_layers(bsdf, lobe, principled, {});
}

} // namespace lancer
