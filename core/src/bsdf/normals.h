// Normals and tangents of lobes, and their frames.
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/lobe.h"
#include "bsdf/matte.h"

#include <numbers>

namespace lancer {

// Returns the unit vector of v, or `otherwise` if v has no direction.
template <class V> LANCER_LANE V unit_or(const V &v, const V &otherwise) {
  const NumberOf<V> length2 = dot(v, v);
  return select((length2 > 0.0f) & (length2 < __builtin_inff()), v / sqrt(length2), otherwise);
}

// Returns n, or the shading normal if n is 0.
template <class F> LANCER_LANE Vec3<F> normal_or_shading(const Bsdf<F> &bsdf, const Vec3<F> &n) {
  if (all(black(n)))
    return bsdf.ns;
  // Normalising ns again could change a bit and create a second frame.
  return select(same(n, bsdf.ns), n, unit_or(n, bsdf.ns));
}

// reflecting_normal() returns a unit normal for reflecting lobes: n (0 = the shading normal) if the mirror direction of wo is
// above the surface. Otherwise it tilts n towards ng as little as necessary. Without bump correction, n is unchanged.
// least_rise() returns the least accepted cosine between the mirror direction and ng, which is nearly that of wo at grazing
// angles.
template <class V> LANCER_LANE NumberOf<V> least_rise(const V &wo, const V &ng) {
  using F = NumberOf<V>;
  return min(0.9f * dot(wo, ng), F(0.01f));
}
template <class V> LANCER_LANE auto reflects_above(const V &wo, const V &n, const V &ng) {
  const V mirrored = 2.0f * dot(n, wo) * n - wo;
  return same(n, ng) | (dot(ng, mirrored) >= least_rise(wo, ng));
}
template <class F> LANCER_LANE Vec3<F> reflecting_normal(const Bsdf<F> &bsdf, const Vec3<F> &n) {
  using V = Vec3<F>;
  const V normal = normal_or_shading(bsdf, n);
  if (!bsdf.bump_correction || all(same(normal, bsdf.ng)))
    return normal;
  const MaskOf<F> rises = reflects_above(bsdf.wo, normal, bsdf.ng);
  if (all(rises))
    return normal;
  const F cos_o = dot(bsdf.wo, bsdf.ng), least = least_rise(bsdf.wo, bsdf.ng);
  // In the plane of both normals wo is (x, z). The normal at angle t from ng mirrors its z to x sin(2t) + z cos(2t), which must
  // equal `least`: there are two solutions; use that on the side of the given normal.
  const V side = unit_or(normal - dot(normal, bsdf.ng) * bsdf.ng, normal);
  const F x = dot(bsdf.wo, side), z = cos_o;
  const F length2 = x * x + z * z;
  const F reach = sqrt(max(F(0.0f), length2 - least * least));
  // cos(2t) of the solution; the largest valid tilt.
  const F cos_2t = (z * least - x * reach) / length2;
  const F cos_t = sqrt(clamp01(0.5f * (1.0f + cos_2t))), sin_t = sqrt(clamp01(0.5f * (1.0f - cos_2t)));
  return select(rises, normal, normalize(sin_t * side + cos_t * bsdf.ng));
}

// Returns the normal of lobes that need not reflect: n itself, but the reflecting normal by the rules of Blender 3.
template <class F> LANCER_LANE Vec3<F> wide_normal(const Bsdf<F> &bsdf, const Vec3<F> &n, Rules rules) {
  return rules == Rules::Blender3 ? reflecting_normal(bsdf, n) : n;
}

// Rotates t about the unit axis by turns, counter-clockwise seen from its tip.
template <class F> LANCER_LANE Vec3<F> turn_about(const Vec3<F> &t, const Vec3<F> &axis, F turns) {
  const F angle = 2.0f * std::numbers::pi_v<float> * turns, c = cos(angle), s = sin(angle);
  return c * t + s * cross(axis, t) + (1.0f - c) * dot(axis, t) * axis;
}

// Returns the number of a frame about the normal n with tangent t (0 = any): the shading frame if both are 0 or the array is
// full.
template <class F> uint8_t add_frame(Bsdf<F> &bsdf, const Vec3<F> &n, const Vec3<F> &t) {
  using U = WordOf<F>;
  const auto numbered = [](int i) __attribute__((always_inline)) { return U(static_cast<uint32_t>(i)); };
  const MaskOf<F> any_tangent = black(t);
  const bool is_plain = all(any_tangent);
  if (is_plain && all(black(n)))
    return 0;
  const Vec3<F> normal = normal_or_shading(bsdf, n);
  Frame<F> frame;
  if (!is_plain)
    frame = Frame<F>(normal, t);
  // Reuse an existing frame. Every lane uses the first equal frame, so that no lane depends on its neighbours.
  const U nobody(~0u);
  U found = nobody;
  for (int i = 0; i < bsdf.frame_count; ++i) {
    MaskOf<F> will_do = equal(found, nobody) & same(bsdf.frames[i].n, normal);
    if (!is_plain)
      will_do = will_do & (any_tangent | same(bsdf.frames[i].t, frame.t));
    found = select(will_do, numbered(i), found);
  }
  for (int i = 0; i < bsdf.frame_count; ++i)
    if (all(equal(bsdf.first_same[i], found)))
      return static_cast<uint8_t>(i);
  if (bsdf.frame_count == kMaxFrames)
    return 0;
  if (is_plain)
    frame = Frame<F>(normal);
  const int added = bsdf.frame_count++;
  for (int i = 0; i < added; ++i) {
    const MaskOf<F> here = equal(found, numbered(i));
    frame.t = select(here, bsdf.frames[i].t, frame.t);
    frame.b = select(here, bsdf.frames[i].b, frame.b);
  }
  bsdf.frames[added] = frame;
  bsdf.first_same[added] = select(equal(found, nobody), numbered(added), found);
  bsdf.wo_local[added] = frame.to_local(bsdf.wo);
  return static_cast<uint8_t>(added);
}
template <class F> uint8_t add_frame(Bsdf<F> &bsdf, const Vec3<F> &n) { return add_frame(bsdf, n, Vec3<F>(F(0.0f))); }

// Bump correction where a lobe's normal and the shading normal differ: no light from behind, and a smooth terminator.

// Returns whether a lobe has a smooth terminator under bump: lobes that scatter widely, and before 5.0 velvet.
template <class F> bool ends_smoothly(const Lobe<F> &lobe) {
  if (is_matte(lobe, Matte::Velvet))
    return lobe.rules < Rules::Blender50;
  return lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen ||
         (lobe.shape == LobeShape::Toon && lobe.component == Component::Diffuse);
}

// Returns the lanes where bump attenuates a direction, as in Cycles. It attenuates a lobe's own samples only if the lobe
// reflects widely; it attenuates all other light for every lobe except velvet before 5.0.
template <class F> LANCER_LANE MaskOf<F> bump_acts(const Lobe<F> &lobe, MaskOf<F> drawn) {
  if (matte_transmits(lobe))
    return !drawn;
  if (is_matte(lobe, Matte::Velvet) && lobe.rules < Rules::Blender50)
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
// represents GGX facets whose roughness follows from its tilt.
template <class F> LANCER_LANE F conty_shadowing(F cos_ns, F cos_tilt) {
  const F one(1.0f), c = abs(cos_ns), tilt = abs(cos_tilt);
  const auto tan2 = [](F x) __attribute__((always_inline)) { return (1.0f - x) * (1.0f + x) / (x * x); };
  const F alpha2 = min(0.125f * tan2(tilt), one);
  return select((c >= one) | (tilt >= one), one, 2.0f / (1.0f + sqrt(1.0f + alpha2 * tan2(c))));
}

// Returns the factor of light at a lobe about n, for a direction with cosines cos_ns to the shading normal ns and cos_n to n.
template <class F>
LANCER_LANE F bump_factor(const Lobe<F> &lobe, const Vec3<F> &n, const Vec3<F> &ns, F cos_ns, F cos_n, bool correction) {
  const F one(1.0f), cos_tilt = dot(n, ns);
  const bool smooth_end = ends_smoothly(lobe);
  F kept = one;
  if (lobe.rules < Rules::Blender45 && smooth_end) {
    kept = chiang_shadowing(cos_ns, cos_n, cos_tilt, correction);
  } else {
    if (smooth_end && correction)
      kept = conty_shadowing(cos_ns, cos_tilt);
    // The factor is 0 if the direction is on one side of ns and on the other side of n; before 5.0, narrow lobes ignore that n
    // leans away from ns, and hair and glossy toon know no sides. Blender 3.x checks wide lobes only.
    const F tilt = smooth_end || lobe.rules >= Rules::Blender50 ? cos_tilt : one;
    const bool sided = smooth_end || (lobe.shape != LobeShape::Hair && lobe.shape != LobeShape::Toon);
    if (lobe.rules >= Rules::Blender50 || (lobe.rules != Rules::Blender3 && sided))
      kept = select(cos_ns * tilt * cos_n < 0.0f, F(0.0f), kept);
  }
  return select(same(n, ns), one, kept);
}

} // namespace lancer
