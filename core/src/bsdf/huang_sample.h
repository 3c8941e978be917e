// Sampling of Huang's fibre: the light of one offset across it and of one facet at each crossing, as in Cycles.
#pragma once

#include "bsdf/huang_eval.h"

namespace lancer {

// A direction and the light that it brings over its unknown density, which no other lobe knows: the sample's whole value, whose
// density Cycles calls 1.
template <class F> struct FibreSample {
  Vec3<F> wi, value;
  MaskOf<F> valid;
};

// u_part: chooses among the parts by their light; u: the offset across; v: the first facet, with the further numbers by key.
template <class F>
FibreSample<F> huang_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u_part, F u, F v, const WordOf<F> &key) {
  using V = Vec3<F>;
  const F zero(0.0f), one(1.0f), inv = one / lobe.ior;
  const V none(zero);
  const EstimateNumbers<F> numbers{hash_combine(hash_combine(key, as_word(u)), as_word(v))};
  const F h = 2.0f * u - 1.0f;
  const FibrePlace<F> first = fibre_place(lobe, F(-h), cosine_of(h), lobe.b.x);
  const F cos_m1 = dot(first.scale, wo);
  const FibreEntry<F> entry = enter_fibre(lobe, wo, first, v, numbers(0));
  const MaskOf<F> there = (cos_m1 >= zero) & are_above(wo, first.normal, entry.h);

  // Reflected.
  V direction[4] = {reflect_about(wo, entry.h), none, none, none}, light[4] = {none, none, none, none};
  const F energy = huang_energy(lobe, cos_m1, lobe.ior);
  const F reflected = lobe.f90.x * entry.reflected * energy * second_seen(lobe, cos_m1, dot(first.scale, direction[0]));
  add_finite<F>(light[0], there & are_above(direction[0], first.normal, entry.h), V(reflected));

  // Through the fibre.
  const V inwards = -entry.t;
  const F cos_m2 = dot(inwards, entry.second.scale);
  const FibreBounce<F> bounce = bounce_within(lobe, entry, numbers(1), numbers(2));
  MaskOf<F> within =
      there & (cos_m2 > zero) & are_above(inwards, first.normal, entry.h) & are_above(inwards, entry.second.normal, bounce.h);
  const V arrived = entry.faded * (entry.transmitted * energy * second_seen(lobe, cos_m1, dot(first.scale, inwards)) *
                                   huang_energy(lobe, cos_m2, inv));
  const auto leave = [&](int part, const V &w, const V &facet, const Fresnel<F> &boundary, const FibrePlace<F> &place, F cos_m,
                         const V &before) __attribute__((always_inline)) {
    direction[part] = refract_at(w, facet, inv, boundary.cos_t);
    const V outwards = -direction[part];
    const F cos_o = dot(place.scale, outwards);
    add_finite<F>(light[part], within & (cos_o > zero) & are_above(outwards, place.normal, facet),
                  before * (boundary.transmittance * second_seen(lobe, cos_m, cos_o)));
  };
  leave(1, inwards, bounce.h, bounce.boundary, entry.second, cos_m2, arrived * lobe.f90.y);

  // Reflected within once.
  const F cos_m3 = dot(bounce.third.scale, bounce.back);
  within = within & (cos_m3 > zero);
  const V facet = visible_facet(lobe, bounce.back, bounce.third.scale, numbers(3), numbers(4));
  const Fresnel<F> boundary = fresnel(dot(bounce.back, facet), inv);
  const V returned = arrived * bounce.faded *
                     (bounce.boundary.reflectance * huang_energy(lobe, cos_m3, inv) *
                      second_seen(lobe, cos_m2, -dot(entry.second.scale, bounce.back)));
  leave(2, bounce.back, facet, boundary, bounce.third, cos_m3, returned * lobe.f90.z);

  // Further reflections: the direction is that of Chiang's last part.
  const F variance = 4.0f * lobe.alpha_x, rest = max(numbers(5), F(1e-5f));
  const F fall = -variance * log(rest + (one - rest) * exp(-2.0f / variance));
  const F along = (fall - one) * wo.x + sqrt(max(fall * (2.0f - fall), zero)) * sin_cos_turn(numbers(6)).cos * cosine_of(wo.x);
  const F sine = min(max(along, -one), one), across = cosine_of(sine);
  const SinCos<F> turn = sin_cos_turn(numbers(7));
  direction[3] = {sine, across * turn.cos, across * turn.sin};
  const V once = sqrt(entry.faded * bounce.faded);
  const F left = max(0.5f * (bounce.boundary.transmittance + boundary.transmittance), F(1e-5f));
  add_finite<F>(light[3], within,
                returned * once / (V(one) - once * (one - left)) *
                    (boundary.reflectance * left *
                     second_seen(lobe, cos_m3, dot(bounce.third.scale, reflect_about(bounce.back, facet)))));

  // Choose a part by its mean light.
  F means[4], all(zero);
  for (int part = 0; part < 4; ++part)
    all += means[part] = mean(light[part]);
  FibreSample<F> sample{none, none, all > zero};
  F at = u_part * all;
  MaskOf<F> open = sample.valid;
  for (int part = 0; part < 4; ++part) {
    const MaskOf<F> lit = open & (means[part] > zero), here = lit & (at < means[part]);
    // Rounding may leave no part: the last one that has light stays.
    sample.wi = select(lit, direction[part], sample.wi);
    sample.value = select(lit, light[part] * (all / means[part]), sample.value);
    open = open & !here;
    at = at - means[part];
  }
  return sample;
}

} // namespace lancer
