// Bounds of a mesh in its own space, the same for all its instances.
#pragma once

#include "scene/geometry.h"

#include <limits>
#include <vector>

namespace lancer {

struct Extent {
  glm::dvec3 lo{std::numeric_limits<double>::infinity()};
  glm::dvec3 hi{-std::numeric_limits<double>::infinity()};

  void grow(const glm::dvec3 &p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  bool empty() const { return !(lo.x <= hi.x); }
  glm::dvec3 middle() const { return 0.5 * lo + 0.5 * hi; }
  glm::dvec3 half() const { return 0.5 * hi - 0.5 * lo; }
};

struct MeshBounds {
  Extent faces;    // of the vertices of faces
  Extent vertices; // of all vertices
};

// The boxes of the vertices in the cells of a grid. The bounds of these boxes stay nearly tight when the mesh is rotated,
// whereas a single box grows by up to a factor of 1.7. In a field of rotated copies, a sample costs an eighth less.
struct MeshCells {
  std::vector<Extent> boxes;
};

// Return what the owner keeps, if it is given.
std::shared_ptr<const MeshBounds> bounds_of(const MeshView &mesh, const Mesh *owner);
std::shared_ptr<const MeshCells> cells_of(const MeshView &mesh, const Extent &faces, const Mesh *owner);

} // namespace lancer
