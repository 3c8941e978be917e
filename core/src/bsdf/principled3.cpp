// The Principled BSDF of Blender 3: a sum of lobes.
#include <algorithm>
#include <cmath>

#include "bsdf/ashikhmin.h"
#include "bsdf/fresnel.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_fresnel.h"
#include "bsdf/principled.h"

namespace lancer {

namespace {

// Hue and saturation of a colour, its luminance brought to 1.
glm::vec3 hue_of(const glm::vec3 &color, const glm::vec3 &luminance_weights) {
  const float luminance = glm::dot(color, luminance_weights);
  return luminance > 0.0f ? color / luminance : glm::vec3(1.0f);
}

// Cycles 3 walks from facet to facet at random, with height-correlated masking; the compensated lobe of Blender 4 stands in.
constexpr Rules kSeveralBounces = Rules::Blender45;

// Blender 3 glass of one bounce: reflection and refraction each weighted by Fresnel at the normal, with roughnesses of their
// own; of several bounces: one lobe.
void add_glass3(Bsdf &bsdf, uint8_t frame, const glm::vec3 &weight, const PrincipledInputs &in, float ior) {
  const glm::vec3 tint = glm::mix(glm::vec3(1.0f), in.base_color, in.specular_tint.x);
  const float cos_o = cos_in(bsdf, frame), alpha = in.roughness * in.roughness;
  const bool single = in.distribution != Facets::MultiGgx;
  if (!single && in.roughness > 0.05f) {
    Lobe glass = make_microfacet(Scatter::Both, frame, weight, alpha, alpha, kSeveralBounces);
    set_schlick(glass, glm::vec3(f0_of_ior(ior)), glm::vec3(1.0f), ior, unit(tint), unit(in.base_color));
    complete_microfacet(glass, cos_o, true);
    add(bsdf, glass);
    return;
  }
  const float reflectance = fresnel_dielectric(cos_o, ior);
  Lobe reflection = make_microfacet(Scatter::Reflect, frame, reflectance * weight, alpha, alpha, in.rules);
  set_principled3(reflection, unit(tint), ior);
  complete_microfacet(reflection, cos_o, false);
  add(bsdf, reflection);

  const float through = single ? 1.0f - (1.0f - in.roughness) * (1.0f - in.transmission_roughness) : in.roughness;
  const glm::vec3 passing = in.base_color * weight * std::max(1e-4f, 1.0f - reflectance);
  Lobe refraction = make_microfacet(Scatter::Refract, frame, passing, through * through, through * through, in.rules);
  refraction.ior = ior;
  complete_microfacet(refraction, cos_o, false);
  add(bsdf, refraction);
}

} // namespace

void add_sum3(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &in) {
  // Every normal is bent so that what it mirrors stays above the surface, the diffuse one too.
  const glm::vec3 n = reflecting_normal(bsdf, lobe.normal);
  const Grain grain = grain_of(lobe, in.roughness, in.anisotropic);
  const glm::vec3 tangent = grain.stretched ? turn_about(lobe.tangent, n, in.anisotropic_rotation) : glm::vec3(0.0f);
  const uint8_t frame = add_frame(bsdf, n, tangent);
  const float cos_o = cos_in(bsdf, frame);
  const float metallic = unit(in.metallic), glass = unit(in.transmission) * (1.0f - metallic);
  const float diffuse = (1.0f - metallic) * (1.0f - unit(in.transmission));
  const bool preserving = in.distribution == Facets::MultiGgx;

  bsdf.emission += in.emission * lobe.weight;

  if (diffuse > kLeastLayer) {
    Lobe burley = make_burley(diffuse * in.base_color * lobe.weight, in.roughness);
    burley.frame = frame;
    burley.rules = in.rules;
    add(bsdf, burley);
  }
  if (diffuse > kLeastLayer && in.sheen > kLeastLayer) {
    const glm::vec3 hue = hue_of(in.base_color, {0.2126729f, 0.7151522f, 0.0721750f});
    Lobe dust =
        make_matte(Matte::DustSheen, diffuse * in.sheen * glm::mix(glm::vec3(1.0f), hue, in.sheen_tint.x) * lobe.weight);
    dust.frame = frame;
    dust.rules = in.rules;
    add(bsdf, dust);
  }

  // One reflection for plastic and metal: what it does at the normal goes from a level to the base colour.
  if (1.0f - glass > kLeastLayer && (in.specular > kLeastLayer || in.metallic > kLeastLayer)) {
    const glm::vec3 hue = hue_of(in.base_color, {0.3f, 0.6f, 0.1f});
    const glm::vec3 plastic = 0.08f * in.specular * glm::mix(glm::vec3(1.0f), hue, in.specular_tint.x);
    const float ior = 2.0f / (1.0f - std::sqrt(std::max(0.0f, 0.08f * in.specular))) - 1.0f;
    const bool several = preserving && in.roughness > 0.075f;
    Lobe gloss = make_microfacet(Scatter::Reflect, frame, (1.0f - glass) * lobe.weight, grain.alpha_x, grain.alpha_y,
                                 several ? kSeveralBounces : in.rules);
    set_principled3(gloss, unit(glm::mix(plastic, in.base_color, in.metallic)), ior);
    complete_microfacet(gloss, cos_o, several);
    gloss.shown = 1.0f;
    add(bsdf, gloss);
  }
  if (glass > kLeastLayer) {
    const float ior = std::max(in.ior, 1e-5f);
    const uint8_t plain = !grain.stretched ? frame : add_frame(bsdf, n, glm::vec3(0.0f));
    add_glass3(bsdf, plain, glass * lobe.weight, in, bsdf.inside ? 1.0f / ior : ior);
  }

  if (in.coat > kLeastLayer) {
    const uint8_t coat_frame = add_frame(bsdf, reflecting_normal(bsdf, in.coat_normal), glm::vec3(0.0f));
    Lobe coat = make_clear_coat(in.coat * lobe.weight, in.coat_roughness * in.coat_roughness, cos_in(bsdf, coat_frame));
    coat.frame = coat_frame;
    // The passes show it whole, whatever its weight.
    coat.shown = 4.0f / in.coat;
    add(bsdf, coat);
  }
}

} // namespace lancer
