// Shading of path vertices in lanes: the surface, its lobes, the choice of a light, scattering.
#pragma once

#include "accel/kernel_choice.h"
#include "integrator/vertex_block.h"

namespace lancer {

struct VertexKernel {
  // In this order; nodes are asked after the first, other lights than lamps before the last.
  void (*surfaces)(VertexBlock &block);
  void (*lobes)(VertexBlock &block);
  void (*describe)(VertexBlock &block);
  void (*choose)(VertexBlock &block);
  void (*scatter)(VertexBlock &block);
  // Bits of the lanes that may meet the light; no other does.
  uint32_t (*meets)(const WayBlock &ways, const Light &light);
  size_t lobes_bytes;
};
LANCER_DECLARE_KERNEL(VertexKernel, vertex_kernel)

} // namespace lancer
