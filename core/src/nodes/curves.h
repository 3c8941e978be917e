// Curves and colour ramps as tables of values at equal distances, linearly interpolated.
#pragma once

#include "simd/memory.h"
#include "simd/vectors.h"

namespace lancer {

// A table; the values of one channel are stride apart.
struct CurveTable {
  const float *values = nullptr;
  uint32_t count = 0, stride = 1;
  float low = 0.0f, high = 1.0f; // arguments of the first and the last value
  bool extrapolates = false;     // extends the first and the last line; else clamps to the end values
  bool interpolates = true;      // else the value at or before
};

template <class F> LANCER_LANE F on_curve(const CurveTable &table, uint32_t channel, const F &x) {
  using U = WordOf<F>;
  const F zero(0.0f), one(1.0f), last(static_cast<float>(table.count - 1));
  const F at = (x - F(table.low)) / F(table.high - table.low);
  const F step = min(one, max(zero, at)) * last;
  const F whole = floor(step), part = step - whole;
  const U first = truncate(whole), next = select(whole < last, first + U(1u), first);
  const U stride(table.stride), offset(channel);
  const F a = gather(table.values, first * stride + offset), b = gather(table.values, next * stride + offset);
  F value = table.interpolates ? (one - part) * a + part * b : a;
  if (table.extrapolates && any((at < zero) | (at > one)) && table.count > 1) {
    const float *end = table.values + channel + (table.count - 1) * table.stride;
    const float low = table.values[channel], high = *end;
    const F before = F(low) + F(low - table.values[channel + table.stride]) * -at * last;
    const F after = F(high) + F(high - *(end - table.stride)) * (at - one) * last;
    value = select(at < zero, before, select(at > one, after, value));
  }
  return value;
}

// The node CURVES: each channel by its own curve, or all channels by the curve of x, blended by factor.
template <class F> LANCER_LANE Vector3<F> on_curves(const CurveTable &table, const F &factor, const Vector3<F> &value) {
  const F rest = F(1.0f) - factor;
  if (table.stride < 3)
    return Vector3<F>(rest * value.x + factor * on_curve(table, 0, value.x));
  return {rest * value.x + factor * on_curve(table, 0, value.x), rest * value.y + factor * on_curve(table, 1, value.y),
          rest * value.z + factor * on_curve(table, 2, value.z)};
}

} // namespace lancer
