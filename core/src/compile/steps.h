// Steps of commit(): check the limits of materials, displace meshes, make lights and emitters.
#pragma once

#include "accel/accelerator.h"
#include "bsdf/material_lobes.h"
#include "lights/emitter.h"
#include "lights/light.h"
#include "scene/affine.h"
#include "scene/description.h"
#include "simd/parallel.h"

namespace lancer {

// The largest numbers of lobes and frames that can overlap at one place. A frame is a normal with or without a tangent; the
// shading normal's frame counts.
struct MaterialDemand {
  size_t lobes = 0, frames = 1;
};
MaterialDemand demand_of(const Material &material);

// Reports the lobes and frames that exceed the capacity of a BSDF.
void report_limits(const std::string &object, const Material &material, Messages &messages);

// Computes the parts of each lobe that are the same at every hit.
std::shared_ptr<const ReadyLobe[]> make_ready_lobes(const Material &material);

// Moves the vertices of every mesh whose materials displace, and recomputes the mesh's normals. A mesh whose instances have
// different displacing materials is copied for each list of them.
void displace(Description &description, const BuildContext &context);

// Gives each instance with a flattening placement a copy of its mesh that lies in the plane.
void flatten(Description &description, const BuildContext &context);

// Returns a described light in the normalised world.
Light place_light(const LightDescription &from, const Normalisation &normalisation);

// Returns one emitter for each instance that can be sampled. Instances of one mesh with the same materials share the tree of
// its faces.
std::vector<Emitter> make_emitters(const Geometry &geometry, const std::vector<uint32_t> &slots,
                                   const std::vector<Material> &materials, EmissionAt &emission, const BuildContext &context);

} // namespace lancer
