#include "accel/mesh_bounds.h"

#include <algorithm>
#include <iterator>

namespace lancer {

namespace {

MeshCells find_cells(const MeshView &mesh, const Extent &whole) {
  constexpr uint32_t kSide = 4;
  Extent cells[kSide][kSide][kSide];
  const glm::dvec3 size = whole.hi - whole.lo;
  for (const glm::uvec3 &triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p = mesh.positions[triangle[corner]];
      uint32_t cell[3];
      for (int axis = 0; axis < 3; ++axis)
        cell[axis] = std::min(static_cast<uint32_t>(kSide * (size[axis] > 0.0 ? (p[axis] - whole.lo[axis]) / size[axis] : 0.0)),
                              kSide - 1);
      cells[cell[0]][cell[1]][cell[2]].grow(p);
    }
  MeshCells filled;
  for (const auto &plane : cells)
    for (const auto &row : plane)
      std::copy_if(std::begin(row), std::end(row), std::back_inserter(filled.boxes),
                   [](const Extent &e) { return !e.empty(); });
  return filled;
}

MeshBounds find_bounds(const MeshView &mesh) {
  MeshBounds bounds;
  for (const glm::vec3 &p : mesh.positions)
    bounds.vertices.grow(glm::dvec3(p));
  for (const glm::uvec3 &triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner)
      bounds.faces.grow(glm::dvec3(mesh.positions[triangle[corner]]));
  if (mesh.key_count > 0)
    bounds.keys = own_extents(mesh);
  for (const Extent &key : bounds.keys)
    if (!key.empty()) {
      bounds.faces.grow(key.lo);
      bounds.faces.grow(key.hi);
    }
  return bounds;
}

} // namespace

std::shared_ptr<const MeshCells> cells_of(const MeshView &mesh, const Extent &faces, const Mesh *owner) {
  return made_once(owner, &Mesh::cells, [&] { return find_cells(mesh, faces); });
}

std::shared_ptr<const MeshBounds> bounds_of(const MeshView &mesh, const Mesh *owner) {
  return made_once(owner, &Mesh::bounds, [&] { return find_bounds(mesh); });
}

} // namespace lancer
