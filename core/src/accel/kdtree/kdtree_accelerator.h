// The kd-tree as an accelerator: a tree of instances over one tree per mesh.
#pragma once

#include "accel/accelerator.h"

namespace lancer {

std::unique_ptr<Accelerator> build_kdtree_accelerator(const Geometry &geometry, const BuildContext &context);

} // namespace lancer
