// Conversion of lobe inputs to lobes: the lobes at this hit and their weights.
#pragma once

#include "bsdf/add_subsurface.h"
#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"
#include "bsdf/normals.h"
#include "scene/lobe_inputs.h"

namespace lancer {

// Each function adds to a BSDF between begin() and complete(); lobes beyond its capacity are dropped. add_principled() is in
// principled.h.
template <class F>
LANCER_LANE Lobe<F> classic_lobe(LobeShape shape, Component component, uint8_t frame, const LobeInputs<F> &inputs) {
  Lobe<F> lobe;
  lobe.shape = shape;
  lobe.component = component;
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  lobe.color = lobe.albedo = colored_weight(inputs);
  lobe.ior = inputs.ior;
  lobe.shininess = inputs.shininess;
  return lobe;
}

template <class F> LANCER_LANE void add_matte(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  using V = Vec3<F>;
  const bool translucent = inputs.kind == LobeKind::Translucent;
  const V n = translucent ? reflecting_normal(bsdf, inputs.normal) : wide_normal(bsdf, inputs.normal, inputs.rules);
  const uint8_t frame = add_frame(bsdf, n);
  const V &wo = bsdf.wo_local[frame], weight = colored_weight(inputs);
  Lobe<F> lobe;
  switch (inputs.kind) {
  case LobeKind::Diffuse:
    lobe = make_diffuse(weight, inputs.color, inputs.roughness, inputs.option != 0, wo.z);
    break;
  case LobeKind::Minnaert: {
    const F rho = max(max(max(inputs.color.x, inputs.color.y), inputs.color.z), F(0.0f));
    lobe = make_minnaert(weight, inputs.shininess, rho, wo);
    break;
  }
  case LobeKind::Sheen: {
    const F roughness = clamp01(inputs.roughness);
    lobe = inputs.distribution == Facets::Beckmann ? make_velvet(weight, roughness) : make_sheen(weight, roughness, wo.z);
    break;
  }
  case LobeKind::Translucent:
    lobe = make_matte<F>(Matte::Translucent, weight);
    break;
  default:
    lobe = classic_lobe(LobeShape::Lambert, Component::Diffuse, frame, inputs);
    break;
  }
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  bsdf.add(lobe);
}

template <class F> LANCER_LANE void add_subsurface_node(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  using V = Vec3<F>;
  const bool old = inputs.rules == Rules::Blender3;
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal));
  const V matt = add_subsurface(bsdf, frame,
                                {.option = inputs.option,
                                 .rules = inputs.rules,
                                 .weight = colored_weight(inputs),
                                 .color = max(inputs.color, V(F(0.0f))),
                                 .radius = inputs.edge,
                                 .ior = inputs.ior,
                                 .alpha = old ? F(1.0f) : clamp01(inputs.roughness),
                                 .g = inputs.anisotropy});
  bsdf.add(make_lambert<F>(matt, frame, inputs.rules));
}

// Roughness along the tangent and across it, and their frame.
template <class F> struct Stretched {
  F alpha_x, alpha_y;
  uint8_t frame;
};

// axis: rotation axis of the tangent; along, across: factors of the roughness in anisotropic lanes.
template <class F>
LANCER_LANE Stretched<F> stretched(Bsdf<F> &bsdf, const LobeInputs<F> &inputs, const Vec3<F> &n, const Vec3<F> &axis, F alpha,
                                   MaskOf<F> is_stretched, F along, F across) {
  using V = Vec3<F>;
  const V none(F(0.0f));
  if (!any(is_stretched))
    return {alpha, alpha, add_frame(bsdf, n, none)};
  const V turned = select(inputs.rotation != F(0.0f), turn_about(inputs.tangent, axis, inputs.rotation), inputs.tangent);
  return {select(is_stretched, alpha * along, alpha), select(is_stretched, alpha * across, alpha),
          add_frame(bsdf, n, select(is_stretched, turned, none))};
}

