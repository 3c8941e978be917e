// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/numbers.h"

#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// Numbers beyond kJointDimensions are drawn in pairs.
[[gnu::flatten]] void draw(const SampleDigits &digits, uint32_t wanted, uint32_t count, VertexNumbers &numbers) {
  for (uint32_t first = 0; first < count; first += kLanes) {
    const U pixel = load(digits.pixel + first);
    for (uint32_t i = 0; i < kVertexStride; i += 2) {
      if (!(wanted >> i & 3))
        continue;
      const uint32_t dimension = digits.dimension + i;
      Vector2<F> u;
      if (dimension < kJointDimensions)
        u = {scrambled(load(digits.reversed_point[i] + first), pixel, dimension),
             scrambled(load(digits.reversed_point[i + 1] + first), pixel, dimension + 1)};
      else
        u = pair_numbers(load(digits.reversed_sample + first), pixel, dimension);
      if (wanted >> i & 1)
        store(numbers.of[i] + first, u.x);
      if (wanted >> i & 2)
        store(numbers.of[i + 1] + first, u.y);
    }
  }
}

} // namespace

namespace LANCER_ISA {
const NumberKernel number_kernel = {draw};
}

} // namespace lancer
