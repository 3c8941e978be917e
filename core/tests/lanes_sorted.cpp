// Entries pushed by a traversal: the kept lanes, in the requested order, in every instruction set.
#include "widths/each_kernel.h"
#include "widths/sorted_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace lancer {

namespace {

constexpr uint32_t kNumbers[8] = {900, 901, 902, 903, 904, 905, 906, 907};

void expect_order(const SortedKernel &kernel) {
  std::mt19937 random(11);
  uint32_t lanes[8];
  std::iota(std::begin(lanes), std::end(lanes), 0u);
  for (uint32_t mask = 0; mask < 256; ++mask)
    for (int round = 0; round < 20; ++round) {
      std::shuffle(std::begin(lanes), std::end(lanes), random);
      uint32_t order = 0;
      alignas(64) float key[8], end[8];
      for (uint32_t i = 0; i < 8; ++i) {
        order |= lanes[i] << 3 * i;
        key[i] = static_cast<float>(i);
        // A rejected box ends before it begins, or is NaN; a box hit in a single point is kept.
        end[i] = mask >> i & 1 ? key[i] : (i % 2 ? key[i] - 1.0f : std::numeric_limits<float>::quiet_NaN());
      }
      float keys[16];
      uint32_t numbers[16], count = 0;
      const uint32_t kept = kernel.ordered(keys, numbers, key, end, kNumbers, order);
      for (const uint32_t lane : lanes)
        if (mask >> lane & 1) {
          ASSERT_LT(count, kept) << kernel.name << ", mask " << mask;
          ASSERT_EQ(keys[count], key[lane]) << kernel.name << ", mask " << mask;
          ASSERT_EQ(numbers[count++], kNumbers[lane]) << kernel.name << ", mask " << mask;
        }
      ASSERT_EQ(kept, count) << kernel.name << ", mask " << mask;
    }
}

void expect_limit(const SortedKernel &kernel) {
  constexpr float kLimit = 2.0f;
  for (uint32_t mask = 0; mask < 256; ++mask)
    for (uint32_t looked_at = 0; looked_at <= 9; ++looked_at) {
      float key[16] = {}, keys[16];
      uint32_t number[16] = {}, numbers[16], count = 0;
      for (uint32_t i = 0; i < 8; ++i) {
        key[i] = mask >> i & 1 ? kLimit - static_cast<float>(i) : kLimit + 1.0f;
        number[i] = kNumbers[i];
      }
      const uint32_t kept = kernel.below(keys, numbers, key, number, looked_at, kLimit);
      for (uint32_t i = 0; i < std::min(looked_at, 8u); ++i)
        if (mask >> i & 1) {
          ASSERT_LT(count, kept) << kernel.name << ", mask " << mask;
          ASSERT_EQ(keys[count], key[i]) << kernel.name << ", mask " << mask;
          ASSERT_EQ(numbers[count++], kNumbers[i]) << kernel.name << ", mask " << mask;
        }
      ASSERT_EQ(kept, count) << kernel.name << ", mask " << mask;
    }
}

TEST(Lanes, AreKeptInTheOrderAskedFor) {
  for (const SortedKernel *kernel : LANCER_LANE_KERNELS(sorted_kernel))
    expect_order(*kernel);
}

TEST(Lanes, AreKeptBelowALimit) {
  for (const SortedKernel *kernel : LANCER_LANE_KERNELS(sorted_kernel))
    expect_limit(*kernel);
}

} // namespace
} // namespace lancer
