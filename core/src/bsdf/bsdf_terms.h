// How the lobes of a Bsdf are summed and sampled. Included by bsdf.h alone.
#pragma once

#include "bsdf/ashikhmin.h"
#include "bsdf/bsdf.h"
#include "bsdf/classic_lobes.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_terms.h"
#include "bsdf/normals.h"
#include "bsdf/sheen.h"

namespace lancer {

template <class F> bool is_facets(const Lobe<F> &lobe) { return lobe.shape == LobeShape::Microfacet; }

// Whether a lobe sends light both back and through the surface, by its own choice.
template <class F> bool splits(const Lobe<F> &lobe) { return is_facets(lobe) || lobe.shape == LobeShape::Dielectric; }

template <class F> bool lets_through(const Lobe<F> &lobe) {
  return (is_facets(lobe) && refracts(lobe)) || lobe.shape == LobeShape::Dielectric || matte_transmits(lobe);
}

// alpha_x alpha_y, or what takes its place.
template <class F> LANCER_LANE F alpha2_of(const Lobe<F> &lobe) {
  switch (lobe.shape) {
  case LobeShape::Microfacet:
  case LobeShape::Ashikhmin:
    return lobe.alpha_x * lobe.alpha_y;
  case LobeShape::Beckmann:
    return lobe.alpha_x * lobe.alpha_x;
  case LobeShape::Phong:
  case LobeShape::BlinnPhong:
    // Beckmann's lobe of the same curvature at its top.
    return min(F(1.0f), 2.0f / (lobe.shininess + 2.0f));
  default:
    return F(1.0f);
  }
}

// Where a lobe draws a direction on that side of ng: none passes the surface the wrong way, except that Cycles 3 does not ask
// it of lobes that refract.
template <class F> LANCER_LANE MaskOf<F> draws_on_side(const Lobe<F> &lobe, MaskOf<F> through, F cos_ng) {
  if (lobe.rules == Rules::Blender3 && is_facets(lobe) && refracts(lobe))
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
  emission = V(F(0.0f));
}

template <class F> LANCER_LANE void Bsdf<F>::add(const Lobe<F> &lobe) {
  if (count < kMaxLobes && !all(black(lobe.color)))
    lobes[count++] = lobe;
}

template <class F> void Bsdf<F>::complete() {
  // Lobes are picked by the light that they are expected to scatter.
  const F zero(0.0f);
  F total = zero;
  smooth = transmits = uniform<F>(false);
  for (int i = 0; i < count; ++i) {
    Lobe<F> &lobe = lobes[i];
    const B there = !black(lobe.color);
    // The albedo of rough refraction is that of the smooth surface, which may reflect all where tilted facets do not.
    V expected = lobe.albedo;
    if (is_facets(lobe) && !reflects(lobe))
      expected = select(lobe.delta | lobe.delta_through, expected, lobe.color);
    const F most = max(max(max(expected.x, expected.y), expected.z), zero);
    lobe.probability = select(there, most, zero);
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

template <class F> Vec3<F> Bsdf<F>::shown(Component component) const {
  V total(F(0.0f));
  for (int i = 0; i < count; ++i) {
    const Lobe<F> &lobe = lobes[i];
    const B there = !black(lobe.color);
    if (lobe.component == component)
      total = select(there, total + select(lobe.shown > 0.0f, lobe.shown * lobe.color, lobe.albedo - lobe.through), total);
    if (component == Component::Transmission)
      total = select(there, total + lobe.through, total);
  }
  return total;
}

// known: the frame in which wi is known in each lane.
template <class F>
void Bsdf<F>::turn_to_frames(const V &wi, const WordOf<F> &known, const V &wi_known, B single, Local &local) const {
  for (int i = 0; i < frame_count; ++i) {
    const B is_known = equal(known, first_same[i]);
    local.wi[i] = all(is_known) ? wi_known : select(is_known, wi_known, frames[i].to_local(wi));
  }
  local.cos_ng = select(flat & !single, local.wi[0].z, dot(ng, wi));
}

// Of lobes that only reflect, or scatter widely, without the colour. h: of lobes that reflect about it.
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

template <class F> BsdfValue<F> Bsdf<F>::sum(const Local &local, const Drawn &drawn, bool lit, uint32_t shapes) const {
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
    if (!any(there) || !(shapes & shape_bit(lobe.shape)))
      continue;
    const V &wi = local.wi[lobe.frame];
    const B through = wi.z < zero, drew = equal(drawn.lobe, WordOf<F>(static_cast<uint32_t>(i)));
    const B counts = lit ? there : there & draws_on_side(lobe, through, local.cos_ng);
    F bump(1.0f);
    if (lobe.frame != 0) {
      const B acts = bump_acts(lobe, drew);
      bump = select(acts, bump_factor(lobe, frames[lobe.frame].n, ns, local.wi[0].z, wi.z, bump_correction), bump);
      // Where the lobe that drew wi gives nothing the sample is lost: its density is not in the sum either.
      lost = lost | (there & drew & (bump == zero));
      there = there & (bump != zero);
    }
    const auto add = [&](Component component, B lanes, const ColorValue<F> &term) __attribute__((always_inline)) {
      V &part = value.part[static_cast<int>(component)];
      part = select(lanes, part + lobe.color * term.f * bump, part);
      value.pdf = select(lanes & counts, value.pdf + lobe.probability * term.pdf, value.pdf);
    };
    const V &wo_l = wo_local[lobe.frame];
    if (lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen ||
        lobe.shape == LobeShape::Ashikhmin) {
      add(lobe.component, there, smooth_value(lobe, wi, h));
      continue;
    }
    const B crossing = there & through;
    if (is_facets(lobe) && refracts(lobe) && any(crossing)) {
      const V bent = refraction_half_vector(wo_l, wi, lobe.ior);
      add(Component::Transmission, crossing,
          microfacet_eval_through(lobe, wo_l, wi, select(drew & drawn.has_h, drawn.h, bent), lit));
    }
    // What is left reflects about the half vector.
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
  return sum(local, {number, number, uniform<F>(false), wi}, false);
}

template <class F> BsdfValue<F> Bsdf<F>::eval_lit(const V &wi, uint32_t shapes) const {
  Local local;
  turn_to_frames(wi, WordOf<F>(~0u), wi, uniform<F>(false), local);
  const WordOf<F> nobody(~0u);
  return sum(local, {nobody, nobody, uniform<F>(false), wi}, true, shapes);
}

// What each lane has drawn from its lobe.
template <class F> struct Bsdf<F>::Direction {
  V cosine, facet; // what the warps of all lanes gave: by the cosine, and a visible normal
  V wi, h, weight; // in the lobe's frame; weight of single directions, over their probability within the lobe
  F probability;   // of single directions, within the lobe
  B valid, single, has_h;
};

// A direction from one lobe, in the lanes that picked it.
template <class F> void Bsdf<F>::draw(const Lobe<F> &lobe, B mine, F u_side, F u, F v, Direction &direction) const {
  const F zero(0.0f), one(1.0f);
  const V &wo_l = wo_local[lobe.frame];
  V wi = direction.cosine, h(zero), weight(zero);
  F probability = one;
  B valid = uniform<F>(true), single = lobe.delta, has_h = uniform<F>(false);
  const auto take_single = [&](const DeltaDirection<F> &given) __attribute__((always_inline)) {
    wi = select(lobe.delta, given.wi, wi);
    weight = V(given.weight);
    probability = given.probability;
  };
  switch (lobe.shape) {
  case LobeShape::Lambert:
    break;
  case LobeShape::Matte:
    if (matte_transmits(lobe))
      wi.z = -wi.z;
    else if (is_matte(lobe, Matte::Velvet))
      wi = velvet_sample(u, v);
    else if (is_matte(lobe, Matte::Minnaert))
      wi = minnaert_sample(lobe, u, v);
    break;
  case LobeShape::Sheen:
    wi = sheen_sample(lobe, wo_l, u, v);
    break;
  case LobeShape::Microfacet: {
    h = lobe.beckmann ? beckmann_sample_visible(wo_l, lobe.alpha_x, lobe.alpha_y, u, v) : direction.facet;
    const MicrofacetDirection<F> d = microfacet_sample(lobe, wo_l, u_side, h);
    wi = d.wi;
    weight = d.weight;
    probability = d.probability;
    single = d.delta;
    valid = d.valid;
    has_h = !single;
    break;
  }
  case LobeShape::Ashikhmin:
    if (any(mine & !lobe.delta))
      wi = gloss_sample(lobe, wo_l, u, v);
    take_single({reflect_local(wo_l), gloss_delta_weight(lobe, wo_l), one});
    break;
  case LobeShape::Beckmann:
    if (any(mine & !lobe.delta)) {
      h = beckmann_sample_visible(wo_l, lobe.alpha_x, lobe.alpha_x, u, v);
      wi = reflect_about(wo_l, h);
      has_h = !lobe.delta;
    }
    take_single(smooth_coating_sample(lobe, wo_l));
    break;
  case LobeShape::Phong:
    wi = phong_sample(lobe, wo_l, u, v);
    h = half_vector(wo_l, wi);
    has_h = uniform<F>(true);
    break;
  case LobeShape::BlinnPhong:
    h = sample_cosine_power(lobe.shininess, u, v);
    wi = reflect_about(wo_l, h);
    has_h = uniform<F>(true);
    break;
  case LobeShape::Mirror:
    take_single(mirror_sample(wo_l));
    break;
  case LobeShape::Dielectric:
    take_single(dielectric_sample(lobe, wo_l, u_side));
    break;
  }
  const bool wide = lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen;
  if (!wide) {
    // Seen from behind there is nothing to reflect; a sampler may aim below the horizon; that light is lost.
    valid = valid & (wo_l.z > zero);
    if (!is_facets(lobe))
      valid = valid & (single | (wi.z > zero));
  }
  direction.wi = select(mine, wi, direction.wi);
  direction.h = select(mine, h, direction.h);
  direction.weight = select(mine & single, lobe.color * weight / lobe.probability, direction.weight);
  direction.probability = select(mine, lobe.probability * probability, direction.probability);
  direction.valid = direction.valid | (mine & valid);
  direction.single = direction.single | (mine & single);
  direction.has_h = direction.has_h | (mine & has_h);
}

template <class F> BsdfSample<F> Bsdf<F>::sample(F u_lobe, F u, F v) const {
  const F zero(0.0f), one(1.0f);
  const auto numbered = [](int i) __attribute__((always_inline)) { return WordOf<F>(static_cast<uint32_t>(i)); };
  BsdfSample<F> result;
  // Pick the lobe that u_lobe falls on, which keeps what remains of it, again in [0, 1). A lobe of probability 0 is never
  // picked, even where rounding leaves u beyond the last sum.
  WordOf<F> chosen(~0u);
  B open = uniform<F>(true);
  for (int i = 0; i < count; ++i) {
    const F probability = lobes[i].probability;
    const B there = open & (probability > zero), here = there & (u_lobe < probability);
    chosen = select(there, numbered(i), chosen);
    u_lobe = select(here, u_lobe / probability, select(there, u_lobe - probability, u_lobe));
    open = open & !here;
  }
  u_lobe = min(u_lobe, F(1.0f - 0x1p-24f));

  // Warp the numbers once for all lanes whose lobes share a warp.
  B cosines = uniform<F>(false), visible = cosines;
  F alpha_x = one, alpha_y = one;
  V seen(zero, zero, one);
  for (int i = 0; i < count; ++i) {
    const Lobe<F> &lobe = lobes[i];
    const B mine = equal(chosen, numbered(i));
    if (draws_cosines(lobe))
      cosines = cosines | mine;
    if (is_facets(lobe) && !lobe.beckmann) {
      visible = visible | (mine & !lobe.delta);
      alpha_x = select(mine, lobe.alpha_x, alpha_x);
      alpha_y = select(mine, lobe.alpha_y, alpha_y);
      seen = select(mine, wo_local[lobe.frame], seen);
    }
  }
  Direction direction{V(zero), V(zero),           V(zero),           V(zero),          V(zero),
                      zero,    uniform<F>(false), uniform<F>(false), uniform<F>(false)};
  if (any(cosines))
    direction.cosine = warp_cosine_hemisphere(u, v);
  if (any(visible))
    direction.facet = ggx_sample_visible(seen, alpha_x, alpha_y, u, v);

  // Draw each lane's direction, and turn it to the world.
  WordOf<F> frame(0u);
  for (int i = 0; i < count; ++i) {
    const Lobe<F> &lobe = lobes[i];
    const B mine = equal(chosen, numbered(i));
    if (!any(mine))
      continue;
    draw(lobe, mine, u_lobe, u, v, direction);
    frame = select(mine, first_same[lobe.frame], frame);
    result.alpha2 = select(mine, alpha2_of(lobe), result.alpha2);
    const B crossing = mine & uniform<F>(splits(lobe)) & (direction.wi.z < zero);
    result.component = select(mine, numbered(static_cast<int>(lobe.component)), result.component);
    result.component = select(crossing, numbered(static_cast<int>(Component::Transmission)), result.component);
  }
  for (int i = 0; i < frame_count; ++i) {
    const B standing = equal(frame, numbered(i));
    if (any(standing))
      result.wi = select(standing, frames[i].to_world(direction.wi), result.wi);
  }
  Local local;
  turn_to_frames(result.wi, frame, direction.wi, direction.single, local);
  const B through = direction.wi.z < zero;
  result.transmitted = through;
  result.delta = direction.single;
  B valid = direction.valid & (direction.wi.z != zero);
  for (int i = 0; i < count; ++i) {
    const B mine = equal(chosen, numbered(i));
    if (any(mine))
      valid = valid & ((!mine) | draws_on_side(lobes[i], through, local.cos_ng));
  }

  // Weigh with the sum over all smooth lobes, whichever was picked; h goes along with all digits of the sampler.
  const B single = valid & direction.single, spread = valid & !direction.single;
  result.weight = select(single, direction.weight, V(zero));
  result.pdf = select(single, direction.probability, zero);
  result.alpha2 = select(single, zero, result.alpha2);
  for (int k = 0; k < 2 && shares; ++k)
    result.share[k] = select(single & equal(result.component, numbered(k)), V(one), V(zero));
  if (any(spread)) {
    const BsdfValue<F> value = sum(local, {chosen, frame, direction.has_h, direction.h}, true);
    const B found = spread & (value.pdf > zero);
    const V f = value.f();
    result.weight = select(found, f / value.pdf, result.weight);
    result.pdf = select(found, value.pdf, result.pdf);
    for (int k = 0; k < 2 && shares; ++k) {
      const V share = value.part[k] / f;
      result.share[k] = {select(found & (f.x > zero), share.x, result.share[k].x),
                         select(found & (f.y > zero), share.y, result.share[k].y),
                         select(found & (f.z > zero), share.z, result.share[k].z)};
    }
  }
  return result;
}

} // namespace lancer
