// Geometry as kernels read it: built by hand, or of a description.
#pragma once

#include "scene/description.h"
#include "scene/geometry.h"

#include <vector>

namespace lancer {

// Geometry built by hand.
struct Geometry {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<PlacementKey> keys; // of instances that move

  // Lets an instance move.
  void move(Instance &instance, const std::vector<Affine> &maps) {
    const std::vector<PlacementKey> own = placement_keys(maps);
    instance.first_key = uint32_t(keys.size());
    instance.key_count = uint32_t(own.size());
    keys.insert(keys.end(), own.begin(), own.end());
  }
  // The view is valid until the geometry changes.
  operator GeometryView() const {
    views_.assign(meshes.begin(), meshes.end());
    return {views_, instances, {}, {}, keys};
  }

private:
  mutable std::vector<MeshView> views_;
};

// Returns the numbers of an attribute. number: of the attribute among the mesh's.
inline std::vector<float> values_of(const Mesh &mesh, size_t number) {
  const MeshAttribute &attribute = mesh.attributes[number];
  const auto first = mesh.attribute_values.begin() + ptrdiff_t(attribute.first);
  return {first, first + ptrdiff_t(mesh.count_of(attribute))};
}

// The geometry of a description, valid until the description changes.
class DescribedGeometry : public GeometryView {
public:
  explicit DescribedGeometry(const Description &description) : attributes_(views_of(description.object_attributes)) {
    for (const Given<Mesh> &mesh : description.meshes)
      views_.push_back(*mesh);
    meshes = views_;
    instances = description.instances;
    object_infos = description.object_infos;
    object_attributes = attributes_;
    keys = description.keys;
  }
  DescribedGeometry(const DescribedGeometry &) = delete;
  DescribedGeometry &operator=(const DescribedGeometry &) = delete;

private:
  std::vector<MeshView> views_;
  std::vector<ObjectAttributeView> attributes_;
};

} // namespace lancer
