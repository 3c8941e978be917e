// Steps of commit(): limits of materials are checked, meshes displaced, lights and the objects that emit made.
#pragma once

#include "accel/accelerator.h"
#include "lights/emitter.h"
#include "lights/light.h"
#include "scene/affine.h"
#include "scene/description.h"
#include "simd/parallel.h"

namespace lancer {

// The most lobes, and frames (normals with a tangent or without, the shading normal's among them), that can meet at one place.
struct MaterialDemand {
  size_t lobes = 0, frames = 1;
};
MaterialDemand demand_of(const Material &material);

// Says what is left out where that is more than a BSDF holds.
void report_limits(const std::string &object, const Material &material, Messages &messages);

// Moves the vertices of every mesh whose materials displace, and makes their normals anew. A mesh that instances show with
// different displacing materials is copied for each list of them.
void displace(Description &description, const BuildContext &context);

// A light as described becomes one of the normalised world.
Light place_light(const LightDescription &from, const Normalisation &normalisation);

// One for each instance that has something to sample. Instances of one mesh with the same materials share the tree of its
// faces.
std::vector<Emitter> make_emitters(const Geometry &geometry, const std::vector<uint32_t> &slots,
                                   const std::vector<Material> &materials, const EmissionAt &emission,
                                   const BuildContext &context);

} // namespace lancer
