// Trees of emitting faces. The next scene takes them over where all that they depend on is the same.
#pragma once

#include "lights/emission.h"
#include "scene/description.h"

#include <memory>
#include <vector>

namespace lancer {

struct MadeEmissiveFaces {
  std::shared_ptr<const Mesh> mesh;
  std::vector<std::shared_ptr<const Material>> materials;
  bool of_mesh = false;
  bool by_nodes = false; // nodes may read the object
  Instance instance;     // counts if the tree is in world space, or by nodes
  std::shared_ptr<const EmissiveFaces> faces;

  // Whether both are made from the same data, but for the objects' data that nodes may read.
  bool same_source(const MadeEmissiveFaces &other) const {
    const bool same_surface = mesh == other.mesh && materials == other.materials && of_mesh == other.of_mesh;
    return same_surface && !by_nodes && (of_mesh || instance.same(other.instance));
  }
};

using MadeEmitters = std::vector<MadeEmissiveFaces>;

} // namespace lancer
