// The value of Huang's fibre: an integral over the fibre's width by Simpson's rule, in whose nodes light within the fibre is
// sampled, as in Cycles. Values are f cos(wi) without the colour.
#pragma once

#include "bsdf/huang.h"
#include "sampling/sobol.h"

namespace lancer {

// Numbers in [0, 1) of one estimate, by the key of its place.
template <class F> LANCER_LANE F number_of(const WordOf<F> &word) { return to_float(word >> 8) * F(0x1p-24f); }
template <class F> struct EstimateNumbers {
  WordOf<F> key;
  LANCER_LANE WordOf<F> word(uint32_t number) const { return hash_combine(key, WordOf<F>(number)); }
  LANCER_LANE F operator()(uint32_t number) const { return number_of<F>(word(number)); }
};

// The part of the width that wo sees: from offset low to high across the fibre since Blender 4.5, before from angle to angle.
template <class F> struct FibreWidth {
  F low, high;
  MaskOf<F> seen;
};
template <class F> LANCER_LANE bool goes_by_angle(const Lobe<F> &lobe) { return lobe.rules < Rules::Blender45; }
template <class F> LANCER_LANE FibreWidth<F> seen_width(const Lobe<F> &lobe, const Vec3<F> &wo) {
  // Scales hide the sides of the fibre where wo comes from below them.
  const F zero(0.0f), cosine = max(zero, quotient(-lobe.b.x * wo.x, lobe.b.y * cosine_of(wo.x)));
  const F y = lobe.alpha_y * cosine, sine = cosine_of(cosine), across = sqrt(y * y + sine * sine);
  F high;
  if (goes_by_angle(lobe))
    high = atan2(sine, y) - 1e-3f;
  else
    high = min(select(across > zero, sine / across, F(1.0f)), F(0.999f));
  return {-high, high, MaskOf<F>((cosine <= 1.0f) & (high > zero))};
}

// Calls add(place, weight, lanes) at every node of the rule, with distances of at most `resolution`; returns the factor of the
// sum.
template <class F, class Add>
LANCER_LANE F sum_over_width(const Lobe<F> &lobe, const FibreWidth<F> &width, F resolution, const Add &add) {
  const F range = width.high - width.low, count = 2.0f * ceil(range / resolution * 0.5f), step = range / count;
  for (int i = 0;; ++i) {
    const F number(static_cast<float>(i));
    const MaskOf<F> here = width.seen & (number <= count);
    if (!any(here))
      return step * (2.0f / 3.0f);
    const F at = width.low + number * step;
    const MaskOf<F> is_end = uniform<F>(i == 0) | (number == count);
    F weight = select(is_end, F(0.5f), F(i % 2 == 0 ? 1.0f : 2.0f));
    F sine = -at, cosine;
    if (goes_by_angle(lobe)) {
      const F turns = at * (0.5f * kInvPi);
      const SinCos<F> angle = sin_cos_turn(select(turns < 0.0f, turns + 1.0f, turns));
      sine = angle.sin;
      cosine = angle.cos;
    } else {
      cosine = cosine_of(at);
      weight = weight / cosine;
    }
    add(fibre_place(lobe, sine, cosine, lobe.b.x), weight, here);
  }
}

// Adds a term in the lanes where it is finite and above 0.
template <class F> LANCER_LANE void add_finite(Vec3<F> &sum, const MaskOf<F> &lanes, const Vec3<F> &term) {
  const F size = term.x + term.y + term.z;
  sum = select(lanes & (size > 0.0f) & is_finite(size), sum + term, sum);
}

// The light that the fibre's surface reflects.
template <class F>
LANCER_LANE F huang_reflected(const Lobe<F> &lobe, const FibreWidth<F> &width, const Vec3<F> &wo, const Vec3<F> &wi) {
  const Vec3<F> h = half_vector(wo, wi);
  F sum(0.0f);
  const auto add = [&](const FibrePlace<F> &place, F weight, MaskOf<F> here) __attribute__((always_inline)) {
    const F cos_m = dot(place.scale, wo), seen = both_seen(lobe, cos_m, dot(place.scale, wi));
    const F term = weight * huang_d(lobe, place.scale, h) * seen * place.arc * huang_energy(lobe, cos_m, lobe.ior);
    const MaskOf<F> there = here & are_above(wo, place.normal, h) & are_above(wi, place.normal, h);
    sum = select(there & is_finite(term), sum + term, sum);
  };
  const F factor = sum_over_width(lobe, width, F(lobe.alpha_x * 0.7f), add);
  return factor * sum * (0.25f * lobe.f90.x) * fresnel_dielectric(abs(dot(wo, h)), lobe.ior);
}

// Light from w within, which the facet between both refracts into wi at a place: its density, visibility and stretch of angles.
template <class F> struct FibreExit {
  F value;
  MaskOf<F> there;
};
template <class F>
LANCER_LANE FibreExit<F> leave_fibre(const Lobe<F> &lobe, const FibrePlace<F> &place, const Vec3<F> &w, const Vec3<F> &wi) {
  const F zero(0.0f), one(1.0f), inv = one / lobe.ior;
  const Vec3<F> sum = w + inv * wi;
  const F length2 = dot(sum, sum);
  const Vec3<F> h = sum / sqrt(length2);
  const F cos_i = dot(w, h), cos_o = -dot(wi, h);
  // As in Cycles, a direction is reached up to just beyond total reflection.
  const MaskOf<F> refracts = -dot(wi, w) >= inv - 1e-5f;
  return {(one - fresnel_dielectric(cos_i, inv)) * huang_d(lobe, place.scale, h) *
              both_seen(lobe, dot(place.scale, w), -dot(wi, place.scale)) * (cos_i * cos_o / length2) * place.arc,
          MaskOf<F>(refracts & (dot(place.scale, h) >= zero) & (cos_i > zero) & (cos_o > zero))};
}

// The light that has been within the fibre. numbers: of this estimate.
template <class F>
LANCER_LANE Vec3<F> huang_residual(const Lobe<F> &lobe, const FibreWidth<F> &width, const Vec3<F> &wo, const Vec3<F> &wi,
                                   const EstimateNumbers<F> &numbers) {
  using V = Vec3<F>;
  using U = WordOf<F>;
  const F zero(0.0f), one(1.0f), inv = one / lobe.ior;
  const MaskOf<F> passes = lobe.f90.y > zero, returns = lobe.f90.z > zero;
  FibreWidth<F> part = width;
  part.seen = part.seen & (passes | returns);
  // The numbers of the nodes are points of a lattice, moved at random: the generalised golden ratio of four dimensions.
  U u[4] = {numbers.word(0), numbers.word(1), numbers.word(2), numbers.word(3)};
  const U onwards[4] = {U(3679390609u), U(3152041523u), U(2700274806u), U(2313257605u)};
  V through(zero), back(zero), rest(zero);
  const auto add = [&](const FibrePlace<F> &first, F weight, MaskOf<F> here) __attribute__((always_inline)) {
    for (int k = 0; k < 4; ++k)
      u[k] = u[k] + onwards[k];
    const FibreEntry<F> entry = enter_fibre(lobe, wo, first, number_of<F>(u[0]), number_of<F>(u[1]));
    const V inwards = -entry.t;
    here = here & sees(wo, first, entry.h) & sees(inwards, first, entry.h);
    if (!any(here))
      return;
    const F cos_m1 = dot(wo, first.scale), cos_t1 = dot(inwards, first.scale), cos_m2 = dot(inwards, entry.second.scale);
    const F share = weight * entry.transmitted;
    const V within = entry.faded * (share * huang_energy(lobe, cos_m1, lobe.ior) * second_seen(lobe, cos_m1, cos_t1) *
                                    (cos_m1 / cos_t1) * huang_energy(lobe, cos_m2, inv));
    const FibreExit<F> once = leave_fibre(lobe, entry.second, inwards, wi);
    add_finite<F>(through, here & passes & once.there, within * once.value);
    here = here & returns;
    if (!any(here))
      return;
    const FibreBounce<F> bounce = bounce_within(lobe, entry, number_of<F>(u[2]), number_of<F>(u[3]));
    here = here & (dot(inwards, bounce.h) > zero);
    const MaskOf<F> seen = sees(inwards, entry.second, bounce.h) & sees(-bounce.back, entry.second, bounce.h);
    const FibreExit<F> twice = leave_fibre(lobe, bounce.third, bounce.back, wi);
    const F cos_r = -dot(entry.second.scale, bounce.back), cos_m3 = dot(bounce.third.scale, bounce.back);
    const MaskOf<F> leaves = (cos_m3 > zero) & (dot(bounce.back, bounce.third.normal) > zero) &
                             (dot(wi, bounce.third.scale) < zero) & (dot(wi, bounce.third.normal) < zero);
    const F reflected = bounce.boundary.reflectance;
    add_finite<F>(
        back, here & seen & leaves & twice.there,
        within * bounce.faded *
            (reflected * twice.value * huang_energy(lobe, cos_m3, inv) * second_seen(lobe, cos_m2, cos_r) * (cos_m2 / cos_r)));
    // The series of further reflections, each as the last one: also where all of the light is reflected.
    const F left = max(bounce.boundary.transmittance, F(1e-5f));
    const V &a = entry.faded;
    const MaskOf<F> total = !(-dot(wi, bounce.back) >= inv - 1e-5f);
    add_finite<F>(rest, here & (seen | total),
                  a * a * a * (share * reflected * reflected * left) / (V(one) - a * (one - left)));
  };
  const F factor = sum_over_width(lobe, part, F(lobe.alpha_x * 0.8f), add);
  const F along = along_fibre(wi.x, cosine_of(wi.x), wo.x, cosine_of(wo.x), F(4.0f * lobe.alpha_x));
  return factor * ((through * lobe.f90.y + back * lobe.f90.z) * (inv * inv) + rest * (along * (kInvPi * kInvPi)));
}

// key: of the numbers of this estimate. The density is 1 for every direction: Cycles weighs the samples of the fibre by it
// against those of lights, and the samples have a value of their own.
template <class F> ColorValue<F> huang_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, const WordOf<F> &key) {
  using V = Vec3<F>;
  const F zero(0.0f), one(1.0f);
  FibreWidth<F> width = seen_width(lobe, wo);
  const F cosine = cosine_of(wo.x);
  // No scale is seen from wi, or there is no plane across.
  width.seen = width.seen & (cosine > zero) & !(quotient(lobe.b.x * wi.x, lobe.b.y * cosine_of(wi.x)) < -one);
  const EstimateNumbers<F> numbers{hash_combine(hash_combine(key, as_word(wi.x)), as_word(wi.z))};
  const V value = V(huang_reflected(lobe, width, wo, wi)) + huang_residual(lobe, width, wo, wi, numbers);
  return {select(width.seen, value / (2.0f * cosine), V(zero)), one};
}

} // namespace lancer
