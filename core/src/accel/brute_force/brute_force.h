// Every ray against every primitive: the oracle that the other accelerators must equal.
#pragma once

#include "accel/accelerator.h"

namespace lancer {

std::unique_ptr<Accelerator> build_brute_force(const Geometry &geometry);

} // namespace lancer
