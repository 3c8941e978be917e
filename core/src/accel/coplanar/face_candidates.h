// Choice of the faces of a scene that are compared with each other.
#pragma once

#include "accel/accelerator.h"
#include "accel/coplanar/flat_face.h"

#include <algorithm>
#include <cmath>

namespace lancer {

// A triangle, or half of a square around a flat part of an exact surface.
struct FaceCandidate {
  glm::dvec3 corner[3];
  FlatFace face;
  double rounding; // upper bound of its share in FaceRounding::apart()
  glm::dvec3 low, high;
  uint32_t instance, primitive;
  uint32_t found = 0;    // number of coplanar faces found
  bool anywhere = false; // more of them than patches keep
};

struct FaceCandidates {
  std::vector<FaceCandidate> faces; // grouped by instance
  double step = 1.0;                // quantisation step of the distance of planes
};

// Returns the same faces for every accelerator. The number of faces is bounded: a large mesh contributes some triangles and its
// largest ones. Instances that touch others come first.
FaceCandidates choose_faces(const Geometry &geometry, const FaceRounding &rounding, const BuildContext &context);

// Returns the number of faces of an instance; 0 if it has no flat ones.
size_t faces_of(const Geometry &geometry, uint32_t instance);

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
