// Which faces lie in one plane with others and cover a part of them, found once for a scene.
#pragma once

#include "accel/accelerator.h"
#include "accel/flat_face.h"
#include "accel/plane_order.h"

namespace lancer {

// The part of a face that others cover, in eight by eight cells of its coordinates; and where some of them go before it.
struct Covered {
  uint64_t face; // instance and primitive
  glm::dvec2 low, high;
  uint64_t cells, losing;

  // -1 and 8: beyond.
  glm::ivec2 cell(const glm::dvec2 &at) const {
    const glm::dvec2 scaled = 8.0 * (at - low) / (high - low);
    const auto whole = [](double x) { return x >= 0.0 ? x < 8.0 ? static_cast<int>(x) : 8 : -1; };
    return {whole(scaled.x), whole(scaled.y)};
  }
};

// Faces that may do so: a few others of the same planes may be among them.
struct CoplanarFaces {
  std::vector<uint8_t> instances; // 1: some of its faces do; empty where nothing does
  std::vector<uint32_t> first;    // by instance: its first word of bits
  std::vector<uint64_t> bits;     // by face
  std::vector<Covered> covered;   // in the order of faces; others may be covered anywhere

  bool any() const { return !instances.empty(); }
  bool has(uint32_t instance, uint32_t primitive) const {
    return instances[instance] && bits[first[instance] + (primitive >> 6)] >> (primitive & 63) & 1;
  }
  // Whether there may be others at a place of such a face: weights of a triangle's corners, x and y of an exact surface.
  bool may_be_covered(uint32_t instance, uint32_t primitive, const glm::dvec2 &at) const {
    return may_be(&Covered::cells, instance, primitive, at);
  }
  // And whether such another would be there instead of it.
  bool may_lose(uint32_t instance, uint32_t primitive, const glm::dvec2 &at) const {
    return may_be(&Covered::losing, instance, primitive, at);
  }
  size_t bytes() const {
    return instances.capacity() + first.capacity() * sizeof(uint32_t) + bits.capacity() * sizeof(uint64_t) +
           covered.capacity() * sizeof(Covered);
  }

private:
  bool may_be(uint64_t Covered::*cells, uint32_t instance, uint32_t primitive, const glm::dvec2 &at) const;
};

// The same for every accelerator; its cost is bounded.
CoplanarFaces find_coplanar_faces(const Geometry &geometry, const FaceRounding &rounding, const PlaneRules &rules,
                                  const BuildContext &context);

} // namespace lancer
