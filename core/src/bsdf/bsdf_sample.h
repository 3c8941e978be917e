// Sampling of a BSDF: selects a lobe, samples a direction from it, and weights the direction by all lobes.
#pragma once

#include "bsdf/bsdf_eval.h"
#include "bsdf/huang_sample.h"

namespace lancer {

// The direction that each lane has sampled from its lobe.
template <class F> struct Bsdf<F>::Direction {
  V cosine, facet; // results of the warps shared by all lanes: by the cosine, and a visible normal
  V wi, h, weight; // in the lobe's frame; weight of single directions over their probability within the lobe
  F probability;   // of single directions, within the lobe
  B valid, single, has_h;
  B through; // passes the surface; hair: is not reflected by the fibre's surface; subsurface: enters
  B has_value;
  V value; // of Huang's sample
};

// Samples a direction from one lobe, in the lanes that selected it.
template <class F> void Bsdf<F>::draw(const Lobe<F> &lobe, B mine, F u_side, F u, F v, Direction &direction) const {
  const F zero(0.0f), one(1.0f);
  const V &wo_l = wo_local[lobe.frame];
  V wi = direction.cosine, h(zero), weight(zero);
  F probability = one;
  B valid = uniform<F>(true), single = lobe.delta, has_h = uniform<F>(false);
  // Cycles calls all samples of Huang's fibre reflected.
  B reflected = uniform<F>(is_hair(lobe, Hair::Reflection) || is_hair(lobe, Hair::Huang));
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
    if (passes_through(lobe))
      wi = mirrored_beyond(wi);
    break;
  }
  case LobeShape::Toon:
    wi = toon_sample(lobe, wo_l, u, v);
    if (lobe.variant == static_cast<uint8_t>(Toon::Glossy))
      valid = (wo_l.z > zero) & (wi.z > zero);
    break;
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
  case LobeShape::Hair:
    if (is_hair(lobe, Hair::Huang)) {
      const FibreSample<F> fibre = huang_sample(lobe, wo_l, u_side, u, v, key);
      wi = fibre.wi;
      valid = fibre.valid;
      direction.value = select(mine, fibre.value, direction.value);
      direction.has_value = direction.has_value | mine;
    } else {
      wi = is_hair(lobe, Hair::Chiang) ? chiang_sample(lobe, wo_l, u_side, u, v, reflected) : hair_sample(lobe, wo_l, u, v);
    }
    break;
  case LobeShape::Subsurface:
    wi = entry_sample(lobe, wo_l, frames[lobe.frame].to_local(-ng), u_side, u, v, valid);
    weight = V(one);
    break;
  }
  const bool wide = lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen ||
                    lobe.shape == LobeShape::Toon || is_hair(lobe) || is_subsurface(lobe);
  if (!wide) {
    // A lobe seen from behind reflects nothing; a direction sampled below the horizon is lost.
    valid = valid & (wo_l.z > zero);
    if (!is_facets(lobe))
      valid = valid & (single | (wi.z > zero));
  }
  direction.wi = select(mine, wi, direction.wi);
  direction.through =
      select(mine, is_hair(lobe) ? !reflected : (wi.z < zero) | uniform<F>(is_subsurface(lobe)), direction.through);
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
  // Select the lobe by u_lobe and rescale the remainder to [0, 1). A lobe of probability 0 is never selected, even if rounding
  // leaves u beyond the last sum.
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
  const B none = uniform<F>(false);
  Direction direction{V(zero), V(zero), V(zero), V(zero), V(zero), zero, none, none, none, none, none, V(zero)};
  if (any(cosines))
    direction.cosine = warp_cosine_hemisphere(u, v);
  if (any(visible))
    direction.facet = ggx_sample_visible(seen, alpha_x, alpha_y, u, v);

  // Sample each lane's direction and transform it to world space.
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
    if (is_subsurface(lobe)) {
      result.entered = result.entered | mine;
      result.below_color = select(mine, lobe.f90, result.below_color);
      result.below_radius = select(mine, lobe.f0, result.below_radius);
      result.below_g = select(mine, lobe.shininess, result.below_g);
      result.below_ior = select(mine, lobe.ior, result.below_ior);
      result.below_variant = select(mine, numbered(static_cast<int>(lobe.variant)), result.below_variant);
    } else if (lobe.component == Component::Diffuse || is_matte(lobe, Matte::Velvet)) {
      result.diffuse = result.diffuse | mine;
    }
  }
  for (int i = 0; i < frame_count; ++i) {
    const B standing = equal(frame, numbered(i));
    if (any(standing))
      result.wi = select(standing, frames[i].to_world(direction.wi), result.wi);
  }
  Local local;
  turn_to_frames(result.wi, frame, direction.wi, direction.single, local);
  const B through = direction.through;
  result.transmitted = through;
  result.delta = direction.single;
  // Fibres have no horizon.
  const B off_horizon = direction.wi.z != zero;
  B valid = direction.valid;
  for (int i = 0; i < count; ++i) {
    const B mine = equal(chosen, numbered(i));
    if (any(mine))
      valid =
          valid & ((!mine) | ((uniform<F>(is_hair(lobes[i])) | off_horizon) & draws_on_side(lobes[i], through, local.cos_ng)));
  }

  // Weight by the sum over all smooth lobes, not by the selected lobe alone. h is the sampler's half vector with all of its
  // digits.
  const B single = valid & direction.single, spread = valid & !direction.single;
  result.weight = select(single, direction.weight, V(zero));
  result.pdf = select(single, direction.probability, zero);
  result.alpha2 = select(single, zero, result.alpha2);
  for (int k = 0; k < 2 && shares; ++k)
    result.share[k] = select(single & equal(result.component, numbered(k)), V(one), V(zero));
  if (any(spread)) {
    const BsdfValue<F> value =
        sum(local, {chosen, frame, direction.has_h, direction.h, direction.has_value, direction.value}, true);
    const B found = spread & (value.pdf > zero);
    const V f = value.f();
    result.weight = select(found, f / value.pdf, result.weight);
    result.pdf = select(found, value.pdf, result.pdf);
    if (spreads)
      result.mean_alpha2 = select(found, value.alpha2 / value.pdf, zero);
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
