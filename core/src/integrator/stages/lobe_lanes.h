// The lobes that the surface stage's kernel leaves for the kernels of the stages after it. For kernels only.
#pragma once

#include "bsdf/bsdf.h"
#include "integrator/stages/surface.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE uint32_t placed_bits(M m, int first) { return bits(m) << first; }

// Returns the lobes of the lanes from the given one on.
LANCER_LANE Bsdf<F> &lobes_of(const LobeBlock &block, int first) {
  return reinterpret_cast<Bsdf<F> *>(block.storage)[first / kLanes];
}

} // namespace
} // namespace lancer
