// The Sobol sequence of Joe and Kuo in 16 dimensions.
#pragma once

#include "simd/scalar.h"

#include <array>

namespace lancer {

inline constexpr uint32_t kJointDimensions = 16;

namespace sobol {

// U is a uint32_t, or lanes of them.
template <class U> LANCER_LANE constexpr U reverse_bits(U x) {
  x = x >> 16 | x << 16;
  x = (x & U(0xff00ff00u)) >> 8 | (x & U(0x00ff00ffu)) << 8;
  x = (x & U(0xf0f0f0f0u)) >> 4 | (x & U(0x0f0f0f0fu)) << 4;
  x = (x & U(0xccccccccu)) >> 2 | (x & U(0x33333333u)) << 2;
  return (x & U(0xaaaaaaaau)) >> 1 | (x & U(0x55555555u)) << 1;
}

using NibbleTable = std::array<std::array<std::array<uint32_t, 16>, 8>, kJointDimensions>;

// For each dimension and each group of four index bits the sum of the generator matrix's columns, digits reversed. 8 KB stay in
// the first-level cache, where a table over whole bytes (64 KB) would not; an index below 4096 takes three look-ups.
extern const NibbleTable kNibbles;

// Coordinate of point index in a joint dimension; bit 0 is the first digit after the binary point.
inline uint32_t reversed_point(uint32_t index, uint32_t dimension) {
  const auto &table = kNibbles[dimension];
  uint32_t x = 0;
  for (uint32_t group = 0; index != 0; ++group, index >>= 4)
    x ^= table[group][index & 15];
  return x;
}

// The second Sobol dimension is Pascal's triangle modulo 2, which factors into five shifts; the first is the index itself.
template <class U> LANCER_LANE constexpr U reversed_second_dimension(U index) {
  index = index ^ (index & U(0xaaaaaaaau)) >> 1;
  index = index ^ (index & U(0xccccccccu)) >> 2;
  index = index ^ (index & U(0xf0f0f0f0u)) >> 4;
  index = index ^ (index & U(0xff00ff00u)) >> 8;
  return index ^ index >> 16;
}

} // namespace sobol
} // namespace lancer
