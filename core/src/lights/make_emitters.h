// Which objects of a scene are lights.
#pragma once

#include "accel/accelerator.h"
#include "lights/emitter.h"

namespace lancer {

// One for each instance that has something to sample. Instances of one mesh with the same materials share the tree of its
// faces.
std::vector<Emitter> make_emitters(const Geometry &geometry, const std::vector<uint32_t> &slots,
                                   const std::vector<Material> &materials, const EmissionAt &emission,
                                   const BuildContext &context);

} // namespace lancer
