// The wide BVH as an accelerator: a tree of instances over one tree per mesh.
#pragma once

#include "accel/accelerator.h"

namespace lancer {

// The environment variable LANCER_ISA (sse4, avx2, avx512) forces a lesser instruction set than the processor has.
std::unique_ptr<Accelerator> build_bvh(const Geometry &geometry, const BuildContext &context);

} // namespace lancer