// The Glossy node: with anisotropy, one roughness decreases as the other increases.
template <class F> LANCER_LANE Stretched<F> glossy_roughness(Bsdf<F> &bsdf, const LobeInputs<F> &inputs, const Vec3<F> &n) {
  const F alpha = alpha_of(inputs.roughness), anisotropy = min(max(inputs.anisotropy, F(-0.99f)), F(0.99f));
  const auto negative = anisotropy < 0.0f;
  const F shorter = select(negative, 1.0f + anisotropy, 1.0f - anisotropy), longer = 1.0f / shorter;
  return stretched(bsdf, inputs, n, n, alpha, abs(anisotropy) > 1e-4f, select(negative, longer, shorter),
                   select(negative, shorter, longer));
}

// The Metallic node: as in Principled.
template <class F> LANCER_LANE Stretched<F> conductor_roughness(Bsdf<F> &bsdf, const LobeInputs<F> &inputs, const Vec3<F> &n) {
  const F alpha = alpha_of(inputs.roughness), anisotropy = clamp01(inputs.anisotropy);
  const F aspect = aspect_of(anisotropy);
  return stretched(bsdf, inputs, n, normal_or_shading(bsdf, inputs.normal), alpha, anisotropy != F(0.0f), 1.0f / aspect,
                   aspect);
}

// Returns the index as seen from wo's side; Cycles clamps the node's away from 0.
template <class F> LANCER_LANE F index_from(MaskOf<F> inside, F ior) {
  const F outside = max(ior, F(kSmallestIor));
  return select(inside, 1.0f / outside, outside);
}

// Puts the film of a node on its facets. inside: the film lies beyond the index, by which it is scaled.
template <class F> LANCER_LANE void cover(Lobe<F> &lobe, F thickness, F film_ior, F ior, MaskOf<F> inside) {
  if (any(thickness > kThinnestFilm))
    set_film(lobe, thickness, select(inside, film_ior / ior, film_ior));
}

template <class F> LANCER_LANE void add_facets(Bsdf<F> &bsdf, Lobe<F> lobe, const LobeInputs<F> &inputs, bool preserving) {
  lobe.beckmann = inputs.distribution == Facets::Beckmann;
  complete_microfacet(lobe, bsdf.wo_local[lobe.frame].z, uniform<F>(preserving));
  bsdf.add(lobe);
}

// Returns the facets of a node Glossy, Metallic or Glass, with the node's weight in color; the caller completes them. By the
// rules of Blender 3, only for facets that preserve energy.
template <class F>
LANCER_LANE Lobe<F> facets_of(const LobeInputs<F> &inputs, uint8_t frame, F alpha_x, F alpha_y, MaskOf<F> inside) {
  using V = Vec3<F>;
  const V none(F(0.0f));
  if (inputs.kind == LobeKind::Glass) {
    const F eta = index_from(inside, inputs.ior);
    const V color = max(inputs.color, none);
    Lobe<F> lobe = make_microfacet(Scatter::Both, frame, inputs.weight, alpha_x, alpha_y, inputs.rules);
    set_schlick(lobe, V(f0_of_ior(eta)), V(F(1.0f)), eta, color, color);
    cover(lobe, inputs.film_thickness, inputs.film_ior, max(inputs.ior, F(kSmallestIor)), inside);
    return lobe;
  }
  const bool conductor = inputs.kind == LobeKind::Conductor;
  const V weight = conductor ? inputs.weight : colored_weight(inputs);
  Lobe<F> lobe = make_microfacet(Scatter::Reflect, frame, weight, alpha_x, alpha_y, inputs.rules);
  if (!conductor)
    set_constant(lobe, inputs.color);
  else if (inputs.option == 0)
    set_f82(lobe, clamp01(inputs.color), clamp01(inputs.edge));
  else
    set_conductor(lobe, inputs.option == 1 ? FresnelKind::Conductor : FresnelKind::StrongConductor, max(inputs.color, none),
                  max(inputs.edge, none));
  if (conductor)
    cover(lobe, inputs.film_thickness, inputs.film_ior, F(1.0f), uniform<F>(false));
  return lobe;
}

