// Sampler::get8() for many lanes at once. For kernels only, like simd/lanes.h.
#pragma once

#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE U reverse_bits(U x) {
  x = (x >> 16) | (x << 16);
  x = ((x & U(0xff00ff00u)) >> 8) | ((x & U(0x00ff00ffu)) << 8);
  x = ((x & U(0xf0f0f0f0u)) >> 4) | ((x & U(0x0f0f0f0fu)) << 4);
  x = ((x & U(0xccccccccu)) >> 2) | ((x & U(0x33333333u)) << 2);
  return ((x & U(0xaaaaaaaau)) >> 1) | ((x & U(0x55555555u)) << 1);
}

LANCER_LANE U hash(U x) {
  x = x ^ (x >> 16);
  x = x * U(0x85ebca6bu);
  x = x ^ (x >> 13);
  x = x * U(0xc2b2ae35u);
  return x ^ (x >> 16);
}
LANCER_LANE U hash_combine(U h, U value) { return hash((h ^ value * U(0x9e3779b1u)) + U(0x7f4a7c15u)); }

LANCER_LANE U nested_scramble(U x, U seed) {
  x = x ^ (x * U(0x3d20adeau));
  x = x + seed;
  x = x * ((seed >> 16) | U(1u));
  x = x ^ (x * U(0x05526c56u));
  return x ^ (x * U(0x53a22864u));
}

LANCER_LANE U reversed_second_dimension(U index) {
  index = index ^ ((index & U(0xaaaaaaaau)) >> 1);
  index = index ^ ((index & U(0xccccccccu)) >> 2);
  index = index ^ ((index & U(0xf0f0f0f0u)) >> 4);
  index = index ^ ((index & U(0xff00ff00u)) >> 8);
  return index ^ (index >> 16);
}

LANCER_LANE F scrambled(U reversed, U pixel, uint32_t dimension) {
  const U x = reverse_bits(nested_scramble(reversed, hash_combine(pixel, U(dimension))));
  return to_float(x >> 8) * F(0x1p-24f);
}

// One number of a joint dimension, whose digits all lanes share.
LANCER_LANE F joint_number(U pixel, uint32_t dimension, uint32_t reversed_point) {
  return scrambled(U(reversed_point), pixel, dimension);
}

// Two numbers of a pair of later dimensions, the first of them even.
LANCER_LANE void pair_numbers(U pixel, uint32_t dimension, uint32_t reversed_sample, F &first, F &second) {
  const U key = hash_combine(pixel, U(0x80000000u | dimension / 2));
  const U index = reverse_bits(nested_scramble(U(reversed_sample), key));
  first = scrambled(index, pixel, dimension);
  second = scrambled(reversed_second_dimension(index), pixel, dimension + 1);
}

} // namespace
} // namespace lancer
