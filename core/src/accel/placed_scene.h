// Data shared by all accelerators: the scene's instances as plain records, their boxes, and the instances without a box.
#pragma once

#include "accel/bounds.h"
#include "accel/mesh_bounds.h"
#include "accel/placed_shape.h"
#include "scene/geometry.h"

#include <vector>

namespace lancer {

struct PlacedScene {
  std::vector<PlacedShape> shapes;         // one per instance
  std::vector<PlacementFrame> mesh_frames; // one per mesh
  std::vector<glm::dvec3> mesh_reach;      // largest absolute coordinates, one per mesh
  std::vector<uint32_t> unbounded;         // instances without a finite box, mostly infinite planes: tested against every ray
  std::vector<uint32_t> bounded;           // all other instances that are not empty
  std::vector<Box> boxes;                  // of bounded, in the frame world
  PlacementFrame world;

  size_t bytes() const;
};

PlacedScene place_scene(const GeometryView &geometry, MeshOwners owners = {});

// Returns the frame of a mesh with these bounds of its faces.
PlacementFrame mesh_frame(const Extent &faces);

// Returns the box of a triangle in its mesh's frame, padded by kBoxPad.
Box triangle_box(const MeshView &mesh, const PlacementFrame &frame, uint32_t triangle);

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
