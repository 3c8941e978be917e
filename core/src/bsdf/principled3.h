// The Principled BSDF of Blender 3: a sum of lobes. Included by principled.h only.
#pragma once

#include "bsdf/principled.h"

namespace lancer {

// Returns a colour's hue and saturation with luminance 1.
template <class V> LANCER_LANE V hue_of(const V &color, const glm::vec3 &luminance_weights) {
  using F = NumberOf<V>;
  const F luminance = dot(color, V(luminance_weights));
  return select(luminance > 0.0f, color / luminance, V(F(1.0f)));
}

// Cycles 3 walks randomly from facet to facet with height-correlated masking; the energy-preserving lobe of Blender 4
// approximates this.
inline constexpr Rules kSeveralBounces = Rules::Blender45;

// Adds a lobe in some lanes.
template <class F>
LANCER_LANE void add_facets3(Bsdf<F> &bsdf, Lobe<F> lobe, MaskOf<F> lanes, F cos_o, bool preserving, float shown = 0.0f) {
  if (!any(lanes))
    return;
  lobe.color = select(lanes, lobe.color, Vec3<F>(F(0.0f)));
  if (shown > 0.0f)
    lobe.shown = F(shown);
  complete_microfacet(lobe, cos_o, uniform<F>(preserving));
  bsdf.add(lobe);
}

// Glass of a single bounce: reflection and refraction, each weighted by Fresnel at the normal, with their own roughnesses.
// Glass of several bounces: one lobe.
template <class F>
LANCER_LANE void add_glass3(Bsdf<F> &bsdf, uint8_t frame, const Vec3<F> &weight, const PrincipledInputs<F> &in, F ior) {
  using V = Vec3<F>;
  const V one(F(1.0f)), tint = mix(one, in.base_color, in.specular_tint.x);
  const F cos_o = cos_in(bsdf, frame), alpha = in.roughness * in.roughness;
  const bool single = in.distribution != Facets::MultiGgx;
  const MaskOf<F> several = uniform<F>(!single) & (in.roughness > 0.05f);
  if (any(several)) {
    Lobe<F> glass = make_microfacet(Scatter::Both, frame, weight, alpha, alpha, kSeveralBounces);
    set_schlick(glass, V(f0_of_ior(ior)), one, ior, clamp01(tint), clamp01(in.base_color));
    add_facets3(bsdf, glass, several, cos_o, true);
  }
  const F reflectance = fresnel_dielectric(cos_o, ior);
  Lobe<F> reflection = make_microfacet(Scatter::Reflect, frame, reflectance * weight, alpha, alpha, in.rules);
  set_principled3(reflection, clamp01(tint), ior);
  add_facets3(bsdf, reflection, !several, cos_o, false);

  const F through = single ? 1.0f - (1.0f - in.roughness) * (1.0f - in.transmission_roughness) : in.roughness;
  const V passing = in.base_color * weight * max(F(1e-4f), 1.0f - reflectance);
  Lobe<F> refraction = make_microfacet(Scatter::Refract, frame, passing, through * through, through * through, in.rules);
  refraction.ior = ior;
  add_facets3(bsdf, refraction, !several, cos_o, false);
}

// The diffuse lobe, or the light below the surface: it takes all of the diffuse light, in a colour between the two, and leaves
// the part that returns towards its source to a lobe of its own.
template <class F>
LANCER_LANE void add_diffuse3(Bsdf<F> &bsdf, uint8_t frame, const Vec3<F> &weight, const PrincipledInputs<F> &in) {
  using V = Vec3<F>;
  const V none(F(0.0f)), inner = mix(in.base_color, in.subsurface_color, in.subsurface);
  const MaskOf<F> below = in.subsurface > kLeastLayer, walks = below & uniform<F>(bsdf.walks) & !bsdf.after_diffuse;
  const auto add = [&](Lobe<F> lobe, MaskOf<F> lanes) {
    lobe.color = select(lanes, lobe.color, none);
    lobe.frame = frame;
    lobe.rules = in.rules;
    bsdf.add(lobe);
  };
  add(make_burley(weight * select(below, inner, in.base_color), in.roughness), !walks);
  if (!any(walks))
    return;
  const V all = select(walks, weight * inner, none);
  add(make_retroreflection(all, in.roughness, cos_in(bsdf, frame)), walks);
  const V matt = add_subsurface(bsdf, frame,
                                {.option = in.subsurface_option,
                                 .rules = in.rules,
                                 .weight = all,
                                 .color = inner,
                                 .radius = in.subsurface_radius * in.subsurface,
                                 .ior = in.subsurface_ior,
                                 .g = in.subsurface_anisotropy,
                                 .dimmed_exit = true});
  add(make_burley(matt, F(0.0f)), walks);
}

template <class F> void add_sum3(Bsdf<F> &bsdf, const LobeInputs<F> &lobe, const PrincipledInputs<F> &given) {
  using V = Vec3<F>;
  PrincipledInputs<F> in = given;
  // Behind a diffuse scattering the colour below the surface mixes into all lobes.
  const MaskOf<F> mixed = bsdf.after_diffuse & (in.subsurface > F(0.0f));
  if (any(mixed)) {
    in.base_color = select(mixed, mix(in.base_color, in.subsurface_color, in.subsurface), in.base_color);
    in.subsurface = select(mixed, F(0.0f), in.subsurface);
  }
  const V one(F(1.0f)), none(F(0.0f));
  // All normals, including that of the diffuse lobe, are tilted so that the mirror direction is above the surface.
  const V n = reflecting_normal(bsdf, lobe.normal);
  const Grain<F> grain = grain_of(lobe, in.roughness, in.anisotropic);
  const V tangent =
      any(grain.stretched) ? select(grain.stretched, turn_about(lobe.tangent, n, in.anisotropic_rotation), none) : none;
  const uint8_t frame = add_frame(bsdf, n, tangent);
  const F cos_o = cos_in(bsdf, frame);
  const F metallic = clamp01(in.metallic), glass = clamp01(in.transmission) * (1.0f - metallic);
  const F diffuse = (1.0f - metallic) * (1.0f - clamp01(in.transmission));
  const bool preserving = in.distribution == Facets::MultiGgx;

  bsdf.emission += in.emission * lobe.weight;

  const MaskOf<F> is_diffuse = diffuse > kLeastLayer, is_dusty = is_diffuse & (in.sheen > kLeastLayer);
  if (any(is_diffuse))
    add_diffuse3(bsdf, frame, select(is_diffuse, diffuse * lobe.weight, none), in);
  if (any(is_dusty)) {
    const V hue = mix(one, hue_of(in.base_color, {0.2126729f, 0.7151522f, 0.0721750f}), in.sheen_tint.x);
    Lobe<F> dust = make_matte<F>(Matte::DustSheen, select(is_dusty, diffuse * in.sheen * hue * lobe.weight, none));
    dust.frame = frame;
    dust.rules = in.rules;
    bsdf.add(dust);
  }

  // Plastic and metal are one lobe, whose reflectance at normal incidence varies from the specular level to the base colour.
  const MaskOf<F> is_glossy = (1.0f - glass > kLeastLayer) & ((in.specular > kLeastLayer) | (in.metallic > kLeastLayer));
  if (any(is_glossy)) {
    const V hue = mix(one, hue_of(in.base_color, {0.3f, 0.6f, 0.1f}), in.specular_tint.x);
    const V plastic = 0.08f * in.specular * hue;
    const F ior = 2.0f / (1.0f - sqrt(max(F(0.0f), 0.08f * in.specular))) - 1.0f;
    const MaskOf<F> several = uniform<F>(preserving) & (in.roughness > 0.075f);
    for (const bool bounces : {true, false}) {
      const MaskOf<F> lanes = is_glossy & (bounces ? several : !several);
      Lobe<F> gloss = make_microfacet(Scatter::Reflect, frame, (1.0f - glass) * lobe.weight, grain.alpha_x, grain.alpha_y,
                                      bounces ? kSeveralBounces : in.rules);
      set_principled3(gloss, clamp01(mix(plastic, in.base_color, in.metallic)), ior);
      add_facets3(bsdf, gloss, lanes, cos_o, bounces, 1.0f);
    }
  }
  const MaskOf<F> is_glass = glass > kLeastLayer;
  if (any(is_glass)) {
    const F ior = max(in.ior, F(kSmallestIor));
    const uint8_t plain = any(grain.stretched) ? add_frame(bsdf, n) : frame;
    add_glass3(bsdf, plain, select(is_glass, glass * lobe.weight, none), in, select(bsdf.inside, 1.0f / ior, ior));
  }

  const MaskOf<F> is_coated = in.coat > kLeastLayer;
  if (any(is_coated)) {
    const uint8_t coat_frame = add_frame(bsdf, select(is_coated, reflecting_normal(bsdf, in.coat_normal), none));
    Lobe<F> coat = make_clear_coat(select(is_coated, in.coat * lobe.weight, none), in.coat_roughness * in.coat_roughness,
                                   cos_in(bsdf, coat_frame));
    coat.frame = coat_frame;
    // The passes show the full coat, whatever its weight.
    coat.shown = 4.0f / in.coat;
    bsdf.add(coat);
  }
}

} // namespace lancer
