// Whether a BSDF has room for all that can come of a material.
#pragma once

#include "scene/description.h"

namespace lancer {

// The most lobes, and frames (normals with a tangent or without, the shading normal's among them), that can meet at one place.
struct MaterialDemand {
  size_t lobes = 0, frames = 1;
};
MaterialDemand demand_of(const Material &material);

// Says what is left out where that is more than a BSDF holds.
void report_limits(const std::string &object, const Material &material, Messages &messages);

} // namespace lancer