// For inputs without a tangent.
template <class F> LANCER_LANE MicrofacetPlan<F> plan_facets(const LobeInputs<F> &inputs, MaskOf<F> inside) {
  const F alpha = alpha_of(inputs.roughness);
  Lobe<F> lobe = facets_of(inputs, 0, alpha, alpha, inside);
  lobe.beckmann = inputs.distribution == Facets::Beckmann;
  return plan_microfacet(lobe, uniform<F>(inputs.distribution == Facets::MultiGgx));
}

template <class F> LANCER_LANE void add_glossy(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  const Stretched<F> s = glossy_roughness(bsdf, inputs, reflecting_normal(bsdf, inputs.normal));
  if (inputs.distribution == Facets::AshikhminShirley) {
    Lobe<F> lobe = make_ashikhmin(colored_weight(inputs), s.alpha_x, s.alpha_y);
    lobe.frame = s.frame;
    lobe.rules = inputs.rules;
    bsdf.add(lobe);
    return;
  }
  add_facets(bsdf, facets_of(inputs, s.frame, s.alpha_x, s.alpha_y, bsdf.inside), inputs,
             inputs.distribution == Facets::MultiGgx);
}

template <class F> LANCER_LANE void add_conductor(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  const Stretched<F> s = conductor_roughness(bsdf, inputs, reflecting_normal(bsdf, inputs.normal));
  add_facets(bsdf, facets_of(inputs, s.frame, s.alpha_x, s.alpha_y, bsdf.inside), inputs,
             inputs.distribution == Facets::MultiGgx);
}

template <class F> LANCER_LANE void add_refraction(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal));
  const F alpha = inputs.roughness * inputs.roughness; // also for negative roughness
  Lobe<F> lobe = make_microfacet(Scatter::Refract, frame, colored_weight(inputs), alpha, alpha, inputs.rules);
  lobe.ior = index_from(bsdf.inside, inputs.ior);
  add_facets(bsdf, lobe, inputs, false);
}

template <class F> LANCER_LANE void add_glass(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal));
  const F alpha = alpha_of(inputs.roughness), eta = index_from(bsdf.inside, inputs.ior);
  const bool preserving = inputs.distribution == Facets::MultiGgx;
  if (inputs.rules == Rules::Blender3 && !preserving) {
    // Blender 3.x: Fresnel of the smooth surface splits the light between two lobes of facets without Fresnel.
    const F f = fresnel_dielectric(bsdf.wo_local[frame].z, eta);
    for (Scatter scatter : {Scatter::Reflect, Scatter::Refract}) {
      const F share = scatter == Scatter::Reflect ? f : 1.0f - f;
      Lobe<F> lobe = make_microfacet(scatter, frame, colored_weight(inputs) * share, alpha, alpha, inputs.rules);
      lobe.ior = eta;
      add_facets(bsdf, lobe, inputs, false);
    }
    return;
  }
  add_facets(bsdf, facets_of(inputs, frame, alpha, alpha, bsdf.inside), inputs, preserving);
}

template <class F> LANCER_LANE void add_toon(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  const uint8_t frame = add_frame(bsdf, wide_normal(bsdf, inputs.normal, inputs.rules));
  const Toon variant = inputs.option == 0 ? Toon::Diffuse : Toon::Glossy;
  Lobe<F> lobe = make_toon(colored_weight(inputs), inputs.roughness, inputs.roughness_across, variant, inputs.rules);
  lobe.frame = frame;
  bsdf.add(lobe);
}

// Hair has the surface's own normal, and an offset for a tangent that is given.
template <class F> LANCER_LANE void add_hair(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  using V = Vec3<F>;
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, V(F(0.0f))));
  const V tangent = unit_or(inputs.tangent, bsdf.frames[frame].t);
  Lobe<F> lobe = make_hair(colored_weight(inputs), inputs.roughness, inputs.roughness_across, -inputs.offset,
                           bsdf.frames[frame].to_local(tangent), inputs.option == 0 ? Hair::Reflection : Hair::Transmission);
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  bsdf.add(lobe);
}

