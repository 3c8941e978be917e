// Hashes of lattice cells, as in Blender's textures: the same bits for every number of lanes. U is uint32_t or lanes of it; F
// is float or lanes of it.
#pragma once

#include "simd/vectors.h"

namespace lancer {

template <class U> LANCER_LANE constexpr U rotated(const U &x, int by) { return (x << by) | (x >> (32 - by)); }

// One step of the final mixing, and of the mixing between blocks of three words, of Bob Jenkins' lookup3.
template <class U> LANCER_LANE constexpr void stir(U &x, const U &y, int by) { x = (x ^ y) - rotated(y, by); }
template <class U> LANCER_LANE constexpr void blend(U &x, U &y, const U &z, int by) {
  x = (x - y) ^ rotated(y, by);
  y = y + z;
}

// Returns lookup3 of up to four words.
template <int N, class U> LANCER_LANE constexpr U cell_hash(const U (&key)[N]) {
  const U seed(0xdeadbeefu + 4u * static_cast<uint32_t>(N) + 13u);
  U a = seed + key[0], b = seed, c = seed;
  if constexpr (N > 1)
    b = b + key[1];
  if constexpr (N > 2)
    c = c + key[2];
  if constexpr (N > 3) {
    blend(a, c, b, 4);
    blend(b, a, c, 6);
    blend(c, b, a, 8);
    blend(a, c, b, 16);
    blend(b, a, c, 19);
    blend(c, b, a, 4);
    a = a + key[3];
  }
  stir(c, b, 14);
  stir(a, c, 11);
  stir(b, a, 25);
  stir(c, b, 16);
  stir(a, c, 4);
  stir(b, a, 14);
  stir(c, b, 24);
  return c;
}

// Mixes each word of a cell with all others: the permuted congruential generator of 2, 3 or 4 words, with arithmetic shifts;
// leaves 31 bits of each.
template <class U> LANCER_LANE U halves_mixed(const U &x) {
  const U sign = U(0u) - (x >> 31);
  return x ^ ((x >> 16) | (sign << 16));
}
template <int N, class U> LANCER_LANE void cell_permutation(U (&v)[N]) {
  const U factor(1664525u);
  for (int i = 0; i < N; ++i)
    v[i] = v[i] * factor + U(1013904223u);
  for (int round = 0; round < 2; ++round) {
    if constexpr (N == 2) {
      v[0] = v[0] + v[1] * factor;
      v[1] = v[1] + v[0] * factor;
    } else {
      v[0] = v[0] + v[1] * v[N - 1];
      v[1] = v[1] + v[2] * v[0];
      v[2] = v[2] + v[0] * v[1];
      if constexpr (N == 4)
        v[3] = v[3] + v[1] * v[2];
    }
    for (int i = 0; i < N && round == 0; ++i)
      v[i] = halves_mixed(v[i]);
  }
  for (int i = 0; i < N; ++i)
    v[i] = v[i] & U(0x7fffffffu);
}

// Maps a word to 0 ... 1. Both halves are exact, so that only their sum is rounded.
template <class F> LANCER_LANE F unit_of(const WordOf<F> &x) {
  return (to_float(x >> 16) * F(65536.0f) + to_float(x & WordOf<F>(0xffffu))) * F(0x1p-32f);
}

// Converts a whole float to an integer; the smallest integer if it does not fit, as processors convert.
template <class F> LANCER_LANE WordOf<F> cell_of(const F &whole) {
  const MaskOf<F> fits = abs(whole) < F(0x1p31f);
  return select(fits, truncate(select(fits, whole, F(0.0f))), WordOf<F>(0x80000000u));
}

} // namespace lancer
