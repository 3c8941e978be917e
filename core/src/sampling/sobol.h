// The random numbers of samples. Each number has an address, and the same address always gives the same number.
#pragma once

#include "simd/scalar.h"
#include "simd/vectors.h"

#include <array>
#include <glm/glm.hpp>
#include <type_traits>

namespace lancer {

// Integer hashes of an address. U is uint32_t or lanes of it.

// A bijection of 32 bits in which every input bit flips every output bit with a probability near one half.
template <class U> LANCER_LANE constexpr U hash(U x) {
  static_assert(!std::is_signed_v<U>);
  x = x ^ (x >> 16);
  x = x * U(0x85ebca6bu);
  x = x ^ (x >> 13);
  x = x * U(0xc2b2ae35u);
  return x ^ (x >> 16);
}

// Extends the hash h of an address by another coordinate. The result depends on the order of coordinates; for the same h,
// different values give different results.
template <class U> LANCER_LANE constexpr U hash_combine(U h, std::type_identity_t<U> value) {
  return hash((h ^ value * U(0x9e3779b1u)) + U(0x7f4a7c15u));
}

// Dimensions of one Sobol sequence: those of the camera and of two vertices.
inline constexpr uint32_t kJointDimensions = 20;

namespace sobol {

// U is uint32_t or lanes of it.
template <class U> LANCER_LANE constexpr U reverse_bits(U x) {
  x = x >> 16 | x << 16;
  x = (x & U(0xff00ff00u)) >> 8 | (x & U(0x00ff00ffu)) << 8;
  x = (x & U(0xf0f0f0f0u)) >> 4 | (x & U(0x0f0f0f0fu)) << 4;
  x = (x & U(0xccccccccu)) >> 2 | (x & U(0x33333333u)) << 2;
  return (x & U(0xaaaaaaaau)) >> 1 | (x & U(0x55555555u)) << 1;
}

using NibbleTable = std::array<std::array<std::array<uint32_t, 16>, 8>, kJointDimensions>;

// For each dimension and each group of four index bits, the sum of the generator matrix's columns, with reversed digits. The
// table of 8 KB fits in the first-level cache; a table over whole bytes (64 KB) would not. An index below 4096 takes three
// lookups.
LANCER_TABLE NibbleTable kNibbles;

// Returns a point's coordinate in a joint dimension; bit 0 is the first digit after the binary point.
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

// Owen's nested scrambling of the digits of a Sobol sequence. Digits are reversed: bit 0 is the first after the binary point. U
// is uint32_t or lanes of it.

// Flips each digit by a hash of the digits before it. Sums and products with even numbers carry upwards only, so a digit of the
// result depends on lower digits alone.
template <class U> LANCER_LANE U nested_scramble(U x, std::type_identity_t<U> seed) {
  x = x ^ x * U(0x3d20adeau);
  x = x + seed;
  x = x * (seed >> 16 | U(1u));
  x = x ^ x * U(0x05526c56u);
  return x ^ x * U(0x53a22864u);
}

// Returns the number in [0, 1) of a dimension with the given digits, for the pixel with this key. A float has 24 digits: the
// others are cut off, so that 1 is never reached.
template <class U> LANCER_LANE auto scrambled(U reversed, std::type_identity_t<U> pixel, uint32_t dimension) {
  const U x = sobol::reverse_bits(nested_scramble(reversed, hash_combine(pixel, U(dimension))));
  const auto whole = to_float(x >> 8);
  return whole * decltype(to_float(x))(0x1p-24f);
}

// Returns the order of a pair of later dimensions: scrambling an index is a permutation that keeps every aligned power-of-two
// block together.
template <class U> LANCER_LANE U shuffled_index(U reversed_sample, std::type_identity_t<U> pixel, uint32_t pair) {
  return sobol::reverse_bits(nested_scramble(reversed_sample, hash_combine(pixel, U(0x80000000u | pair))));
}

// Returns both numbers of a pair of later dimensions; dimension is even.
template <class U> LANCER_LANE auto pair_numbers(U reversed_sample, std::type_identity_t<U> pixel, uint32_t dimension) {
  const U index = shuffled_index(reversed_sample, pixel, dimension / 2);
  return Vector2{scrambled(index, pixel, dimension), scrambled(sobol::reversed_second_dimension(index), pixel, dimension + 1)};
}

// Uniform numbers in [0, 1) at the address (seed, pixel, sample, dimension). No state: any order, any thread, any split.
//   Dimensions 0 ... 19 are one Owen-scrambled Sobol sequence: every power-of-two prefix of a pixel's samples is stratified in
//   all of them together. They serve the most important choices: pixel, lens, BSDF and light of the first two vertices.
//   Dimensions from 20 on come in pairs (20, 21), (22, 23) ...: each pair is a (0, 2)-sequence in its own order.
// Pixels, seeds and dimensions are scrambled independently of each other.
class Sampler {
public:
  Sampler(uint32_t seed, uint32_t x, uint32_t y, uint32_t sample)
      : Sampler(hash_combine(hash_combine(hash(seed), x), y), sample) {}

  // Takes a known pixel() and sample().
  Sampler(uint32_t pixel, uint32_t sample) : pixel_(pixel), sample_(sample), reversed_(sobol::reverse_bits(sample)) {}

  float get1(uint32_t dimension) const { return scrambled(unscrambled(dimension), pixel_, dimension); }

  // Returns dimensions d and d + 1, d even.
  glm::vec2 get2(uint32_t dimension) const {
    if (dimension < kJointDimensions)
      return {get1(dimension), get1(dimension + 1)};
    return pair_numbers(reversed_, pixel_, dimension);
  }

  // Returns dimensions d ... d + 7, d a multiple of 4: the same numbers, computed in vector registers (a fifth of the time of
  // single ones).
  std::array<float, 8> get8(uint32_t dimension) const {
    uint32_t reversed[8];
    if (dimension < kJointDimensions) {
      for (uint32_t i = 0; i < 8; ++i)
        reversed[i] = unscrambled(dimension + i);
    } else {
      uint32_t index[4];
      for (uint32_t i = 0; i < 4; ++i)
        index[i] = shuffled_index(reversed_, pixel_, dimension / 2 + i);
      for (uint32_t i = 0; i < 4; ++i) {
        reversed[2 * i] = index[i];
        reversed[2 * i + 1] = sobol::reversed_second_dimension(index[i]);
      }
    }
    std::array<float, 8> numbers;
    for (uint32_t i = 0; i < 8; ++i)
      numbers[i] = scrambled(reversed[i], pixel_, dimension + i);
    return numbers;
  }

  // The state from which kernels generate the numbers of many pixels: the key of seed and pixel, and the sample's number.
  uint32_t pixel() const { return pixel_; }
  uint32_t sample() const { return sample_; }
  uint32_t reversed_sample() const { return reversed_; }

private:
  // Returns the digits of the sequence, reversed.
  uint32_t unscrambled(uint32_t dimension) const {
    if (dimension < kJointDimensions)
      return sobol::reversed_point(sample_, dimension);
    const uint32_t index = shuffled_index(reversed_, pixel_, dimension / 2);
    return dimension % 2 == 0 ? index : sobol::reversed_second_dimension(index);
  }

  uint32_t pixel_;
  uint32_t sample_, reversed_; // the same number with its digits in both orders
};

} // namespace lancer
