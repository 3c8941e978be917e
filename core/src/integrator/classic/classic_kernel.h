// Shading of the recursive ray tracer in lanes, for surfaces whose lobes VertexKernel has found.
#pragma once

#include "integrator/stages/vertex_kernel.h"
#include "simd/kernel_choice.h"

namespace lancer {

struct ClassicKernel {
  // Computes the mirrored and the transmitted share and their directions.
  void (*branch)(VertexBlock &block);
  // Computes the light of one lamp without occlusion. lamp null: the block has the samples of another light.
  void (*illuminate)(VertexBlock &block, const Light *lamp, uint32_t hidden_from);
};
LANCER_DECLARE_KERNEL(ClassicKernel, classic_kernel)

} // namespace lancer
