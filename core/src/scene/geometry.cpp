#include "scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// The largest sum of absolute values in a row: how much a map can enlarge the largest component.
double row_norm(const glm::dmat3 &m) {
  double norm = 0.0;
  for (int row = 0; row < 3; ++row)
    norm = std::max(norm, std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row]));
  return norm;
}

} // namespace

double largest_coordinate(const glm::dvec3 &v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

void Instance::place(const Affine &map) {
  to_world = map;
  to_object = inverse(map);
  reach = {row_norm(to_world.linear), largest_coordinate(to_world.translation), row_norm(to_object.linear),
           largest_coordinate(to_object.translation)};
}

} // namespace lancer
