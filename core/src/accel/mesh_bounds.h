// Bounds of a mesh in its own space, the same for all its instances.
#pragma once

#include "scene/geometry.h"
#include "scene/moving_bounds.h"

#include <vector>

namespace lancer {

struct MeshBounds {
  Extent faces;             // of the vertices of faces, at all times
  Extent vertices;          // of all vertices of the mesh as it stands
  std::vector<Extent> keys; // of the vertices of faces, at the keys of a mesh that changes its shape
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
