// The functions of simd/sorted_lanes.h for eight lanes, one copy per instruction set.
#pragma once

#include "simd/processor.h"

#include <cstdint>

namespace lancer {

struct SortedKernel {
  const char *name;
  // keep_ordered() of eight keys and their ends, aligned to 64 bytes.
  uint32_t (*ordered)(float *keys, uint32_t *numbers, const float *key, const float *end, const uint32_t *number,
                      uint32_t order);
  // keep_below().
  uint32_t (*below)(float *keys, uint32_t *numbers, const float *key, const uint32_t *number, uint32_t count, float limit);
};

// Each is the same source, sorted_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(SortedKernel, sorted_kernel)

} // namespace lancer
