// Sum and sampling probabilities of a Bsdf's lobes. Included by bsdf.h.
#pragma once

#include "bsdf/ashikhmin.h"
#include "bsdf/bsdf.h"
#include "bsdf/classic_lobes.h"
#include "bsdf/huang_eval.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_eval.h"
#include "bsdf/normals.h"
#include "bsdf/sheen.h"
#include "bsdf/subsurface_lobe.h"
#include "bsdf/toon.h"
#include "simd/vectors.h"

namespace lancer {

template <class F> bool is_facets(const Lobe<F> &lobe) { return lobe.shape == LobeShape::Microfacet; }

// Returns whether a lobe chooses between reflection and transmission.
template <class F> bool splits(const Lobe<F> &lobe) { return is_facets(lobe) || lobe.shape == LobeShape::Dielectric; }

// Returns whether lights that a class of rays does not see hide a lobe from light samples, too: as in Cycles, no class is that
// of glass, which reflects and refracts, and translucent light is diffuse.
template <class F> bool is_of_class(const Lobe<F> &lobe, Component rays) {
  if (matte_transmits(lobe))
    return rays == Component::Diffuse;
  if (lobe.shape == LobeShape::Dielectric || (is_facets(lobe) && refracts(lobe) && reflects(lobe)))
    return false;
  return rays == lobe.component;
}

template <class F> bool lets_through(const Lobe<F> &lobe) {
  return (is_facets(lobe) && (refracts(lobe) || passes_through(lobe))) || lobe.shape == LobeShape::Dielectric ||
         matte_transmits(lobe) || (is_hair(lobe) && !is_hair(lobe, Hair::Reflection));
}

// Returns alpha_x alpha_y, or its equivalent.
template <class F> LANCER_LANE F alpha2_of(const Lobe<F> &lobe) {
  switch (lobe.shape) {
  case LobeShape::Microfacet:
  case LobeShape::Ashikhmin:
    return lobe.alpha_x * lobe.alpha_y;
  case LobeShape::Beckmann:
    return lobe.alpha_x * lobe.alpha_x;
  case LobeShape::Phong:
  case LobeShape::BlinnPhong:
    // A Beckmann lobe of the same curvature at its peak.
    return min(F(1.0f), 2.0f / (lobe.shininess + 2.0f));
  default:
    return F(1.0f);
  }
}

// Returns whether a lobe samples a direction on this side of ng: never on the wrong side, except that Cycles 3 does not check
// refracting lobes, and none checks hair.
template <class F> LANCER_LANE MaskOf<F> draws_on_side(const Lobe<F> &lobe, MaskOf<F> through, F cos_ng) {
  if (is_hair(lobe) || (lobe.rules == Rules::Blender3 && is_facets(lobe) && refracts(lobe)))
    return uniform<F>(true);
  return !((cos_ng < 0.0f) != through);
}

template <class F> void Bsdf<F>::begin(const V &wo_, const V &ns_, const V &ng_, B inside_, bool bump_correction_) {
  wo = wo_;
  ns = ns_;
  ng = ng_;
  inside = inside_;
  bump_correction = bump_correction_;
  flat = same(ns, ng);
  frames[0] = Frame<F>(ns);
  wo_local[0] = frames[0].to_local(wo);
  first_same[0] = WordOf<F>(0u);
  frame_count = 1;
  count = 0;
  emission = straight = V(F(0.0f));
}

template <class F> LANCER_LANE void Bsdf<F>::add(const Lobe<F> &lobe) {
  if (count < kMaxLobes && !all(black(lobe.color)))
    lobes[count++] = lobe;
}

template <class F> void Bsdf<F>::complete() {
  // Select lobes in proportion to the light that they are expected to scatter, averaged over channels. With the largest channel
  // instead of the average, a saturated base would take samples that its gloss needs.
  const F zero(0.0f);
  F total = zero;
  smooth = transmits = uniform<F>(false);
  for (int i = 0; i < count; ++i) {
    Lobe<F> &lobe = lobes[i];
    const B there = !black(lobe.color);
    // The albedo of rough refraction is that of the smooth surface, which may reflect totally where tilted facets do not.
    V expected = lobe.albedo;
    if (is_facets(lobe) && !reflects(lobe))
      expected = select(lobe.delta | lobe.delta_through, expected, lobe.color);
    // Beside the density 1 of Huang's samples, the choice changes the picture: as in Cycles, it goes by the colour.
    if (is_hair(lobe, Hair::Huang))
      expected = lobe.color;
    lobe.probability = select(there, max(mean(expected), zero), zero);
    total += lobe.probability;
    smooth = smooth | (there & !lobe.delta);
    if (lets_through(lobe))
      transmits = transmits | there;
    if (is_facets(lobe)) {
      lobe.hidden = facet_hidden(lobe, wo_local[lobe.frame]);
      lobe.g1 = facet_g1(lobe, wo_local[lobe.frame], lobe.hidden);
    }
  }
  for (int i = 0; i < count; ++i)
    lobes[i].probability = select(total > zero, lobes[i].probability / total, zero);
}

template <class F> Vec3<F> Bsdf<F>::albedo() const {
  V total(F(0.0f));
  for (int i = 0; i < count; ++i)
    total = select(black(lobes[i].color), total, total + lobes[i].albedo);
  return total;
}

// Returns the colour of the transmitted light for the passes: the share that a smooth surface lets through; since 5.2, the
// share that the facets do not reflect in the mean, even where they reflect all.
template <class F> LANCER_LANE Vec3<F> shown_through(const Lobe<F> &lobe) {
  using V = Vec3<F>;
  if (lobe.rules < Rules::Blender52 || !is_facets(lobe) || !refracts(lobe) || !reflects(lobe))
    return lobe.through;
  const V reflected = lobe.albedo - lobe.through, none(F(0.0f));
  const auto channel = [](F whole, F back, F tint) { return select(tint > 0.0f, whole - back / tint, whole); };
  const V kept(channel(lobe.color.x, reflected.x, lobe.reflection.x), channel(lobe.color.y, reflected.y, lobe.reflection.y),
               channel(lobe.color.z, reflected.z, lobe.reflection.z));
  return lobe.transmission * max(kept, none);
}

template <class F> Vec3<F> Bsdf<F>::shown(Component component) const {
  V total(F(0.0f));
  for (int i = 0; i < count; ++i) {
    const Lobe<F> &lobe = lobes[i];
    const B there = !black(lobe.color);
    if (lobe.component == component)
      total = select(there, total + select(lobe.shown > 0.0f, lobe.shown * lobe.color, lobe.albedo - lobe.through), total);
    if (component == Component::Transmission)
      total = select(there, total + shown_through(lobe), total);
  }
  return total;
}

// known: by lane, the number of the frame in which wi_known is the local direction of wi.
template <class F>
void Bsdf<F>::turn_to_frames(const V &wi, const WordOf<F> &known, const V &wi_known, B single, Local &local) const {
  for (int i = 0; i < frame_count; ++i) {
    const B is_known = equal(known, first_same[i]);
    local.wi[i] = all(is_known) ? wi_known : select(is_known, wi_known, frames[i].to_local(wi));
  }
  local.cos_ng = select(flat & !single, local.wi[0].z, dot(ng, wi));
}

// Evaluates a lobe that reflects only or scatters widely, without its colour. h: half vector, for lobes that reflect about it.
template <class F> ColorValue<F> Bsdf<F>::smooth_value(const Lobe<F> &lobe, const V &wi, const V &h) const {
  const V &wo_l = wo_local[lobe.frame];
  LobeValue<F> grey;
  switch (lobe.shape) {
  case LobeShape::Lambert:
    return lambert_eval(wi);
  case LobeShape::Matte:
    return matte_eval(lobe, wo_l, wi);
  case LobeShape::Sheen:
    return sheen_eval(lobe, wo_l, wi);
  case LobeShape::Ashikhmin:
    return gloss_eval(lobe, wo_l, wi);
  case LobeShape::Microfacet:
    return microfacet_eval_reflected(lobe, wo_l, wi, h);
  case LobeShape::Beckmann:
    grey = coating_eval_pdf(lobe, wo_l, wi, h);
    break;
  case LobeShape::Phong:
    grey = phong_eval_pdf(lobe, wo_l, wi);
    break;
  case LobeShape::BlinnPhong:
    grey = blinn_phong_eval_pdf(lobe, wo_l, h);
    break;
  default:
    break;
  }
  return {V(grey.f * wi.z), grey.pdf};
}

// drew: lanes whose direction the lobe has sampled.
template <class F>
ColorValue<F> Bsdf<F>::fibre_value(const Lobe<F> &lobe, const V &wi, const B &drew, const Drawn &drawn) const {
  const V &wo_l = wo_local[lobe.frame];
  if (is_hair(lobe, Hair::Chiang))
    return chiang_eval(lobe, wo_l, wi);
  if (!is_hair(lobe, Hair::Huang))
    return hair_eval(lobe, wo_l, wi, drew);
  const B known = drew & drawn.has_value;
  if (all(known))
    return {drawn.value, F(1.0f)};
  const ColorValue<F> value = huang_eval(lobe, wo_l, wi, key);
  return {select(known, drawn.value, value.f), value.pdf};
}

template <class F>
BsdfValue<F> Bsdf<F>::sum(const Local &local, const Drawn &drawn, bool lit, uint32_t shapes, const B *hidden) const {
  const F zero(0.0f);
  BsdfValue<F> value;
  // The half vector of a frame serves all lobes that reflect in it.
  WordOf<F> half_frame(~0u);
  V h = drawn.h;
  if (any(drawn.has_h))
    for (int i = 0; i < frame_count; ++i) {
      const B here = drawn.has_h & equal(drawn.frame, first_same[i]);
      half_frame = select(here & (local.wi[i].z > zero), drawn.frame, half_frame);
    }
  B lost = uniform<F>(false);
  for (int i = 0; i < count; ++i) {
    const Lobe<F> &lobe = lobes[i];
    B there = (!lobe.delta) & (lobe.probability != zero);
    for (int rays = 0; rays < 3 && hidden; ++rays)
      if (is_of_class(lobe, static_cast<Component>(rays)))
        there = there & !hidden[rays];
    if (!any(there) || !(shapes & shape_bit(lobe.shape)))
      continue;
    const V &wi = local.wi[lobe.frame];
    const B through = wi.z < zero, drew = equal(drawn.lobe, WordOf<F>(static_cast<uint32_t>(i)));
    const B counts = lit ? there : there & draws_on_side(lobe, through, local.cos_ng);
    F bump(1.0f);
    if (lobe.frame != 0) {
      const B acts = bump_acts(lobe, drew);
      bump = select(acts, bump_factor(lobe, frames[lobe.frame].n, ns, local.wi[0].z, wi.z, bump_correction), bump);
      // If the value of the lobe that sampled wi is 0, the sample is lost, and the sum excludes the lobe's density.
      lost = lost | (there & drew & (bump == zero));
      there = there & (bump != zero);
    }
    const auto add = [&](Component component, B lanes, const ColorValue<F> &term) __attribute__((always_inline)) {
      V &part = value.part[static_cast<int>(component)];
      part = select(lanes, part + lobe.color * term.f * bump, part);
      value.pdf = select(lanes & counts, value.pdf + lobe.probability * term.pdf, value.pdf);
      if (spreads)
        value.alpha2 = select(lanes & counts, value.alpha2 + lobe.probability * term.pdf * alpha2_of(lobe), value.alpha2);
    };
    const V &wo_l = wo_local[lobe.frame];
    if (lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen ||
        lobe.shape == LobeShape::Ashikhmin) {
      add(lobe.component, there, smooth_value(lobe, wi, h));
      continue;
    }
    if (lobe.shape == LobeShape::Toon) {
      add(lobe.component, there, toon_eval(lobe, wo_l, wi, drew));
      continue;
    }
    if (is_hair(lobe)) {
      add(lobe.component, there, fibre_value(lobe, wi, drew, drawn));
      continue;
    }
    const B crossing = there & through;
    if (is_facets(lobe) && passes_through(lobe)) {
      const V mirrored = mirrored_beyond(wi);
      const V facet = select(drew & drawn.has_h, drawn.h, half_vector(wo_l, mirrored));
      add(Component::Transmission, crossing & (wo_l.z > zero), microfacet_eval_reflected(lobe, wo_l, mirrored, facet));
      continue;
    }
    if (is_facets(lobe) && refracts(lobe) && any(crossing)) {
      const V bent = refraction_half_vector(wo_l, wi, lobe.ior);
      add(Component::Transmission, crossing,
          microfacet_eval_through(lobe, wo_l, wi, select(drew & drawn.has_h, drawn.h, bent), lit));
    }
    // The remaining lobes reflect about the half vector.
    const B above = there & (wo_l.z > zero) & (wi.z > zero);
    if (!any(above))
      continue;
    const WordOf<F> &number = first_same[lobe.frame];
    const B other = above & !equal(half_frame, number);
    if (any(other)) {
      h = select(other, half_vector(wo_l, wi), h);
      half_frame = select(other, number, half_frame);
    }
    add(lobe.component, above, smooth_value(lobe, wi, h));
  }
  if (any(lost)) {
    for (V &part : value.part)
      part = select(lost, V(zero), part);
    value.pdf = select(lost, zero, value.pdf);
  }
  return value;
}

template <class F> BsdfValue<F> Bsdf<F>::eval(const V &wi, int drawn) const {
  Local local;
  turn_to_frames(wi, WordOf<F>(~0u), wi, uniform<F>(false), local);
  const WordOf<F> number(static_cast<uint32_t>(drawn));
  return sum(local, {.lobe = number, .frame = number, .h = wi}, false);
}

template <class F> BsdfValue<F> Bsdf<F>::eval_lit(const V &wi, uint32_t shapes, const B *hidden) const {
  Local local;
  turn_to_frames(wi, WordOf<F>(~0u), wi, uniform<F>(false), local);
  const WordOf<F> nobody(~0u);
  return sum(local, {.lobe = nobody, .frame = nobody, .h = wi}, true, shapes, hidden);
}

} // namespace lancer
