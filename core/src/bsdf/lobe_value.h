// What every smooth lobe answers. Directions are in the local frame, turned so that wo.z > 0 and wi.z > 0.
#pragma once

#include "simd/vectors.h"

namespace lancer {

template <class F> struct LobeValue {
  F f{0.0f};   // without the lobe's colour and without the cosine, 1/sr
  F pdf{0.0f}; // per solid angle of wi
};

// Coloured, with the cosine in it; pdf per solid angle of wi.
template <class F> struct ColorValue {
  Vec3<F> f{F(0.0f)};
  F pdf{0.0f};
};
template <class F> LANCER_LANE ColorValue<F> where(const MaskOf<F> &m, const ColorValue<F> &value) {
  return {select(m, value.f, Vec3<F>(F(0.0f))), select(m, value.pdf, F(0.0f))};
}
template <class F> LANCER_LANE LobeValue<F> where(const MaskOf<F> &m, const LobeValue<F> &value) {
  return {select(m, value.f, F(0.0f)), select(m, value.pdf, F(0.0f))};
}

// The zero vector where both directions are so close to the horizon that nothing is left of their sum.
template <class V> LANCER_LANE V half_vector(const V &wo, const V &wi) {
  using F = NumberOf<V>;
  const V sum = wo + wi;
  const F length2 = dot(sum, sum);
  return select(length2 > 0.0f, sum / sqrt(length2), V(F(0.0f)));
}

template <class V> LANCER_LANE V reflect_about(const V &wo, const V &h) { return 2.0f * dot(wo, h) * h - wo; }

} // namespace lancer
