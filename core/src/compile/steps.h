// Steps of commit(): each takes the description or a part of it, and computes a part of the scene.
#pragma once

#include "accel/accelerator.h"
#include "bsdf/material_lobes.h"
#include "compile/made_emitters.h"
#include "compile/made_meshes.h"
#include "lights/emission.h"
#include "lights/lamp_shader.h"
#include "lights/light.h"
#include "lights/light_bounds.h"
#include "scene/affine.h"
#include "scene/description.h"
#include "scene/geometry.h"
#include "scene/ray.h"
#include "simd/parallel.h"

#include <limits>
#include <vector>

namespace lancer {

// The largest numbers of lobes and frames that can overlap at one place. A frame is a normal with or without a tangent; the
// shading normal's frame counts.
struct MaterialDemand {
  size_t lobes = 0, frames = 1;
};
MaterialDemand demand_of(const MaterialView &material);

// Reports the lobes and frames that exceed the capacity of a BSDF.
void report_limits(const std::string &object, const MaterialView &material, Messages &messages);

// Computes the parts of each lobe that are the same at every hit.
ReadyLobes make_ready_lobes(const MaterialView &material);

// Moves the vertices of every mesh whose materials displace, and recomputes the mesh's normals. A mesh whose instances have
// different displacing materials is copied for each list of them. made: receives these meshes; before: those of another scene.
void displace(Description &description, const BuildContext &context, MadeMeshes &made, const MadeMeshes *before = nullptr);

// Gives each instance with a flattening placement a copy of its mesh that lies in the plane.
void flatten(Description &description, const BuildContext &context, MadeMeshes &made, const MadeMeshes *before = nullptr);

// Returns a described light in the normalised world.
Light place_light(const LightDescription &from, const Normalisation &normalisation);
// Adds the nodes of a light, if it has any, to the shaders, which read them as long as they live.
void add_lamp_shader(const LightDescription &from, Light &light, const Normalisation &normalisation, LampShaders &shaders);

// The memory of geometry and materials, by which trees of faces are known again; made receives those of this scene.
struct EmitterSources {
  std::span<const std::shared_ptr<const Mesh>> meshes{};
  std::span<const std::shared_ptr<const Material>> materials{};
  const MadeEmitters *before = nullptr;
  MadeEmitters *made = nullptr; // null: none is known
};

// Returns one emitter for each instance that can be sampled. Instances of one mesh with the same materials share the tree of
// its faces.
std::vector<Emitter> make_emitters(const GeometryView &geometry, std::span<const uint32_t> slots,
                                   std::span<const MaterialView> materials, EmissionAt &emission, const BuildContext &context,
                                   const EmitterSources &sources = {});

// Normals of a mesh: of its faces, of its vertices, and after displacement.

// Returns a vector along a face's normal whose length is twice the face's area.
glm::dvec3 twice_area(const MeshView &mesh, uint32_t triangle);
// Returns the unit normal of a face, or 0 where it has no area.
glm::dvec3 face_normal(const MeshView &mesh, uint32_t triangle);

// Returns one normal per vertex, or 0: the sum of the faces' normals by area, as in the course's Gouraud shading.
std::vector<glm::vec3> normals_by_area(const MeshView &mesh);

// Returns one normal per vertex, so that a surface displaced along the normals does not tear: the mesh's own normals if it has
// any, otherwise the means of the faces' normals weighted by their angles.
std::vector<glm::vec3> vertex_normals(const MeshView &mesh);

// Recomputes those of the mesh's own normals that belong to the given triangles. triangles: one bit per triangle.
void renew_normals(Mesh &mesh, const std::vector<bool> &triangles);

// The places at which flat shading evaluates the colour of a polygon.

// Returns the centres by polygon number. The normal is the sum of the triangles' area vectors (Newell's). The centre is the
// mean of the polygon's vertices, projected onto a warped polygon along the normal. If a concave polygon does not contain the
// mean, the centre is the nearest place of the polygon.
std::vector<PolygonCenter> polygon_centers(const MeshView &mesh);

// Returns the hit at the centre of the polygon of the given hit; t stays. A triangle without a polygon is its own polygon.
Hit center_hit(const MeshView &mesh, const Hit &hit);

// Cuts of a set of lights in two, for the builders of both light trees.

// The place at which a set of lights is cut in two.
struct LightCut {
  int axis = -1; // -1: no cut costs less than the whole; the order stays
  uint32_t middle = 0;
  double cost = std::numeric_limits<double>::infinity();
};

LightBounds bounds_of(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end);
// Returns the cut of the lowest cost by the surface area orientation heuristic. cost: of the whole; a cut must cost less.
LightCut find_cut(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, double cost);
// Moves the lights before the cut to the front.
void make_cut(std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, const LightCut &cut);

// Drops lights without energy and divides all energies by the power of two next to the brightest, so that choices are the same
// at any scale. Returns the bounds of all lights, with their original energy.
LightBounds prepare(std::vector<DescribedLight> &lights);

} // namespace lancer
