#include "scene/affine.h"

#include <algorithm>

namespace lancer {

namespace {

constexpr double kRoundoff = 0x1p-50;

// The columns with length 1, or 0.
glm::dmat3 directions_of(const glm::dmat3 &linear) {
  return {unit_or_zero(linear[0]), unit_or_zero(linear[1]), unit_or_zero(linear[2])};
}

// Maps normals of the object to normals of the world, of the length by which the map scales areas.
glm::dmat3 cofactors_of(const glm::dmat3 &m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

int longest(const glm::dmat3 &m) {
  int k = 0;
  for (int i = 1; i < 3; ++i)
    k = glm::length(m[i]) > glm::length(m[k]) ? i : k;
  return k;
}

} // namespace

bool is_singular(const glm::dmat3 &linear) { return !(std::abs(glm::determinant(directions_of(linear))) > kRoundoff); }

std::optional<FlatMap> flat_map(const Affine &map) {
  const glm::dmat3 unit = cofactors_of(directions_of(map.linear));
  if (!(glm::length(unit[longest(unit)]) > kRoundoff))
    return {};
  // The cofactors of a map of rank 2 are area * normal * axis^T.
  const glm::dmat3 cofactors = cofactors_of(map.linear);
  const glm::dvec3 normal = unit_or_zero(cofactors[longest(cofactors)]);
  const glm::dvec3 along(glm::dot(normal, cofactors[0]), glm::dot(normal, cofactors[1]), glm::dot(normal, cofactors[2]));
  // Division by the largest keeps a coordinate axis exact.
  const double largest = std::max({std::abs(along.x), std::abs(along.y), std::abs(along.z)});
  FlatMap flat{map, unit_or_zero(along / largest)};
  // The geometric mean of the two scales keeps the inverse small.
  const double thickness = std::sqrt(largest * glm::length(along / largest));
  flat.map.linear += glm::outerProduct(thickness * normal, flat.axis);
  return flat;
}

} // namespace lancer
