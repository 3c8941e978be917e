// What the kernels of one block have in common: its bits, and the lobes that they leave each other. For kernels only.
#pragma once

#include "bsdf/bsdf.h"
#include "integrator/stages/vertex_kernel.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE uint32_t placed_bits(M m, int first) { return bits(m) << first; }

// The lobes of the lanes from first on: kept from VertexKernel::lobes() to the kernels that follow.
LANCER_LANE Bsdf<F> &lobes_of(VertexBlock &block, int first) {
  return reinterpret_cast<Bsdf<F> *>(block.lobes)[first / kLanes];
}

} // namespace
} // namespace lancer
