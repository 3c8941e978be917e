// Affine maps between object and world space: their invertible stand-ins where they flatten, and the frame in which scenes are
// traced.
#pragma once

#include "sampling/elementary.h"

#include <cmath>
#include <glm/glm.hpp>
#include <optional>

namespace lancer {

// p' = linear * p + translation, in double, because in float the product of placements would lose the digits of scenes far from
// the origin.
struct Affine {
  glm::dmat3 linear{1.0};
  glm::dvec3 translation{0.0};

  glm::dvec3 point(const glm::dvec3 &p) const { return linear * p + translation; }
  glm::dvec3 vector(const glm::dvec3 &v) const { return linear * v; }

  // m: 3 x 4, row-major.
  static Affine from_rows(const double m[12]) {
    Affine a;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        a.linear[column][row] = m[4 * row + column];
      a.translation[row] = m[4 * row + 3];
    }
    return a;
  }

  bool finite() const {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (!std::isfinite(linear[i][k]))
          return false;
    return std::isfinite(translation.x) && std::isfinite(translation.y) && std::isfinite(translation.z);
  }
};

inline Affine operator*(const Affine &a, const Affine &b) {
  return {a.linear * b.linear, a.linear * b.translation + a.translation};
}

// Returns the inverse; the determinant must not be zero.
inline Affine inverse(const Affine &a) {
  const glm::dmat3 m = glm::inverse(a.linear);
  return {m, -(m * a.translation)};
}

// Returns the factor by which a map scales areas, averaged over orientations.
inline double mean_area_scale(const glm::dmat3 &map) { return exp(2.0 / 3.0 * log(std::abs(glm::determinant(map)))); }

// Returns the unit vector; 0 for a zero vector.
template <class T> glm::vec<3, T> unit_or_zero(const glm::vec<3, T> &v) {
  const T length = glm::length(v);
  return length > T(0) ? v / length : glm::vec<3, T>(T(0));
}

// Transforms a normal by a map whose inverse is given; returns a unit normal, or 0 for 0.
inline glm::vec3 carried_normal(const Affine &back, const glm::dvec3 &n) {
  return glm::vec3(unit_or_zero(glm::transpose(back.linear) * n));
}

// Normalisation of scenes.

// p_normalised = (p_world - centre) * scale, scale a power of two: a scene has the same numbers at any size and position.
struct Normalisation {
  glm::dvec3 centre{0.0};
  double scale = 1.0;

  glm::dvec3 to_normalised(const glm::dvec3 &p) const { return (p - centre) * scale; }
  glm::dvec3 to_world(const glm::dvec3 &p) const { return p / scale + centre; }
  Affine to_normalised(const Affine &map) const { return {map.linear * scale, to_normalised(map.translation)}; }
};

// Placements that flatten: singular maps of rank 2.

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
