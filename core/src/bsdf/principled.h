// The Principled BSDF of Blender 4 and newer: converts the inputs to lobes, layer by layer.
#pragma once

#include "bsdf/build.h"
#include "bsdf/sheet.h"

namespace lancer {

// Layers and shares below this are dropped, as in Cycles.
inline constexpr float kLeastLayer = 1e-5f;

enum class PrincipledLayer : uint8_t { Sheen, Coat, Emission, Metal, Glass, Gloss, Diffuse };
inline constexpr int kLayerCount = 7;
// The light that a layer leaves for the layers below: all light, the light that it does not scatter, or the light outside its
// share.
enum class Leaves : uint8_t { All, Unscattered, Unshared };
// Listed top to bottom.
struct LayerRow {
  PrincipledLayer layer;
  Leaves leaves;
  bool facets; // a microfacet lobe, which may be planned in advance
};
constexpr LayerRow kLayers[kLayerCount] = {
    {PrincipledLayer::Sheen, Leaves::Unscattered, false}, {PrincipledLayer::Coat, Leaves::Unscattered, true},
    {PrincipledLayer::Emission, Leaves::All, false},      {PrincipledLayer::Metal, Leaves::Unshared, true},
    {PrincipledLayer::Glass, Leaves::Unshared, true},     {PrincipledLayer::Gloss, Leaves::Unscattered, true},
    {PrincipledLayer::Diffuse, Leaves::All, false}};

template <class F> LANCER_LANE F cos_in(const Bsdf<F> &bsdf, uint8_t frame) { return max(F(0.0f), bsdf.wo_local[frame].z); }
template <class V> LANCER_LANE V positive(const V &x) { return max(x, V(NumberOf<V>(0.0f))); }

// The two roughnesses, shared by all lobes of the base.
template <class F> struct Grain {
  F alpha_x, alpha_y;
  MaskOf<F> stretched; // anisotropic along the rotated tangent
};
template <class F> LANCER_LANE Grain<F> grain_of(const LobeInputs<F> &lobe, F roughness, F anisotropic) {
  const F alpha = roughness * roughness, aspect = aspect_of(anisotropic);
  const MaskOf<F> stretched = (anisotropic > 0.0f) & !black(lobe.tangent);
  return {select(stretched, clamp01(alpha / aspect), alpha), select(stretched, alpha * aspect, alpha), stretched};
}
template <class F> LANCER_LANE Grain<F> base_grain(const LobeInputs<F> &lobe, const PrincipledInputs<F> &in) {
  return grain_of(lobe, clamp01(in.roughness), clamp01(in.anisotropic));
}

// Returns the share of a layer in the light that arrives at it; a layer with share 0 is dropped.
template <class F> LANCER_LANE F share_of(PrincipledLayer layer, const PrincipledInputs<F> &in) {
  switch (layer) {
  case PrincipledLayer::Sheen:
    return in.sheen;
  case PrincipledLayer::Coat:
    return in.coat;
  case PrincipledLayer::Metal:
    return clamp01(in.metallic);
  case PrincipledLayer::Glass:
    return clamp01(in.transmission);
  default:
    return F(1.0f);
  }
}

// Returns the light left for the layers below: one factor for all colours, from the channel with the largest loss.
template <class V> LANCER_LANE V below(const V &weight, const V &albedo) {
  using F = NumberOf<V>;
  const F zero(0.0f);
  F taken = zero;
  taken = select(weight.x != zero, max(taken, albedo.x / weight.x), taken);
  taken = select(weight.y != zero, max(taken, albedo.y / weight.y), taken);
  taken = select(weight.z != zero, max(taken, albedo.z / weight.z), taken);
  const F left = 1.0f - taken;
  // NaN passes through.
  return weight * select(left < zero, zero, select(left > F(1.0f), F(1.0f), left));
}

// Returns the transmittance of a coat's colour along a slanted path: Beer's law over 1/cos of the refracted direction.
template <class F> LANCER_LANE Vec3<F> through_coat(const Vec3<F> &tint, F cos_o, F ior, F coat) {
  const F sin = sqrt(max(F(0.0f), (1.0f - cos_o) * (1.0f + cos_o))) / ior;
  const F depth = 1.0f / sqrt((1.0f - sin) * (1.0f + sin));
  return mix(Vec3<F>(F(1.0f)), Vec3<F>(pow(tint.x, depth), pow(tint.y, depth), pow(tint.z, depth)), coat);
}

// Returns the index of the plastic, adjusted by the specular level, on its own side of 1; f0: its reflectance at normal
// incidence.
template <class F> LANCER_LANE F plastic_ior(const PrincipledInputs<F> &in, F &f0) {
  const F ior = max(in.ior, F(kSmallestIor));
  f0 = f0_of_ior(ior);
  const MaskOf<F> moved = in.specular != F(0.5f);
  if (!any(moved))
    return ior;
  f0 = select(moved, f0 * (2.0f * max(in.specular, F(0.0f))), f0);
  const F bent = ior_of_f0(f0);
  return select(moved, select(ior < 1.0f, 1.0f / bent, bent), ior);
}

// Returns the lobe of a facet layer as far as it depends neither on wo nor on the layers above, without its weight.
template <class F>
LANCER_LANE MicrofacetPlan<F> plan_layer(PrincipledLayer layer, const LobeInputs<F> &inputs, const PrincipledInputs<F> &in,
                                         MaskOf<F> inside) {
  using V = Vec3<F>;
  const V one(F(1.0f)), none(F(0.0f));
  bool preserving = in.distribution == Facets::MultiGgx;
  Lobe<F> lobe;
  switch (layer) {
  case PrincipledLayer::Coat: {
    const F alpha = alpha_of(in.coat_roughness);
    lobe = make_microfacet(Scatter::Reflect, 0, one, alpha, alpha, in.rules);
    set_dielectric(lobe, max(in.coat_ior, F(1.0f)));
    // From Blender 4.5 on the coat preserves energy.
    preserving = in.rules >= Rules::Blender45;
    break;
  }
  case PrincipledLayer::Glass: {
    const F alpha = alpha_of(in.roughness), ior = max(in.ior, F(kSmallestIor));
    lobe = make_microfacet(Scatter::Both, 0, one, alpha, alpha, in.rules);
    set_schlick(lobe, clamp01(f0_of_ior(ior) * positive(in.specular_tint)), one, select(inside, 1.0f / ior, ior), one,
                sqrt(clamp01(positive(in.base_color))));
    cover(lobe, in.film_thickness, max(in.film_ior, F(kSmallestIor)), ior, inside);
    break;
  }
  default: {
    const Grain<F> grain = base_grain(inputs, in);
    lobe = make_microfacet(Scatter::Reflect, 0, one, grain.alpha_x, grain.alpha_y, in.rules);
    if (layer == PrincipledLayer::Metal) {
      set_f82(lobe, clamp01(positive(in.base_color)), clamp01(positive(in.specular_tint)));
      if (in.rules >= Rules::Blender50)
        cover(lobe, in.film_thickness, max(in.film_ior, F(kSmallestIor)), F(1.0f), uniform<F>(false));
    } else {
      F f0;
      const F eta = plastic_ior(in, f0);
      set_schlick(lobe, clamp01(f0 * positive(in.specular_tint)), one, eta, one, none);
      cover(lobe, in.film_thickness, max(in.film_ior, F(kSmallestIor)), F(1.0f), uniform<F>(false));
    }
    break;
  }
  }
  return plan_microfacet(lobe, uniform<F>(preserving));
}

// Returns the facets of a sheet of glass, as seen from outside, without a weight.
template <class F> LANCER_LANE Lobe<F> sheet_facets(const PrincipledInputs<F> &in, uint8_t frame) {
  using V = Vec3<F>;
  const V one(F(1.0f));
  const F alpha = alpha_of(in.roughness), ior = max(in.ior, F(kSmallestIor));
  Lobe<F> lobe = make_microfacet(Scatter::Both, frame, one, alpha, alpha, in.rules);
  set_schlick(lobe, f0_of_ior(ior) * positive(in.specular_tint), one, ior, one, one);
  cover(lobe, in.film_thickness, max(in.film_ior, F(kSmallestIor)), ior, uniform<F>(false));
  return lobe;
}

// Whether the plastic layer has an effect.
template <class F> LANCER_LANE MaskOf<F> has_gloss(const PrincipledInputs<F> &in) {
  F f0;
  return (plastic_ior(in, f0) != F(1.0f)) | (in.film_thickness > kThinnestFilm);
}

// Stands for plans when every layer is planned at the hit.
template <class F> struct NoPlans {
  LANCER_LANE bool has(PrincipledLayer) const { return false; }
  LANCER_LANE Lobe<F> seen(PrincipledLayer, F, const Vec3<F> &) const { return {}; }
};

// plans: the layers planned in advance, and their lobes for a cosine and a weight.
template <class F, class Plans>
void add_layers(Bsdf<F> &bsdf, const LobeInputs<F> &inputs, const PrincipledInputs<F> &in, const Plans &plans) {
  using V = Vec3<F>;
  const V none(F(0.0f));
  const V n = normal_or_shading(bsdf, inputs.normal), n_reflect = reflecting_normal(bsdf, inputs.normal);
  const V n_coat = normal_or_shading(bsdf, in.coat_normal);
  V weight = inputs.weight, tinted = inputs.weight;
  // Metal, glass and plastic share a normal and a roughness, along a tangent if anisotropic.
  const MaskOf<F> stretched = base_grain(inputs, in).stretched;
  const V tangent = any(stretched) ? select(stretched, turn_about(inputs.tangent, n, in.anisotropic_rotation), none) : none;
  // Glass and diffuse light of sheets, whose lanes have other lobes.
  const MaskOf<F> in_sheet = in.thin_wall > 0.0f;
  int base_frame = -1;
  for (const LayerRow &row : kLayers) {
    const F share = share_of(row.layer, in);
    MaskOf<F> there = share > kLeastLayer;
    if (!any(there))
      continue;
    const auto weighted = [&](const V &color) __attribute__((always_inline)) { return select(there, color, none); };
    // A lane without the layer must not add a frame, because later lobes would find that frame.
    const auto framed = [&](const V &normal) __attribute__((always_inline)) {
      return add_frame(bsdf, select(there, normal, none));
    };
    uint8_t frame = 0;
    Lobe<F> lobe;
    switch (row.layer) {
    case PrincipledLayer::Emission:
      bsdf.emission += in.emission * select(bsdf.ends, tinted, weight);
      continue;
    case PrincipledLayer::Sheen: {
      // Cloth on top, with a normal between those of base and coat.
      frame = framed(select(same(n_coat, n), n, mix(n, n_coat, clamp01(in.coat))));
      lobe = make_sheen(weighted(share * positive(in.sheen_tint) * weight), clamp01(in.sheen_roughness), cos_in(bsdf, frame));
      lobe.rules = in.rules;
      break;
    }
    case PrincipledLayer::Diffuse: {
      const MaskOf<F> bent = !same(n, n_reflect);
      frame = any(bent) || base_frame < 0 ? add_frame(bsdf, n, select(bent, none, tangent)) : static_cast<uint8_t>(base_frame);
      const V color = positive(in.base_color);
      const F shared = select(in_sheet, clamp01(in.wall_scattering), F(0.0f));
      if (any(shared > kLeastLayer)) {
        const V both = select(shared > kLeastLayer, shared * (clamp01(color) * weight), none);
        add_matt_sheet(bsdf, frame, both, clamp01(color), in, cos_in(bsdf, frame));
        weight = select(shared > kLeastLayer, weight * (1.0f - shared), weight);
      }
      const F below = select(in_sheet, F(0.0f), clamp01(in.subsurface));
      if (any(below > kLeastLayer)) {
        F f0;
        const V inner = clamp01(color);
        const bool skin = (in.subsurface_option & kMethodBits) == static_cast<uint32_t>(SubsurfaceMethod::Skin);
        const uint8_t entry = add_frame(bsdf, select(below > kLeastLayer, n_reflect, none));
        const V matt = add_subsurface(bsdf, entry,
                                      {.option = in.subsurface_option,
                                       .rules = in.rules,
                                       .weight = select(below > kLeastLayer, below * (inner * weight), none),
                                       .color = inner,
                                       .radius = in.subsurface_radius,
                                       .ior = skin ? in.subsurface_ior : plastic_ior(in, f0),
                                       .alpha = alpha_of(in.roughness),
                                       .g = in.subsurface_anisotropy});
        bsdf.add(make_lambert<F>(matt, entry, in.rules));
        weight = select(below > kLeastLayer, weight * (1.0f - below), weight);
      }
      lobe = make_diffuse(color * weight, color, clamp01(in.diffuse_roughness), in.option == 1, cos_in(bsdf, frame));
      lobe.rules = in.rules;
      break;
    }
    default: {
      if (row.layer == PrincipledLayer::Coat) {
        frame = framed(reflecting_normal(bsdf, n_coat));
      } else {
        if (base_frame < 0)
          base_frame = add_frame(bsdf, n_reflect, tangent);
        frame = static_cast<uint8_t>(base_frame);
      }
      if (row.layer == PrincipledLayer::Gloss && !plans.has(row.layer)) {
        // No gloss if the surface does not bend light.
        there = there & has_gloss(in);
        if (!any(there))
          continue;
      }
      const F cos_o = bsdf.wo_local[frame].z;
      V color = weighted(row.layer == PrincipledLayer::Gloss ? weight : share * weight);
      if (bsdf.limits_caustics && row.layer != PrincipledLayer::Glass)
        color = select(bsdf.no_reflections, none, color);
      if (row.layer == PrincipledLayer::Glass && any(in_sheet)) {
        add_glass_sheet(bsdf, sheet_facets(in, frame), select(in_sheet, color, none), in, cos_in(bsdf, frame));
        color = select(in_sheet, none, color);
      }
      lobe = plans.has(row.layer) ? plans.seen(row.layer, cos_o, color)
                                  : seen_from(plan_layer(row.layer, inputs, in, bsdf.inside), cos_o, color, AlbedoLookup<F>());
      break;
    }
    }
    lobe.frame = frame;
    bsdf.add(lobe);
    if (row.leaves == Leaves::Unscattered)
      weight = select(there, below(weight, lobe.albedo), weight);
    else if (row.leaves == Leaves::Unshared)
      weight = select(there, weight * (1.0f - share), weight);
    // The coat tints light on its way in and out.
    if (row.layer == PrincipledLayer::Coat) {
      const MaskOf<F> tints = there & !same(in.coat_tint, V(F(1.0f)));
      if (any(tints)) {
        const V coat = through_coat(positive(in.coat_tint), cos_in(bsdf, frame), lobe.ior, in.coat);
        weight = select(tints, weight * coat, weight);
        tinted = select(tints, tinted * coat, tinted);
      }
    }
  }
}

} // namespace lancer

