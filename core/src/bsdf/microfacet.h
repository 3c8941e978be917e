// Construction and albedo of microfacet lobes.
//
//   Lobe lobe = make_microfacet(Scatter::Reflect, frame, weight, alpha_x, alpha_y, rules);
//   set_...(lobe, ...);                              one of them: the Fresnel curve of the facets
//   complete_microfacet(lobe, cos_o, preserving);    then: smoothness, energy, albedo
#pragma once

#include "bsdf/albedo_tables.h"
#include "bsdf/fresnel.h"
#include "bsdf/microfacet_eval.h"

namespace lancer {

// A lobe whose product of both roughnesses is below this limit is treated as a mirror. Cycles' limit is slightly lower; below
// alpha = 2e-5, float half vectors cannot distinguish the directions of a lobe.
inline constexpr float kMirrorAlpha2 = 4e-10f;
inline constexpr float kMirrorAlpha2Blender3 = 1e-7f;

// Returns alpha for a node's roughness, clamped to 0 ... 1.
template <class F> LANCER_LANE F alpha_of(F roughness) {
  const F within = clamp01(roughness);
  return within * within;
}

// The lobe reflects everything (FresnelKind::None) until one of the following functions sets a curve.
template <class F>
LANCER_LANE Lobe<F> make_microfacet(Scatter scatter, uint8_t frame, const Vec3<F> &color, F alpha_x, F alpha_y, Rules rules) {
  Lobe<F> lobe;
  lobe.shape = LobeShape::Microfacet;
  lobe.variant = static_cast<uint8_t>(scatter);
  const bool passes = scatter == Scatter::Refract || scatter == Scatter::Through;
  lobe.component = passes ? Component::Transmission : Component::Glossy;
  lobe.frame = frame;
  lobe.rules = rules;
  lobe.color = color;
  lobe.shown = F(rules == Rules::Blender3 && scatter != Scatter::Both ? 1.0f : 0.0f);
  lobe.alpha_x = clamp01(alpha_x);
  lobe.alpha_y = clamp01(alpha_y);
  lobe.ior = F(1.0f);
  lobe.f0 = Vec3<F>(F(1.0f));
  return lobe;
}

// further: the share of light that each further bounce keeps, that is, the node's colour; color may contain other weights as
// well.
template <class F> LANCER_LANE void set_constant(Lobe<F> &lobe, const Vec3<F> &further) {
  lobe.fresnel = FresnelKind::None;
  lobe.f0 = further;
}

// ior as seen from wo's side.
template <class F> LANCER_LANE void set_dielectric(Lobe<F> &lobe, F ior) {
  lobe.fresnel = FresnelKind::Dielectric;
  lobe.ior = ior;
}

template <class F> LANCER_LANE void set_conductor(Lobe<F> &lobe, FresnelKind kind, const Vec3<F> &n, const Vec3<F> &k) {
  lobe.fresnel = kind;
  lobe.f0 = n;
  lobe.f90 = k;
}

// Returns Schlick's curve at cosine 1/7.
template <class V> LANCER_LANE V schlick_at_edge(const V &f0) {
  using F = NumberOf<V>;
  return f0 + (V(F(1.0f)) - f0) * F(kFifth);
}

// tint: factor of Schlick's curve at 82 degrees.
template <class F> LANCER_LANE void set_f82(Lobe<F> &lobe, const Vec3<F> &f0, const Vec3<F> &tint) {
  lobe.fresnel = FresnelKind::F82;
  lobe.f0 = f0;
  lobe.b = schlick_at_edge(f0) * F(kEdgeScale) * (Vec3<F>(F(1.0f)) - tint);
}

// Sets the dielectric whose Fresnel curve Schlick's curve follows. A perfect reflector has the end value of the curve
// everywhere.
template <class F> LANCER_LANE void set_curve(Lobe<F> &lobe, F ior) {
  lobe.ior = ior;
  const F lowest = f0_of_ior(ior), range = 1.0f - lowest;
  const auto bends = range > 0.0f;
  lobe.lowest = select(bends, lowest, F(-1.0f));
  lobe.per_range = select(bends, 1.0f / range, F(1.0f));
}

// Sets f0 ... f90 along the curve of the dielectric; ior as seen from wo's side.
template <class F>
LANCER_LANE void set_schlick(Lobe<F> &lobe, const Vec3<F> &f0, const Vec3<F> &f90, F ior, const Vec3<F> &reflection,
                             const Vec3<F> &transmission) {
  lobe.fresnel = FresnelKind::Schlick;
  lobe.f0 = clamp01(f0);
  lobe.f90 = f90;
  set_curve(lobe, ior);
  lobe.reflection = reflection;
  lobe.transmission = transmission;
}

// Sets f0 ... 1 along the curve of the dielectric, Blender 3.x.
template <class F> LANCER_LANE void set_principled3(Lobe<F> &lobe, const Vec3<F> &f0, F ior) {
  lobe.fresnel = FresnelKind::Principled3;
  lobe.f0 = clamp01(f0);
  set_curve(lobe, ior);
  lobe.transmission = Vec3<F>(F(0.0f));
}

// Returns the index above 1 whose reflectance at normal incidence is f0; Cycles clamps f0 to 0.99.
template <class F> LANCER_LANE F ior_of_f0(F f0) {
  const F root = sqrt(min(max(f0, F(0.0f)), F(0.99f)));
  return (1.0f + root) / (1.0f - root);
}

// Returns the share of light from a white sky that a smooth dielectric reflects, outside and inside: the fit of Kulla and Conty
// 2017.
template <class F> LANCER_LANE F dielectric_sky(F eta) {
  const F inside = 0.997118f + eta * (0.1014f - eta * (0.965241f + eta * 0.130607f));
  const F outside = select(abs(eta) < __builtin_inff(), (eta - 1.0f) / (4.08567f + 1.00071f * eta), F(1.0f));
  return select(eta < 1.0f, inside, outside);
}

// Returns the integral of fresnel_f82 over a white sky.
template <class V> LANCER_LANE V f82_sky(const V &f0, const V &b) {
  using F = NumberOf<V>;
  return f0 + (V(F(1.0f)) - f0) * F(1.0f / 21.0f) - b * F(1.0f / 126.0f);
}

// Returns the mean colour of a bounce between the facets.
template <class F> LANCER_LANE Vec3<F> further_bounce(const Lobe<F> &lobe) {
  using V = Vec3<F>;
  switch (lobe.fresnel) {
  case FresnelKind::None:
    return lobe.f0;
  case FresnelKind::Dielectric:
    return V(dielectric_sky(lobe.ior));
  case FresnelKind::Conductor:
  case FresnelKind::StrongConductor: {
    // The curve of F82 through the values at normal incidence and at the edge.
    const V f0 = conductor_response(lobe, F(1.0f)), edge = conductor_response(lobe, F(1.0f / 7.0f));
    return clamp01(f82_sky(f0, F(kEdgeScale) * (schlick_at_edge(f0) - edge)));
  }
  case FresnelKind::F82:
    return f82_sky(lobe.f0, lobe.b);
  case FresnelKind::Schlick:
  case FresnelKind::Principled3:
    break;
  }
  const MaskOf<F> through = !black(lobe.transmission);
  if (all(through))
    return lobe.transmission;
  return select(through, lobe.transmission, lobe.reflection * schlick(lobe, dielectric_sky(lobe.ior)));
}

// Returns the share of the light lost by single scattering that further bounces return (Turquin 2019, with Kulla and Conty's
// colour).
template <class F> LANCER_LANE Vec3<F> further_light(const Lobe<F> &lobe, F roughness) {
  // With a factor above 1, the sum over all bounces would diverge.
  const Vec3<F> one(F(1.0f)), bounce = min(further_bounce(lobe), one);
  const MaskOf<F> whole = same(bounce, one);
  if (all(whole))
    return bounce;
  const F mean = refracts(lobe) ? glass_mean_albedo(roughness, lobe.ior) : ggx_mean_albedo(roughness);
  return select(whole, bounce, bounce * mean / (one - bounce * (1.0f - mean)));
}

// Two-step construction for lobes whose numbers are the same at every hit: the plan, then the view from wo.
template <class F> struct MicrofacetPlan {
  Lobe<F> lobe; // all but color, energy and albedo
  MaskOf<F> preserving = uniform<F>(false);
  F roughness{0.0f};
  Vec3<F> further{F(1.0f)}; // returned share of the lost light, by colour
};

// Table lookups of a plan along the cosine of wo.
template <class F> struct AlbedoLookup {
  // Returns the albedo of single scattering.
  LANCER_LANE F single(const MicrofacetPlan<F> &plan, F cos_o) const {
    return refracts(plan.lobe) ? glass_albedo(plan.roughness, cos_o, plan.lobe.ior) : ggx_albedo(plan.roughness, cos_o);
  }
  // Returns the position of the facets' mean reflectance between the ends of their curve.
  LANCER_LANE F mix(const MicrofacetPlan<F> &plan, F cos_o) const {
    return plan.lobe.fresnel == FresnelKind::F82 ? fifth_power_mix(plan.roughness, cos_o)
                                                 : dielectric_mix(plan.roughness, cos_o, plan.lobe.ior);
  }
};

template <class F> LANCER_LANE void set_smoothness(Lobe<F> &lobe) {
  const F alpha2 = lobe.alpha_x * lobe.alpha_y;
  lobe.delta = alpha2 <= (lobe.rules == Rules::Blender3 ? kMirrorAlpha2Blender3 : kMirrorAlpha2);
  if (refracts(lobe)) {
    // The refracted lobe is narrower than the reflected one by the factor by which the index bends light.
    const F bent = abs(1.0f - 1.0f / lobe.ior);
    lobe.delta_through = (abs(lobe.ior - 1.0f) < kStraightIor) | (alpha2 * bent * bent < kMirrorAlpha2);
  }
}

// Returns the reflected albedo as in Cycles, without the colour; smooth: response of a smooth surface.
template <class F, class Tables>
LANCER_LANE Vec3<F> reflected_albedo(const MicrofacetPlan<F> &plan, F cos_o, const FacetResponse<F> &smooth,
                                     const Tables &tables) {
  using V = Vec3<F>;
  const Lobe<F> &lobe = plan.lobe;
  V mean = smooth.reflected;
  // Average the Fresnel curve over the facets.
  if (lobe.fresnel == FresnelKind::Schlick) {
    mean = (lobe.f0 + (lobe.f90 - lobe.f0) * tables.mix(plan, cos_o)) * lobe.reflection;
  } else if (lobe.fresnel == FresnelKind::F82) {
    mean = lobe.f0 + (V(F(1.0f)) - lobe.f0) * tables.mix(plan, cos_o);
  } else if (lobe.fresnel == FresnelKind::Dielectric && lobe.rules >= Rules::Blender45) {
    const F f0 = f0_of_ior(lobe.ior);
    mean = select(lobe.ior > 1.0f, (f0 + (1.0f - f0) * tables.mix(plan, cos_o)) * lobe.reflection, mean);
  }
  // There is no table for films: they are taken as smooth.
  if (lobe.film)
    mean = select(film_of(lobe).thickness > kThinnestFilm, smooth.reflected, mean);
  // Before 5.2 no facet reflects in the mean where a smooth surface reflects nothing.
  return lobe.rules >= Rules::Blender52 ? mean : select(black(smooth.reflected), V(F(0.0f)), mean);
}

// Whether the albedo needs only the mean over the facets: it does not need the response of a smooth surface, which would not be
// black.
template <class F> LANCER_LANE bool needs_no_smooth_response(const Lobe<F> &lobe) {
  return lobe.fresnel == FresnelKind::Schlick && !lobe.film && !refracts(lobe) && !any(black(lobe.f0));
}

// Sets a lobe's energy, colour and albedo for wo. color: the weight of the lobe; cos_o: wo.z in the lobe's frame.
template <class F, class Tables>
LANCER_LANE Lobe<F> seen_from(const MicrofacetPlan<F> &plan, F cos_o, const Vec3<F> &color, const Tables &tables) {
  using V = Vec3<F>;
  Lobe<F> lobe = plan.lobe;
  lobe.color = color;
  if (any(plan.preserving)) {
    const F single = tables.single(plan, cos_o);
    lobe.energy = select(plan.preserving, 1.0f / single, F(1.0f));
    const MaskOf<F> colored = plan.preserving & !same(plan.further, V(F(1.0f)));
    lobe.color = select(colored, color * (V(single) + plan.further * (1.0f - single)), color);
  }
  FacetResponse<F> smooth;
  smooth.reflected = V(F(1.0f));
  if (!needs_no_smooth_response(lobe))
    smooth = facet_response(lobe, cos_o);
  lobe.albedo = lobe.color * reflected_albedo(plan, cos_o, smooth, tables);
  if (refracts(lobe)) {
    const V through = lobe.color * smooth.through;
    lobe.albedo += through;
    if (reflects(lobe))
      lobe.through = through;
  }
  return lobe;
}

// preserving: returns the light lost by single scattering (GGX only), coloured by further bounces; color then includes that
// factor. The albedo is as in Cycles: Fresnel averaged over visible facets, or of a smooth surface.
template <class F> LANCER_LANE MicrofacetPlan<F> plan_microfacet(const Lobe<F> &lobe, MaskOf<F> preserving) {
  MicrofacetPlan<F> plan;
  plan.lobe = lobe;
  plan.roughness = sqrt(sqrt(lobe.alpha_x * lobe.alpha_y));
  set_smoothness(plan.lobe);
  if (lobe.beckmann || !any(preserving))
    return plan;
  plan.preserving = preserving;
  plan.further = select(preserving, further_light(lobe, plan.roughness), plan.further);
  return plan;
}
template <class F> LANCER_LANE void complete_microfacet(Lobe<F> &lobe, F cos_o, MaskOf<F> preserving) {
  lobe = seen_from(plan_microfacet(lobe, preserving), cos_o, lobe.color, AlbedoLookup<F>());
}

} // namespace lancer
