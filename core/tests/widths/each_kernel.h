// The copies of a kernel that this processor runs. LANCER_ISA limits them, as it limits those of a render.
#pragma once

#include "simd/processor.h"

#include <initializer_list>
#include <vector>

namespace lancer::testing {

// LANCER_LANE_KERNELS(name): pointers to the copies with lanes. LANCER_EACH_KERNEL(name): the same after the copy of one lane.
#if defined(__x86_64__)
#define LANCER_LANE_KERNELS(name) ::lancer::testing::runnable({&sse4::name, &avx2::name, &avx512::name})
#else
#define LANCER_LANE_KERNELS(name) ::lancer::testing::runnable({&generic::name})
#endif
#define LANCER_EACH_KERNEL(name) ::lancer::testing::after_one_lane(&one_lane::name, LANCER_LANE_KERNELS(name))

// Returns the first of the copies, which stand in the order of their instruction sets.
template <class Kernel> std::vector<const Kernel *> runnable(std::initializer_list<const Kernel *> copies) {
  const int count = instruction_set() >= InstructionSet::Avx512 ? 3 : instruction_set() >= InstructionSet::Avx2 ? 2 : 1;
  return {copies.begin(), copies.begin() + count};
}

template <class Kernel> std::vector<const Kernel *> after_one_lane(const Kernel *one_lane, std::vector<const Kernel *> copies) {
  copies.insert(copies.begin(), one_lane);
  return copies;
}

} // namespace lancer::testing
