// Lobes as the limits of a path change them: caustics or whole components left out, glossy lobes blurred. As in Cycles, energy
// and albedo stay those of the lobes before; a layer that is left out dims nothing below it.
#pragma once

#include "bsdf/ashikhmin.h"
#include "bsdf/microfacet.h"

namespace lancer {

// The requests of the limits, by lane.
template <class F> struct LobeLimits {
  bool caustics = false, blurs = false; // whether some lane may lack caustics, or has a least alpha
  MaskOf<F> no_reflections = uniform<F>(false), no_refractions = uniform<F>(false); // lobes that mirror, or refract, are absent
  // Lanes that keep the lobes that other lanes lack, and only these.
  bool lacks_reflections = false, lacks_refractions = false;
  MaskOf<F> only_caustics = uniform<F>(false);
  F least_alpha{0.0f}; // of facets; 0: none
  uint32_t lacks = 0;  // bits of components that are absent in all lanes

  LANCER_LANE bool any() const { return caustics || blurs || lacks != 0; }
};

template <class F> LANCER_LANE void remove(Lobe<F> &lobe, const MaskOf<F> &gone) {
  const Vec3<F> none(F(0.0f));
  lobe.color = select(gone, none, lobe.color);
  lobe.albedo = select(gone, none, lobe.albedo);
  lobe.through = select(gone, none, lobe.through);
}

template <class F> LANCER_LANE void leave_out_caustics(Lobe<F> &lobe, const LobeLimits<F> &limits) {
  const bool facets = lobe.shape == LobeShape::Microfacet;
  const MaskOf<F> no_mirror = limits.no_reflections | (limits.only_caustics & !uniform<F>(limits.lacks_reflections));
  const MaskOf<F> no_glass = limits.no_refractions | (limits.only_caustics & !uniform<F>(limits.lacks_refractions));
  if (facets && reflects(lobe) && refracts(lobe)) {
    const Vec3<F> none(F(0.0f));
    lobe.reflection = select(no_mirror, none, lobe.reflection);
    lobe.transmission = select(no_glass, none, lobe.transmission);
    lobe.albedo = select(no_mirror, lobe.through, lobe.albedo) - select(no_glass, lobe.through, none);
    lobe.through = select(no_glass, none, lobe.through);
    return remove(lobe, no_mirror & no_glass);
  }
  const bool mirrors =
      lobe.component == Component::Glossy && (facets || lobe.shape == LobeShape::Ashikhmin || lobe.shape == LobeShape::Toon);
  remove(lobe, mirrors ? no_mirror : facets ? no_glass : limits.only_caustics);
}

constexpr uint32_t component_bit(Component component) { return 1u << static_cast<uint32_t>(component); }

template <class F> LANCER_LANE void leave_out_components(Lobe<F> &lobe, uint32_t lacks) {
  const bool glass = lobe.shape == LobeShape::Microfacet && reflects(lobe) && refracts(lobe);
  const uint32_t own =
      glass ? component_bit(Component::Glossy) | component_bit(Component::Transmission) : component_bit(lobe.component);
  if ((lacks & own) == own && lobe.shape != LobeShape::Subsurface)
    remove(lobe, uniform<F>(true));
}

template <class F> LANCER_LANE void blur(Lobe<F> &lobe, F least_alpha) {
  const bool facets = lobe.shape == LobeShape::Microfacet;
  if (!facets && lobe.shape != LobeShape::Ashikhmin)
    return;
  const MaskOf<F> blurs = least_alpha > F(0.0f);
  lobe.alpha_x = select(blurs, max(lobe.alpha_x, least_alpha), lobe.alpha_x);
  lobe.alpha_y = select(blurs, max(lobe.alpha_y, least_alpha), lobe.alpha_y);
  if (facets)
    set_smoothness(lobe);
  else
    lobe.delta = lobe.delta & !(least_alpha > F(kAshikhminAlpha));
}

// Changes the lobes of a BSDF before complete().
template <class F> LANCER_LANE void limit_lobes(Bsdf<F> &bsdf, const LobeLimits<F> &limits) {
  for (int i = 0; i < bsdf.count; ++i) {
    if (limits.lacks)
      leave_out_components(bsdf.lobes[i], limits.lacks);
    if (limits.caustics)
      leave_out_caustics(bsdf.lobes[i], limits);
    if (limits.blurs)
      blur(bsdf.lobes[i], limits.least_alpha);
  }
}

} // namespace lancer
