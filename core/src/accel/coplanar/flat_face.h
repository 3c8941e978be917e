// Flat faces in the world, and the distance by which rounding may separate faces that are meant to be coplanar.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

#include <optional>

namespace lancer {

struct FlatFace {
  glm::dvec3 p; // a point of its plane
  glm::dvec3 n; // unit, on either side
  // The least height of a triangle, infinite for exact surfaces: moving a corner by x turns the plane by x / height.
  double height;
};

// Makes the face of a triangle from its corners in the world.
FlatFace triangle_face(const glm::dvec3 corner[3]);
void world_corners(const Geometry &geometry, uint32_t instance, uint32_t triangle, glm::dvec3 corner[3]);

// Coordinates of a world point on a face, as hits have them: weights of a triangle's corners, or x and y of an exact surface.
struct FaceCoordinates {
  glm::dvec3 o, x, y;

  glm::dvec2 operator()(const glm::dvec3 &p) const { return {glm::dot(x, p - o), glm::dot(y, p - o)}; }
};
FaceCoordinates coordinates_on_face(const Geometry &geometry, uint32_t instance, uint32_t primitive);

// Returns the face of a hit with p at the hit; none if the surface is curved there.
std::optional<FlatFace> face_met(const Geometry &geometry, const Ray &ray, const Hit &hit);
// Returns the face that a ray starts on, with p near its origin.
std::optional<FlatFace> face_left(const Geometry &geometry, const Ray &ray);

// Rounding of surfaces. Corners are floats of their mesh, and placements are floats of the user's world that were computed in
// float: both are known to a few units in the last place.
class FaceRounding {
public:
  // origin: of the user's world.
  FaceRounding(const Geometry &geometry, const glm::dvec3 &origin);
  // Returns the distance below which faces of two instances with the normal n, at p, are coplanar.
  double apart(uint32_t one, uint32_t other, const glm::dvec3 &n, const glm::dvec3 &p) const;
  // Returns the upper bound of one instance's share in apart(), for any normal.
  double share(uint32_t instance, const glm::dvec3 &p) const;
  // Clamps sum to an upper bound on the distance of an instance's face from faces coplanar with it.
  double most(uint32_t instance, double sum) const;
  // The largest extent of an instance along an axis, in the world.
  double extent(uint32_t instance) const;
  double extent_of_mesh(uint32_t mesh) const; // in its own space
  // The corners of the box around an instance, in the world.
  void box(uint32_t instance, glm::dvec3 &low, glm::dvec3 &high) const;

private:
  glm::dvec3 within(uint32_t instance, const glm::dvec3 &p) const;
  glm::dvec3 moved(uint32_t instance) const;

  const Geometry &geometry;
  const glm::dvec3 origin;
  std::vector<glm::dvec3> low, high; // by mesh
};

// Returns whether two faces have the same normal up to sign, within their precision. apart: of the two, by FaceRounding.
bool parallel(const FlatFace &one, const FlatFace &other, double apart);

} // namespace lancer
