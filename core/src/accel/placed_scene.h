// What all accelerators share: the scene's instances as plain records, their boxes, and those that have none.
#pragma once

#include "accel/bounds.h"
#include "accel/placed_shape.h"
#include "scene/geometry.h"

#include <vector>

namespace lancer {

struct PlacedScene {
  std::vector<PlacedShape> shapes;         // one per instance of the geometry
  std::vector<PlacementFrame> mesh_frames; // one per mesh
  std::vector<glm::dvec3> mesh_reach;      // and the largest coordinates, without sign
  std::vector<uint32_t> unbounded; // instances without a finite box, infinite planes above all: tested against every ray
  std::vector<uint32_t> bounded;   // all others that have anything to hit
  std::vector<Box> boxes;          // of bounded, in the frame world
  PlacementFrame world;

  size_t bytes() const;
};

PlacedScene place_scene(const Geometry &geometry);

// The box of a triangle in its mesh's frame, widened by kBoxPad.
Box triangle_box(const Mesh &mesh, const PlacementFrame &frame, uint32_t triangle);

// Boxes of a mesh's triangles in the frame of the world, as an instance places them.
class PlacedTriangleBoxes {
public:
  // reach: the largest coordinates of the mesh.
  PlacedTriangleBoxes(const Mesh &mesh, const Instance &instance, const glm::dvec3 &reach, const PlacementFrame &world);
  Box operator()(uint32_t triangle) const;

private:
  const Mesh &mesh;
  const Affine to_world;
  const glm::dvec3 moved; // how far rounding may move a point
  const PlacementFrame world;
};

} // namespace lancer
