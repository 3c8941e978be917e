// The normals and tangents that lobes stand about, and their frames.
#pragma once

#include "bsdf/bsdf.h"

#include <numbers>

namespace lancer {

// v of length 1; another where it has no direction.
template <class V> LANCER_LANE V unit_or(const V &v, const V &otherwise) {
  const NumberOf<V> length2 = dot(v, v);
  return select((length2 > 0.0f) & (length2 < __builtin_inff()), v / sqrt(length2), otherwise);
}

// n itself or, where it is 0, the shading normal.
template <class F> LANCER_LANE Vec3<F> normal_or_shading(const Bsdf<F> &bsdf, const Vec3<F> &n) {
  if (all(black(n)))
    return bsdf.ns;
  // To normalise once more might move it by a bit, and make a second frame of the first.
  return select(same(n, bsdf.ns), n, unit_or(n, bsdf.ns));
}

// A unit normal for lobes that reflect: n (0 = the shading normal) if what it mirrors from wo stays above the surface, else
// turned towards ng just far enough. As it is where the material wants no bump correction.
// The mirrored direction shall rise above the surface by this cosine, or nearly as much as wo does.
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
  // In the plane of both normals wo is (x, z). The normal at angle t from ng mirrors its z to x sin(2t) + z cos(2t), which is
  // to be least: the sine and cosine of the two angles where it is, taken on the side towards the given normal.
  const V side = unit_or(normal - dot(normal, bsdf.ng) * bsdf.ng, normal);
  const F x = dot(bsdf.wo, side), z = cos_o;
  const F length2 = x * x + z * z;
  const F reach = sqrt(max(F(0.0f), length2 - least * least));
  // cos(2t) of the solution; the tilt is the largest that still works.
  const F cos_2t = (z * least - x * reach) / length2;
  const F cos_t = sqrt(clamp01(0.5f * (1.0f + cos_2t))), sin_t = sqrt(clamp01(0.5f * (1.0f - cos_2t)));
  return select(rises, normal, normalize(sin_t * side + cos_t * bsdf.ng));
}

// The normal of lobes that need not reflect: as it is given; Blender 3.x bent it, too.
template <class F> LANCER_LANE Vec3<F> wide_normal(const Bsdf<F> &bsdf, const Vec3<F> &n, Rules rules) {
  return rules == Rules::Blender3 ? reflecting_normal(bsdf, n) : n;
}

// t turned about the unit axis by turns, counter-clockwise seen from its tip.
template <class F> LANCER_LANE Vec3<F> turn_about(const Vec3<F> &t, const Vec3<F> &axis, F turns) {
  const F angle = 2.0f * std::numbers::pi_v<float> * turns, c = cos(angle), s = sin(angle);
  return c * t + s * cross(axis, t) + (1.0f - c) * dot(axis, t) * axis;
}

// The number of a frame about the normal n with tangent t (0 = any); the shading frame where both are 0. Where room is out, the
// shading frame.
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
  // One that is there already will do: in every lane the first, so that no lane depends on its neighbours.
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

} // namespace lancer
