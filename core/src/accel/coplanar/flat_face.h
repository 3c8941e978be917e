// Flat faces in the world: the faces of a scene that are compared with each other, and the distance by which rounding may
// separate faces that are meant to be coplanar.
#pragma once

#include "accel/accelerator.h"
#include "scene/geometry.h"
#include "scene/ray.h"

#include <algorithm>
#include <cmath>
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
void world_corners(const GeometryView &geometry, uint32_t instance, uint32_t triangle, glm::dvec3 corner[3]);

// Coordinates of a world point on a face, as hits have them: weights of a triangle's corners, or x and y of an exact surface.
struct FaceCoordinates {
  glm::dvec3 o, x, y;

  glm::dvec2 operator()(const glm::dvec3 &p) const { return {glm::dot(x, p - o), glm::dot(y, p - o)}; }
};
FaceCoordinates coordinates_on_face(const GeometryView &geometry, uint32_t instance, uint32_t primitive);

// Returns the face of a hit with p at the hit; none if the surface is curved there.
std::optional<FlatFace> face_met(const GeometryView &geometry, const Ray &ray, const Hit &hit);
// Returns the face that a ray starts on, with p near its origin.
std::optional<FlatFace> face_left(const GeometryView &geometry, const Ray &ray);

// Rounding of surfaces. Corners are floats of their mesh, and placements are floats of the user's world that were computed in
// float: both are known to a few units in the last place.
class FaceRounding {
public:
  // origin: of the user's world.
  FaceRounding(const GeometryView &geometry, const glm::dvec3 &origin, MeshOwners owners = {});
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

  const GeometryView geometry;
  const glm::dvec3 origin;
  std::vector<glm::dvec3> low, high; // by mesh
};

// Returns whether two faces have the same normal up to sign, within their precision. apart: of the two, by FaceRounding.
bool parallel(const FlatFace &one, const FlatFace &other, double apart);

// A triangle, or half of a square around a flat part of an exact surface.
struct FaceCandidate {
  glm::dvec3 corner[3];
  FlatFace face;
  double rounding; // upper bound of its share in FaceRounding::apart()
  glm::dvec3 low, high;
  uint32_t instance, primitive;
  uint32_t found = 0;    // number of coplanar faces found
  bool anywhere = false; // more of them than patches keep
  bool fresh = true;     // not yet compared
};
// Returns the candidate of a triangle, or of half of a square; none if it has no extent.
std::optional<FaceCandidate> face_candidate(const FaceRounding &rounding, uint32_t instance, uint32_t primitive,
                                            const glm::dvec3 corner[3]);

// Returns whether two candidates lie in one plane and overlap there.
bool in_one_plane(const FaceRounding &rounding, const FaceCandidate &one, const FaceCandidate &other);

struct FaceCandidates {
  std::vector<FaceCandidate> faces; // grouped by instance
  double step = 1.0;                // quantisation step of the distance of planes
};

// Returns the same faces for every accelerator. The number of faces is bounded: a large mesh contributes some triangles and its
// largest ones. Instances that touch others come first.
FaceCandidates choose_faces(const GeometryView &geometry, const FaceRounding &rounding, const BuildContext &context);

// Returns the number of faces of an instance; 0 if it has no flat ones.
size_t faces_of(const GeometryView &geometry, uint32_t instance);

inline bool boxes_meet(const glm::dvec3 &low, const glm::dvec3 &high, const glm::dvec3 &other_low,
                       const glm::dvec3 &other_high) {
  return low.x <= other_high.x && other_low.x <= high.x && low.y <= other_high.y && other_low.y <= high.y &&
         low.z <= other_high.z && other_low.z <= high.z;
}

// Calls use() with each cell of quantised planes that may hold the face's plane. A face whose plane is too imprecise has none.
template <class Use> void for_each_plane_cell(const FlatFace &face, double rounding, double step, Use &&use) {
  constexpr double kNormalCells = 16.0;
  // A direction that is perpendicular to no normal found in models. Rounding does not change the sign of its dot product with a
  // normal, so a normal and its opposite give the same n.
  const glm::dvec3 reference(0.5432, 0.7531, 0.3711);
  const glm::dvec3 n = glm::dot(face.n, reference) < 0.0 ? -face.n : face.n;
  const double turned = 0x1p-20 + rounding / face.height;
  const double reach = std::abs(face.p.x) + std::abs(face.p.y) + std::abs(face.p.z);
  const double side = kNormalCells * turned, offset = (rounding + turned * reach) / step;
  if (!(side < 0.5 && offset < 1.0))
    return;
  const double at[4] = {n.x * kNormalCells + 0.5, n.y * kNormalCells + 0.5, n.z * kNormalCells + 0.5,
                        glm::dot(n, face.p) / step + 0.5};
  int64_t lo[4], hi[4];
  for (int i = 0; i < 4; ++i) {
    lo[i] = static_cast<int64_t>(std::floor(at[i] - (i < 3 ? side : offset)));
    hi[i] = static_cast<int64_t>(std::floor(at[i] + (i < 3 ? side : offset)));
  }
  for (int64_t x = lo[0]; x <= hi[0]; ++x)
    for (int64_t y = lo[1]; y <= hi[1]; ++y)
      for (int64_t z = lo[2]; z <= hi[2]; ++z)
        for (int64_t h = lo[3]; h <= hi[3]; ++h)
          use(static_cast<uint64_t>(h) << 24 ^ static_cast<uint64_t>((x & 255) << 16 | (y & 255) << 8 | (z & 255)));
}

} // namespace lancer
