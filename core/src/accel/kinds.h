// The accelerators that there are, each by itself.
#pragma once

#include "accel/accelerator.h"

namespace lancer {

// A tree of instances over one wide tree per mesh. The environment variable LANCER_ISA (sse4, avx2, avx512) forces a lesser
// instruction set than the processor has.
std::unique_ptr<Accelerator> build_bvh(const Geometry &geometry, const BuildContext &context);
// A kd-tree of instances over one per mesh.
std::unique_ptr<Accelerator> build_kdtree_accelerator(const Geometry &geometry, const BuildContext &context);
// Every ray against every primitive: the oracle that the other accelerators must equal.
std::unique_ptr<Accelerator> build_brute_force(const Geometry &geometry);

} // namespace lancer
