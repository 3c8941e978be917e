// Shared parts of the kernels of one block: its bits, and the lobes that kernels pass on to each other. For kernels only.
#pragma once

#include "bsdf/bsdf.h"
#include "integrator/stages/vertex_kernel.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE uint32_t placed_bits(M m, int first) { return bits(m) << first; }

// Returns the lobes of the lanes from the given one on, which VertexKernel::lobes() leaves for the following kernels.
LANCER_LANE Bsdf<F> &lobes_of(VertexBlock &block, int first) {
  return reinterpret_cast<Bsdf<F> *>(block.lobes)[first / kLanes];
}

} // namespace
} // namespace lancer
