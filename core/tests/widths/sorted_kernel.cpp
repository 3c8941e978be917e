// Compiled once per instruction set, with LANCER_ISA naming it.
#include "widths/sorted_kernel.h"

#include "simd/kernel_lanes.h"
#include "simd/sorted_lanes.h"

namespace lancer {
namespace {

uint32_t ordered(float *keys, uint32_t *numbers, const float *key, const float *end, const uint32_t *number, uint32_t order) {
  constexpr int kWidth = kLanes < 8 ? kLanes : 8;
  Float<kWidth> k[8 / kWidth], e[8 / kWidth];
  for (int i = 0; i < 8 / kWidth; ++i) {
    k[i] = load_lanes<kWidth>(key + i * kWidth);
    e[i] = load_lanes<kWidth>(end + i * kWidth);
  }
  return keep_ordered<kWidth>(keys, numbers, k, e, number, order);
}

uint32_t below(float *keys, uint32_t *numbers, const float *key, const uint32_t *number, uint32_t count, float limit) {
  return keep_below(keys, numbers, key, number, count, limit);
}

} // namespace

namespace LANCER_ISA {
const SortedKernel sorted_kernel = {LANCER_ISA_NAME, ordered, below};
}

} // namespace lancer
