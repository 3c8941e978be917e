// The random numbers of samples. Each number has an address, and the same address always gives the same number.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "sampling/scramble.h"

namespace lancer {

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
