// Geometry in the normalised world with its trees. Scenes in which no object was moved, reshaped, added or removed share it.
#pragma once

#include "accel/accelerator.h"
#include "scene/affine.h"
#include "scene/description.h"

#include <memory>
#include <vector>

namespace lancer {

struct PlacedGeometry {
  // The memory that the view refers to.
  std::vector<std::shared_ptr<const Mesh>> owners; // of meshes
  std::vector<const Mesh *> owner_of;              // the same
  std::vector<std::shared_ptr<const void>> kept;   // smooth normals and centres of polygons
  std::vector<MeshView> meshes;
  std::vector<Instance> instances;
  std::vector<PlacementKey> keys; // of instances that move
  std::vector<ObjectInfo> object_infos;
  std::vector<ObjectAttribute> object_attributes;
  std::vector<ObjectAttributeView> object_attribute_views;

  GeometryView view;
  Normalisation normalisation;
  uint64_t triangles = 0; // over all instances
  AcceleratorKind kind = AcceleratorKind::Bvh;
  std::shared_ptr<const Accelerator> accelerator; // without the priority order of coplanar faces

  size_t bytes() const;
};

// Returns the geometry of a description whose displaced and flattened meshes are made, or that of before if it is the same.
// Takes the instances and the data of objects out of the description.
std::shared_ptr<const PlacedGeometry> place_geometry(Description &description, AcceleratorKind kind,
                                                     const BuildContext &context,
                                                     const std::shared_ptr<const PlacedGeometry> &before);

} // namespace lancer
