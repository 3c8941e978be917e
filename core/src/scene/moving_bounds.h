// Boxes, and those of shapes that move: at all times together, and at successive times.
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

// Rounding of a vertex between two keys, relative to its largest coordinate: the difference, the product and the sum are of
// numbers of at most 2, 2 and 1, which float rounds by 5 * 2^-24 in all.
inline constexpr double kKeyRounding = 0x1p-21;

// Returns the boxes of a mesh's faces at its keys, or one box of a mesh that keeps its shape.
std::vector<Extent> own_extents(const MeshView &mesh);

// Boxes of an instance at equal steps of time, from 0 to 1. Between two of them, the shape lies in the boxes between them. The
// instance or its mesh must move, and the shape must be bounded. own: boxes of the shape in its own space, as own_extents().
std::vector<Extent> extents_over_time(const GeometryView &geometry, const Instance &instance, std::span<const Extent> own);
// Returns the box of an instance at all times.
Extent swept_extent(const GeometryView &geometry, const Instance &instance);

} // namespace lancer
