// Placements that flatten: singular maps of rank 2.
#pragma once

#include "scene/affine.h"

#include <optional>

namespace lancer {

// An invertible map that agrees with a singular one on the plane through the origin perpendicular to axis.
struct FlatMap {
  Affine map;      // of positive determinant: the winding of faces in the world decides their outer side, as in Cycles
  glm::dvec3 axis; // object space, unit: the kernel of the singular map
};

// Whether the determinant is zero at double's roundoff, independent of scale.
bool is_singular(const glm::dmat3 &linear);

// map: singular. Returns nothing if its rank is below 2.
std::optional<FlatMap> flat_map(const Affine &map);

} // namespace lancer
