#include "compile/placed_geometry.h"

#include "accel/mesh_bounds.h"
#include "compile/steps.h"
#include "simd/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lancer {

namespace {

void add_box(Extent &world, const Affine &map, const glm::dvec3 &low, const glm::dvec3 &high) {
  for (int corner = 0; corner < 8; ++corner)
    world.grow(map.point({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z}));
}

Extent world_bounds(const Description &description, const BuildContext &context) {
  std::vector<std::shared_ptr<const MeshBounds>> meshes(description.meshes.size());
  parallel_for(context, meshes.size(),
               [&](size_t i) { meshes[i] = bounds_of(*description.meshes[i], description.meshes[i].object.get()); });
  GeometryView moving;
  moving.keys = description.keys;
  const Extent unit{glm::dvec3(-1.0), glm::dvec3(1.0)};
  Extent world;
  for (const Instance &instance : description.instances) {
    const MeshBounds *const bounds = instance.kind == ShapeKind::Mesh ? meshes[instance.mesh].get() : nullptr;
    if (bounds && bounds->faces.empty())
      continue;
    if (instance.kind != ShapeKind::Plane && instance.key_count > 0)
      for (const Extent &box : extents_over_time(moving, instance,
                                                 !bounds                ? std::span(&unit, 1)
                                                 : bounds->keys.empty() ? std::span(&bounds->faces, 1)
                                                                        : std::span(bounds->keys))) {
        world.grow(box.lo);
        world.grow(box.hi);
      }
    else if (instance.kind == ShapeKind::Plane)
      world.grow(instance.to_world.translation);
    else if (instance.kind != ShapeKind::Mesh)
      add_box(world, instance.to_world, glm::dvec3(-1.0), glm::dvec3(1.0));
    else
      add_box(world, instance.to_world, bounds->faces.lo, bounds->faces.hi);
  }
  // Without geometry, the positions of the lights give the scene its size.
  if (world.empty())
    for (const Given<LightDescription> &light : description.lights)
      world.grow(light->to_world.translation);
  return world;
}

// Returns the centre of the bounds, and the power of two that scales the largest extent to between 512 and 1024.
Normalisation normalise(const Extent &bounds) {
  Normalisation result;
  if (bounds.empty())
    return result;
  result.centre = bounds.middle();
  const glm::dvec3 size = bounds.hi - bounds.lo;
  const double extent = std::max({size.x, size.y, size.z});
  if (extent > 0.0 && std::isfinite(extent))
    result.scale = std::ldexp(1.0, 9 - std::ilogb(extent));
  return result;
}

// Adds the normals and the places that the shading of an instance needs.
void complete(PlacedGeometry &placed, const Instance &instance) {
  MeshView &mesh = placed.meshes[instance.mesh];
  const Mesh &owner = *placed.owners[instance.mesh];
  const bool smooth = instance.shading == Shading::Gouraud || instance.shading == Shading::Phong;
  if (smooth && mesh.normal_domain == NormalDomain::None && mesh.smooth_normals.empty()) {
    const auto normals = owner.smooth_normals.get([&] { return normals_by_area(mesh); });
    mesh.smooth_normals = *normals;
    placed.kept.push_back(normals);
  }
  if (instance.shading == Shading::Flat && mesh.centers.empty()) {
    const auto centers = owner.centers.get([&] { return polygon_centers(mesh); });
    mesh.centers = *centers;
    placed.kept.push_back(centers);
  }
}

bool same_bits(const void *a, const void *b, size_t bytes) { return bytes == 0 || std::memcmp(a, b, bytes) == 0; }

bool same(const Normalisation &a, const Normalisation &b) { return same_bits(&a, &b, sizeof a); }

bool same(const std::vector<ObjectAttribute> &a, const std::vector<ObjectAttribute> &b) {
  return std::ranges::equal(a, b, [](const ObjectAttribute &x, const ObjectAttribute &y) {
    return x.name == y.name && x.values.size() == y.values.size() &&
           same_bits(x.values.data(), y.values.data(), x.values.size() * sizeof(glm::vec4));
  });
}

bool same(const std::vector<ObjectInfo> &a, const std::vector<ObjectInfo> &b) {
  return a.size() == b.size() && same_bits(a.data(), b.data(), a.size() * sizeof(ObjectInfo));
}

bool same(const std::vector<Instance> &a, const std::vector<Instance> &b) {
  return std::ranges::equal(a, b, [](const Instance &x, const Instance &y) { return x.same(y); });
}

bool same(const std::vector<PlacementKey> &a, const std::vector<PlacementKey> &b) {
  return a.size() == b.size() && same_bits(a.data(), b.data(), a.size() * sizeof(PlacementKey));
}

bool same(const PlacedGeometry &a, const PlacedGeometry &b) {
  const bool same_objects = same(a.object_infos, b.object_infos) && same(a.object_attributes, b.object_attributes);
  const bool same_places = same(a.normalisation, b.normalisation) && same(a.instances, b.instances) && same(a.keys, b.keys);
  return a.kind == b.kind && a.owners == b.owners && same_objects && same_places;
}

} // namespace

std::shared_ptr<const PlacedGeometry> place_geometry(Description &description, AcceleratorKind kind,
                                                     const BuildContext &context,
                                                     const std::shared_ptr<const PlacedGeometry> &before) {
  const auto placed = std::make_shared<PlacedGeometry>();
  placed->kind = kind;
  placed->normalisation = normalise(world_bounds(description, context));
  for (const Given<Mesh> &mesh : description.meshes) {
    placed->owners.push_back(mesh.object);
    placed->owner_of.push_back(mesh.object.get());
    placed->meshes.push_back(*mesh);
  }
  placed->instances = std::move(description.instances);
  constexpr size_t kPiece = 1024;
  parallel_for(context, (placed->instances.size() + kPiece - 1) / kPiece, [&](size_t piece) {
    const size_t end = std::min(placed->instances.size(), (piece + 1) * kPiece);
    for (size_t i = piece * kPiece; i < end; ++i)
      placed->instances[i].place(placed->normalisation.to_normalised(placed->instances[i].to_world));
  });
  placed->keys = std::move(description.keys);
  for (PlacementKey &key : placed->keys) {
    key.translation = placed->normalisation.to_normalised(key.translation);
    key.stretch *= placed->normalisation.scale;
  }
  placed->object_infos = std::move(description.object_infos);
  placed->object_attributes = std::move(description.object_attributes);
  if (before && same(*placed, *before))
    return before;
  count_made(context, &MadeCounts::placements);
  for (const Instance &instance : placed->instances)
    if (instance.kind == ShapeKind::Mesh) {
      placed->triangles += placed->meshes[instance.mesh].triangles.size();
      poll_cancel(context);
      complete(*placed, instance);
    }
  placed->object_attribute_views = views_of(placed->object_attributes);
  placed->view = {placed->meshes, placed->instances, placed->object_infos, placed->object_attribute_views, placed->keys};
  placed->accelerator = build_accelerator(kind, placed->view, context, placed->owner_of);
  return placed;
}

size_t PlacedGeometry::bytes() const {
  size_t bytes =
      instances.size() * sizeof(Instance) + keys.size() * sizeof(PlacementKey) + object_infos.size() * sizeof(ObjectInfo);
  for (const ObjectAttribute &attribute : object_attributes)
    bytes += attribute.values.size() * sizeof(glm::vec4);
  for (size_t i = 0; i < owners.size(); ++i)
    bytes += owners[i]->bytes() + meshes[i].smooth_normals.size_bytes() + meshes[i].centers.size_bytes();
  return bytes;
}

} // namespace lancer
