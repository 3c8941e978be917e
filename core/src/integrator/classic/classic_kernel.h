// The recursive ray tracer's own shading in lanes, of surfaces whose lobes VertexKernel has found.
#pragma once

#include "integrator/stages/vertex_kernel.h"
#include "simd/kernel_choice.h"

namespace lancer {

struct ClassicKernel {
  // What the surface mirrors and lets through, and where it goes.
  void (*branch)(VertexBlock &block);
  // The light of one lamp as if nothing stood between. Null: the samples of another light are given.
  void (*illuminate)(VertexBlock &block, const Light *lamp, uint32_t hidden_from);
};
LANCER_DECLARE_KERNEL(ClassicKernel, classic_kernel)

} // namespace lancer
