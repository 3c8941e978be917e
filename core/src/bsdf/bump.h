// Where a lobe's normal and the shading normal disagree: what bump and normal maps must not light, and how the lit side ends.
#pragma once

#include "bsdf/lobe.h"
#include "bsdf/matte.h"

namespace lancer {

// Whether the lit side of a bump ends smoothly: lobes that scatter widely.
template <class F> bool ends_smoothly(const Lobe<F> &lobe) {
  return lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen;
}

// Where bump takes light from a direction, as Cycles asks it: of what a lobe draws itself only where it reflects widely, of
// all other light of every lobe but velvet.
template <class F> LANCER_LANE MaskOf<F> bump_acts(const Lobe<F> &lobe, MaskOf<F> drawn) {
  if (matte_transmits(lobe))
    return !drawn;
  if (is_matte(lobe, Matte::Velvet))
    return drawn;
  return ends_smoothly(lobe) ? uniform<F>(true) : !drawn;
}

// Chiang, Li, Burley, "Taming the shadow terminator", 2019: a cubic in the ratio of cosines.
template <class F> LANCER_LANE F chiang_shadowing(F cos_ns, F cos_n, F cos_tilt, bool softened) {
  const F zero(0.0f), one(1.0f), ratio = cos_ns / (cos_n * cos_tilt);
  const F soft = softened ? select(ratio >= one, one, ratio * (1.0f + ratio * (1.0f - ratio))) : one;
  return select(ratio > zero, soft, zero);
}

// Conty Estevez, Lecocq, Stein, "A microfacet-based shadowing function to solve the bump terminator problem", 2019: the bump
// stands for facets of GGX whose roughness follows from its tilt.
template <class F> LANCER_LANE F conty_shadowing(F cos_ns, F cos_tilt) {
  const F one(1.0f), c = abs(cos_ns), tilt = abs(cos_tilt);
  const auto tan2 = [](F x) __attribute__((always_inline)) { return (1.0f - x) * (1.0f + x) / (x * x); };
  const F alpha2 = min(0.125f * tan2(tilt), one);
  return select((c >= one) | (tilt >= one), one, 2.0f / (1.0f + sqrt(1.0f + alpha2 * tan2(c))));
}

// What a lobe about n keeps of light from a direction with cosines cos_ns to the shading normal ns and cos_n to n.
template <class F>
LANCER_LANE F bump_factor(const Lobe<F> &lobe, const Vec3<F> &n, const Vec3<F> &ns, F cos_ns, F cos_n, bool correction) {
  const F one(1.0f), cos_tilt = dot(n, ns);
  const bool smooth_end = ends_smoothly(lobe);
  F kept = one;
  if (lobe.rules != Rules::Blender45 && smooth_end) {
    kept = chiang_shadowing(cos_ns, cos_n, cos_tilt, correction);
  } else {
    if (smooth_end && correction)
      kept = conty_shadowing(cos_ns, cos_tilt);
    // On the other side of the surface than the lobe believes; Blender 3.x asked this of wide lobes only.
    if (lobe.rules != Rules::Blender3)
      kept = select(cos_ns * cos_tilt * cos_n < 0.0f, F(0.0f), kept);
  }
  return select(same(n, ns), one, kept);
}

} // namespace lancer
