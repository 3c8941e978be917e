// Data shared by all accelerators: the scene's instances as plain records, their boxes, and the instances without a box.
#pragma once

#include "accel/bounds.h"
#include "accel/mesh_bounds.h"
#include "accel/placed_shape.h"
#include "scene/geometry.h"

#include <vector>

namespace lancer {

// A box whose sides move at constant speed: as it is at the times 0 and 1.
struct MovingBox {
  Box at[2];

  void grow(const MovingBox &other) {
    for (int end = 0; end < 2; ++end)
      at[end].grow(other.at[end]);
  }
  Box middle() const { return {0.5f * (at[0].lo + at[1].lo), 0.5f * (at[0].hi + at[1].hi)}; }
  Box swept() const {
    Box all = at[0];
    all.grow(at[1]);
    return all;
  }
};
// Returns a box that holds extents at equal steps of time, and all that is between two of them.
MovingBox moving_box(const PlacementFrame &frame, std::span<const Extent> extents);

struct PlacedScene {
  std::vector<PlacedShape> shapes;         // one per instance
  std::vector<PlacementFrame> mesh_frames; // one per mesh
  std::vector<glm::dvec3> mesh_reach;      // largest absolute coordinates, one per mesh
  std::vector<uint32_t> unbounded;         // instances without a finite box, mostly infinite planes: tested against every ray
  std::vector<uint32_t> bounded;           // all other instances that are not empty
  std::vector<Box> boxes;                  // of bounded, in the frame world, at all times
  std::vector<MovingBox> moving;           // the same, from time to time; empty where nothing moves
  PlacementFrame world;

  size_t bytes() const;
};

PlacedScene place_scene(const GeometryView &geometry, MeshOwners owners = {});

// Returns the frame of a mesh with these bounds of its faces.
PlacementFrame mesh_frame(const Extent &faces);

// Returns the box of a triangle in its mesh's frame, padded by kBoxPad.
Box triangle_box(const MeshView &mesh, const PlacementFrame &frame, uint32_t triangle);
// Returns the box of a triangle of a mesh that changes its shape.
MovingBox moving_triangle_box(const MeshView &mesh, const PlacementFrame &frame, uint32_t triangle);

// Boxes of an instance's triangles in the frame of the world.
class PlacedTriangleBoxes {
public:
  // reach: the largest absolute coordinates of the mesh.
  PlacedTriangleBoxes(const MeshView &mesh, const Instance &instance, const glm::dvec3 &reach, const PlacementFrame &world);
  Box operator()(uint32_t triangle) const;

private:
  const MeshView mesh;
  const Affine to_world;
  const glm::dvec3 moved; // bound on the displacement of a point by rounding
  const PlacementFrame world;
};

} // namespace lancer
