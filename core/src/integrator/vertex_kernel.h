// Shading of path vertices in vector registers, one copy per instruction set; all give the same bits, and those of the general
// code: surface_at(), Sampler, LightSet::choose(), sample() of lights, Bsdf, leave().
#pragma once

#include "accel/kernel_choice.h"
#include "integrator/vertex_block.h"

namespace lancer {

struct VertexKernel {
  const char *name;
  void (*surfaces)(VertexBlock &block);
  void (*choose)(VertexBlock &block);
  void (*shade)(VertexBlock &block);
  // Bits of the lanes that may meet the light; no other does.
  uint32_t (*meets)(const WayBlock &ways, const Light &light);
};

// Each is the same source, vertex_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(VertexKernel, vertex_kernel)

} // namespace lancer
