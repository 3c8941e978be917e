// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "nodes/dispatch.h"
#include "simd/kernel_lanes.h"
#include "simd/processor.h"

namespace lancer {

namespace LANCER_ISA {
const NodeKernel node_kernel = {LANCER_ISA_NAME, run_block<F>};
}

} // namespace lancer
