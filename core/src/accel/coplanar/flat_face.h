// Flat faces where they stand in the world, and how far rounding may hold two apart that are meant to lie in one plane.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

#include <optional>

namespace lancer {

struct FlatFace {
  glm::dvec3 p; // in its plane
  glm::dvec3 n; // unit, on either side
  // The least height of a triangle, infinite for exact surfaces: what moves a corner by x turns the plane by x / height.
  double height;
};

// A triangle, by its corners in the world.
FlatFace triangle_face(const glm::dvec3 corner[3]);
void world_corners(const Geometry &geometry, uint32_t instance, uint32_t triangle, glm::dvec3 corner[3]);

// Where a place of the world is on a face, as hits tell it: weights of a triangle's corners, x and y of an exact surface.
struct FaceCoordinates {
  glm::dvec3 o, x, y;

  glm::dvec2 operator()(const glm::dvec3 &p) const { return {glm::dot(x, p - o), glm::dot(y, p - o)}; }
};
FaceCoordinates coordinates_on_face(const Geometry &geometry, uint32_t instance, uint32_t primitive);

// The face that a ray meets, with p where it does; none where the surface is curved there.
std::optional<FlatFace> face_met(const Geometry &geometry, const Ray &ray, const Hit &hit);
// The face that a ray starts on, with p next to its start.
std::optional<FlatFace> face_left(const Geometry &geometry, const Ray &ray);

// Corners are floats in their mesh, and placements are floats of the user's world that were computed in float: both know their
// surfaces to a few units of the last place.
class FaceRounding {
public:
  // origin: of the user's world.
  FaceRounding(const Geometry &geometry, const glm::dvec3 &origin);
  // Faces of two instances with the normal n that are less than this apart, at p, lie in one plane.
  double apart(uint32_t one, uint32_t other, const glm::dvec3 &n, const glm::dvec3 &p) const;
  // What one of both adds to that at most, whatever the normal.
  double share(uint32_t instance, const glm::dvec3 &p) const;
  // No face of an instance is further from the others of its plane than this, whatever they add.
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

// Whether the normals of two faces are the same line, as far as both are known. apart: of the two, by FaceRounding.
bool parallel(const FlatFace &one, const FlatFace &other, double apart);

} // namespace lancer
