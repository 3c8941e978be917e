// Gradient noise of Perlin's kind in one to four dimensions: a slope at each point of the integer lattice, smoothly
// interpolated. The slopes are those of Open Shading Language, which Cycles shares.
#pragma once

#include "nodes/cell_hash.h"

namespace lancer {

constexpr float kNoisePeriod = 100000.0f;

// Returns the remainder of a division by the period, with the sign of x. Every product and difference is exact: the quotients
// have at most 30 digits and the divisor 12.
template <class F> LANCER_LANE F within_period(const F &x) {
  using D = DoubleOf<F>;
  if (!any(abs(x) >= F(kNoisePeriod)))
    return x;
  const D whole(0x1.8p52);
  D rest = widen(abs(x));
  for (const double step : {kNoisePeriod * 0x1p90, kNoisePeriod * 0x1p60, kNoisePeriod * 0x1p30, double(kNoisePeriod)}) {
    rest = rest - ((rest / D(step) + whole) - whole) * D(step);
    rest = select(rest < D(0.0), rest + D(step), rest);
  }
  return copysign(narrow(rest), x);
}

// Negates v if the bit is set.
template <class F> LANCER_LANE F negated(const F &v, const WordOf<F> &bits, int bit) {
  return as_float(as_word(v) ^ ((bits >> bit) << 31));
}

// Returns the dot product of a hash's slope and the vector d from its lattice point.
template <int N, class F> LANCER_LANE F slope_along(const WordOf<F> &hash, const F (&d)[N]) {
  using U = WordOf<F>;
  const U zero(0u);
  if constexpr (N == 1) {
    return negated(F(1.0f) + to_float(hash & U(7u)), hash, 3) * d[0];
  } else if constexpr (N == 2) {
    const MaskOf<F> first = equal(hash & U(4u), zero);
    return negated(select(first, d[0], d[1]), hash, 0) + negated(F(2.0f) * select(first, d[1], d[0]), hash, 1);
  } else if constexpr (N == 3) {
    const F u = select(equal(hash & U(8u), zero), d[0], d[1]);
    const F rest = select(equal(hash & U(13u), U(12u)), d[0], d[2]);
    const F v = select(equal(hash & U(12u), zero), d[1], rest);
    return negated(u, hash, 0) + negated(v, hash, 1);
  } else {
    const U group = hash & U(24u);
    const F u = select(equal(group, U(24u)), d[1], d[0]);
    const F v = select(equal(group & U(16u), zero), d[1], d[2]);
    const F s = select(equal(group, zero), d[2], d[3]);
    return negated(u, hash, 0) + negated(v, hash, 1) + negated(s, hash, 2);
  }
}

// Returns about -1 ... 1; 0 at lattice points, and if a coordinate is not finite. repeats: with period kNoisePeriod along each
// axis, and shifted by half a cell beyond ten periods, where floats are whole numbers.
template <int N, class F> LANCER_LANE F signed_noise(const F (&given)[N], bool repeats) {
  using U = WordOf<F>;
  constexpr float kRange[] = {0.25f, 0.6616f, 0.982f, 0.8344f}; // by N: scales extremes to about 1
  U cell[N];
  F at[N], fade[N];
  MaskOf<F> finite = is_finite(given[0]);
  for (int i = 0; i < N; ++i) {
    finite = finite & is_finite(given[i]);
    F p = select(is_finite(given[i]), given[i], F(0.0f));
    if (repeats)
      p = within_period(p) + select(abs(p) >= F(10.0f * kNoisePeriod), F(0.5f), F(0.0f));
    const F whole = floor(p);
    cell[i] = cell_of(whole);
    at[i] = p - whole;
    fade[i] = at[i] * at[i] * at[i] * (at[i] * (at[i] * F(6.0f) - F(15.0f)) + F(10.0f));
  }
  F values[1 << N];
  for (int corner = 0; corner < 1 << N; ++corner) {
    U key[N];
    F d[N];
    for (int i = 0; i < N; ++i) {
      const int step = corner >> i & 1;
      key[i] = cell[i] + U(static_cast<uint32_t>(step));
      d[i] = at[i] - F(static_cast<float>(step));
    }
    values[corner] = slope_along(cell_hash(key), d);
  }
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 1 << (N - 1 - i); ++k)
      values[k] = (F(1.0f) - fade[i]) * values[2 * k] + fade[i] * values[2 * k + 1];
  return select(finite, F(kRange[N - 1]) * values[0], F(0.0f));
}

} // namespace lancer