#include "bsdf/principled3.h"

namespace lancer {

// lobe has weight, normal and tangent; plans: see add_layers().
template <class F, class Plans>
void add_principled(Bsdf<F> &bsdf, const LobeInputs<F> &lobe, const PrincipledInputs<F> &principled, const Plans &plans) {
  if (principled.rules == Rules::Blender3)
    add_sum3(bsdf, lobe, principled);
  else
    add_layers(bsdf, lobe, principled, plans);
}
template <class F> void add_principled(Bsdf<F> &bsdf, const LobeInputs<F> &lobe, const PrincipledInputs<F> &principled) {
  add_principled(bsdf, lobe, principled, NoPlans<F>());
}

// Adds any other node; its facets may be planned, too.
template <class F, class Plans> void add_cached(Bsdf<F> &bsdf, const LobeInputs<F> &inputs, const Plans &plans) {
  if (!plans.has(PrincipledLayer::Gloss))
    return add_lobe(bsdf, inputs);
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal));
  const bool colored = inputs.kind == LobeKind::Glossy;
  Lobe<F> lobe = plans.seen(PrincipledLayer::Gloss, bsdf.wo_local[frame].z, colored ? colored_weight(inputs) : inputs.weight);
  lobe.frame = frame;
  bsdf.add(lobe);
}

} // namespace lancer
