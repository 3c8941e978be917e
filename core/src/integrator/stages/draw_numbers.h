// Random numbers of vertices in lanes, from the digits of their samples.
#pragma once

#include "integrator/stages/vertex_kernel.h"
#include "sampling/scramble.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// Draws the numbers of u whose bits are set in wanted, in the lanes from the given one on. Numbers beyond kJointDimensions are
// drawn in pairs.
LANCER_LANE void draw_numbers(VertexBlock &block, int first, uint32_t wanted) {
  const U pixel = load(block.pixel + first);
  for (uint32_t i = 0; i < 8; i += 2) {
    if (!(wanted >> i & 3))
      continue;
    const uint32_t dimension = block.dimension + i;
    Vector2<F> u;
    if (dimension < kJointDimensions)
      u = {scrambled(load(block.reversed_point[i] + first), pixel, dimension),
           scrambled(load(block.reversed_point[i + 1] + first), pixel, dimension + 1)};
    else
      u = pair_numbers(load(block.reversed_sample + first), pixel, dimension);
    if (wanted >> i & 1)
      store(block.u[i] + first, u.x);
    if (wanted >> i & 2)
      store(block.u[i + 1] + first, u.y);
  }
}

} // namespace
} // namespace lancer
