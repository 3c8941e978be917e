// Owen's nested scrambling, and the numbers that it makes of the digits of a Sobol sequence. Digits are reversed: bit 0 is the
// first after the binary point. U is a uint32_t, or lanes of them.
#pragma once

#include "sampling/hash.h"
#include "sampling/sobol_table.h"
#include "simd/vectors.h"

namespace lancer {

// Each digit is flipped by a hash of the digits before it. Sums, and products with even numbers, carry upwards only, which is
// exactly that dependence.
template <class U> LANCER_LANE U nested_scramble(U x, std::type_identity_t<U> seed) {
  x = x ^ x * U(0x3d20adeau);
  x = x + seed;
  x = x * (seed >> 16 | U(1u));
  x = x ^ x * U(0x05526c56u);
  return x ^ x * U(0x53a22864u);
}

// The number of a dimension whose digits are given, of the pixel with this key. A float has 24 digits: the rest is cut, so that
// 1 is never reached.
template <class U> LANCER_LANE auto scrambled(U reversed, std::type_identity_t<U> pixel, uint32_t dimension) {
  const U x = sobol::reverse_bits(nested_scramble(reversed, hash_combine(pixel, U(dimension))));
  const auto whole = to_float(x >> 8);
  return whole * decltype(to_float(x))(0x1p-24f);
}

// The order in which a pair of later dimensions is taken: scrambling an index is a permutation that keeps every aligned
// power-of-two block together.
template <class U> LANCER_LANE U shuffled_index(U reversed_sample, std::type_identity_t<U> pixel, uint32_t pair) {
  return sobol::reverse_bits(nested_scramble(reversed_sample, hash_combine(pixel, U(0x80000000u | pair))));
}

// Both numbers of a pair of later dimensions, the first of them even.
template <class U> LANCER_LANE auto pair_numbers(U reversed_sample, std::type_identity_t<U> pixel, uint32_t dimension) {
  const U index = shuffled_index(reversed_sample, pixel, dimension / 2);
  return Vector2{scrambled(index, pixel, dimension), scrambled(sobol::reversed_second_dimension(index), pixel, dimension + 1)};
}

} // namespace lancer
