// Lights of the scene as described, and of the objects that emit, in the normalised world.
#pragma once

#include "accel/accelerator.h"
#include "lights/emitter.h"
#include "lights/light.h"
#include "scene/affine.h"

namespace lancer {

// A light as described becomes one of the normalised world.
Light place_light(const LightDescription &from, const Normalisation &normalisation);

// Which objects of a scene are lights.

// One for each instance that has something to sample. Instances of one mesh with the same materials share the tree of its
// faces.
std::vector<Emitter> make_emitters(const Geometry &geometry, const std::vector<uint32_t> &slots,
                                   const std::vector<Material> &materials, const EmissionAt &emission,
                                   const BuildContext &context);

} // namespace lancer
