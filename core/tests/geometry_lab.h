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

  // The view is valid until the geometry changes.
  operator GeometryView() const {
    views_.assign(meshes.begin(), meshes.end());
    return {views_, instances, {}, {}};
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
  }
  DescribedGeometry(const DescribedGeometry &) = delete;
  DescribedGeometry &operator=(const DescribedGeometry &) = delete;

private:
  std::vector<MeshView> views_;
  std::vector<ObjectAttributeView> attributes_;
};

} // namespace lancer
