// The priority order among coplanar faces, of which a ray meets one alone: the faces that others in the same plane overlap,
// found once; a grid on each of them, which tells at a hit whether another covers the place; and the accelerator that applies
// the order to the hits of any other.
#pragma once

#include "accel/accelerator.h"
#include "accel/coplanar/flat_face.h"

#include <bit>
#include <span>
#include <tuple>
#include <vector>

namespace lancer {

// What the priority order needs of a scene beside its geometry.
struct PlaneRules {
  glm::dvec3 origin{0.0};                   // of the user's world, which floats placed the instances from
  std::vector<uint8_t> transparent_slots{}; // by slot: its material lets light through; empty: none does
  std::vector<uint8_t> emitting_slots{};    // by slot: its material shines; empty: none does
};

// The priority of a face: where coplanar faces cover a place, a ray meets the one with the least.
using PlaneOrder = std::tuple<bool, bool, uint32_t, uint32_t, uint32_t>;
PlaneOrder plane_order(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);
bool face_emits(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);

// A triangle in the coordinates of the face that it covers: within its three sides slope * at + offset is not negative.
struct CoverPatch {
  glm::dvec2 slope[3];
  double offset[3];
  glm::dvec2 low, high; // the box around what of it lies on the face
  bool loses = false;   // the face has the lower priority

  bool has(const glm::dvec2 &at) const {
    return glm::dot(slope[0], at) + offset[0] >= 0.0 && glm::dot(slope[1], at) + offset[1] >= 0.0 &&
           glm::dot(slope[2], at) + offset[2] >= 0.0;
  }
  // Whether no side has the whole of a box behind it.
  bool meets(const glm::dvec2 &middle, const glm::dvec2 &half) const {
    for (int i = 0; i < 3; ++i)
      if (glm::dot(slope[i], middle) + glm::dot(glm::abs(slope[i]), half) + offset[i] < 0.0)
        return false;
    return true;
  }
};

// Of one triangle on another. border: how far beyond its sides it may still be met.
CoverPatch make_patch(const FaceCoordinates &coordinates, const glm::dvec3 face[3], const glm::dvec3 other[3], double border);

// The patches of some faces, which are numbered as they are added, each face's in a grid.
class Cover {
public:
  void add_face(std::span<const CoverPatch> patches, const FaceCoordinates &coordinates);
  void add_face_covered_anywhere() { faces_.emplace_back(); }

  bool empty() const { return faces_.empty(); }
  // Whether there may be a patch at a place of a face; and one of higher priority than the face.
  bool may_be_covered(size_t face, const glm::dvec3 &p) const {
    return faces_[face].side == 0 || may_be(faces_[face], faces_[face].coordinates(p), false);
  }
  bool may_lose(size_t face, const glm::dvec3 &p) const {
    return faces_[face].side == 0 || may_be(faces_[face], faces_[face].coordinates(p), true);
  }
  bool may_lose(size_t face, const glm::dvec2 &at) const { return faces_[face].side == 0 || may_be(faces_[face], at, true); }
  size_t bytes() const;

private:
  struct Face {
    FaceCoordinates coordinates{};
    glm::dvec2 low{0.0}, cells_per_unit{0.0};
    uint32_t first_cell = 0;
    int side = 0; // cells along each axis; 0: covered anywhere

    // At or beyond the border: -1 and side.
    glm::ivec2 cell(const glm::dvec2 &at) const;
  };

  bool may_be(const Face &face, const glm::dvec2 &at, bool to_lose) const;

  std::vector<Face> faces_;
  std::vector<uint32_t> begins_; // by cell: its first entry; the next cell's ends it
  std::vector<uint32_t> entries_;
  std::vector<CoverPatch> patches_;
};

// Faces that others may overlap; among them may be a few of the same planes that none does.
struct CoplanarFaces {
  std::vector<uint8_t> instances; // 1: it has such faces; empty where nothing has
  std::vector<uint32_t> first;    // by instance: its first word of bits
  std::vector<uint64_t> bits;     // by face
  std::vector<uint32_t> ranks;    // by word of bits: how many faces are marked before it
  Cover cover;                    // by rank; empty where each may be covered anywhere

  bool any() const { return !instances.empty(); }
  bool has(uint32_t instance, uint32_t primitive) const {
    return instances[instance] && bits[first[instance] + (primitive >> 6)] >> (primitive & 63) & 1;
  }
  // Whether there may be others at a place of such a face.
  bool may_be_covered(uint32_t instance, uint32_t primitive, const glm::dvec3 &p) const {
    return cover.empty() || cover.may_be_covered(rank(instance, primitive), p);
  }
  // And whether such another may have the higher priority. at: p, or the weights of a triangle's corners that a hit gives.
  template <class Place> bool may_lose(uint32_t instance, uint32_t primitive, const Place &at) const {
    return cover.empty() || cover.may_lose(rank(instance, primitive), at);
  }
  size_t bytes() const {
    return instances.capacity() + (first.capacity() + ranks.capacity()) * sizeof(uint32_t) +
           bits.capacity() * sizeof(uint64_t) + cover.bytes();
  }

private:
  size_t rank(uint32_t instance, uint32_t primitive) const {
    const size_t word = first[instance] + (primitive >> 6);
    const uint64_t before = (uint64_t{1} << (primitive & 63)) - 1;
    return ranks[word] + static_cast<size_t>(std::popcount(bits[word] & before));
  }
};

// The same for every accelerator; its cost is bounded.
CoplanarFaces find_coplanar_faces(const Geometry &geometry, const FaceRounding &rounding, const PlaneRules &rules,
                                  const BuildContext &context);

// An accelerator with the priority order on top. Where faces cover the same place of a plane, as far as rounding tells, a ray
// from either side meets an opaque one before one that lets light through, then one that emits, then the one of the smaller
// instance, of the smaller slot, of the smaller number. A ray that starts on a face meets no other of its plane. A scene
// without such faces gets the plain accelerator.
std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, PlaneRules rules,
                                               const BuildContext &context);

} // namespace lancer