// The Principled Hair BSDF: option 0 is Chiang's model, 1 Huang's.
template <class F> LANCER_LANE void add_hair_fibre(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  using V = Vec3<F>;
  const V tangent = unit_or(inputs.tangent, bsdf.frames[0].t);
  // A tangent along wo has no plane with it.
  const uint8_t frame = add_frame(bsdf, unit_or(cross(tangent, bsdf.wo), bsdf.frames[0].b), tangent);
  // In the frame of another normal the fibre has no meaning.
  if (frame == 0)
    return;
  const V absorption = max(inputs.color, V(F(0.0f))), &wo = bsdf.wo_local[frame];
  Lobe<F> lobe;
  if (inputs.option == 0) {
    lobe = make_chiang(inputs.weight, inputs.roughness, inputs.roughness_across, inputs.edge.x, inputs.ior, inputs.offset,
                       absorption, bsdf.frames[frame].to_local(bsdf.ng), inputs.rules);
    lobe.albedo = chiang_albedo(lobe, wo);
  } else {
    lobe = make_huang(inputs.weight, inputs.roughness, inputs.roughness_across, inputs.ior, inputs.offset, absorption,
                      inputs.edge, bsdf.frames[frame].to_local(bsdf.ns), inputs.rules);
    lobe.albedo = huang_albedo(lobe, wo);
  }
  lobe.frame = frame;
  bsdf.add(lobe);
}

// Adds the lobes of CLASSIC other than Lambert.
template <class F> LANCER_LANE void add_classic(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal));
  const Vec3<F> &wo = bsdf.wo_local[frame];
  const LobeShape shape = inputs.kind == LobeKind::Beckmann     ? LobeShape::Beckmann
                          : inputs.kind == LobeKind::Dielectric ? LobeShape::Dielectric
                          : inputs.kind == LobeKind::Mirror     ? LobeShape::Mirror
                          : inputs.kind == LobeKind::Phong      ? LobeShape::Phong
                                                                : LobeShape::BlinnPhong;
  Lobe<F> lobe = classic_lobe(shape, Component::Glossy, frame, inputs);
  lobe.delta = uniform<F>(shape == LobeShape::Mirror || shape == LobeShape::Dielectric);
  if (shape == LobeShape::Beckmann) {
    lobe.alpha_x = lobe.alpha_y = inputs.roughness;
    lobe.delta = lobe.alpha_x < kMirrorAlpha;
    lobe.albedo *= coating_albedo_estimate(lobe, wo);
  } else if (shape == LobeShape::Dielectric) {
    lobe.ior = select(bsdf.inside, 1.0f / inputs.ior, inputs.ior);
    lobe.through = lobe.color * (1.0f - fresnel_dielectric(wo.z, lobe.ior));
  }
  bsdf.add(lobe);
}

template <class F> void add_lobe(Bsdf<F> &bsdf, const LobeInputs<F> &inputs) {
  switch (inputs.kind) {
  case LobeKind::Lambert:
  case LobeKind::Diffuse:
  case LobeKind::Sheen:
  case LobeKind::Translucent:
  case LobeKind::Minnaert:
    return add_matte(bsdf, inputs);
  case LobeKind::Glossy:
    return add_glossy(bsdf, inputs);
  case LobeKind::Glass:
    return add_glass(bsdf, inputs);
  case LobeKind::Refraction:
    return add_refraction(bsdf, inputs);
  case LobeKind::Conductor:
    return add_conductor(bsdf, inputs);
  case LobeKind::Toon:
    return add_toon(bsdf, inputs);
  case LobeKind::Hair:
    return add_hair(bsdf, inputs);
  case LobeKind::HairFibre:
    return add_hair_fibre(bsdf, inputs);
  case LobeKind::Subsurface:
    return add_subsurface_node(bsdf, inputs);
  case LobeKind::Principled:
    return;
  default:
    return add_classic(bsdf, inputs);
  }
}

} // namespace lancer
