// Which faces lie in one plane with others and cover a part of them, found once for a scene.
#pragma once

#include "accel/accelerator.h"
#include "accel/coplanar/cover.h"
#include "accel/coplanar/flat_face.h"
#include "accel/coplanar/plane_order.h"

#include <bit>

namespace lancer {

// Faces that may do so: a few others of the same planes may be among them.
struct CoplanarFaces {
  std::vector<uint8_t> instances; // 1: some of its faces do; empty where nothing does
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
  // And whether such another would be there instead of it. at: p, or as a hit tells it: weights of a triangle's corners.
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

} // namespace lancer
