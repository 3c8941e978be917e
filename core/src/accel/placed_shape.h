// An instance as the traversals read it: plain numbers, no containers.
#pragma once

#include <cstdint>

namespace lancer {

enum class ShapeKind : uint32_t;

// The box frame of a mesh or of the whole scene: p_box = (p - centre) * scale. scale is a power of two that brings the largest
// half extent into [0.5, 1], so that float boxes have the same relative error at every size and place.
struct PlacementFrame {
  double centre[3] = {0.0, 0.0, 0.0};
  double scale = 1.0;
};

struct alignas(32) PlacedShape {
  double to_object[4][4]; // the columns of a 3 x 4 matrix, each with a 0 behind it
  PlacementFrame frame;   // box frame in object space; unit for exact surfaces
  double slack;           // exact surfaces: how far rounding may lift a stored surface point off the surface, object space
  ShapeKind kind;
  uint32_t mesh;        // kNone for exact surfaces
  uint32_t hidden_from; // bits of Ray::kinds
};

} // namespace lancer
