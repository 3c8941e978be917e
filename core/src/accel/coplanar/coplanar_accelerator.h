// The priority order among coplanar faces, of which a ray meets one alone; and the accelerator that applies it to the hits of
// any other.
#pragma once

#include "accel/accelerator.h"

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

// An accelerator with the priority order on top. Where faces cover the same place of a plane, as far as rounding tells, a ray
// from either side meets an opaque one before one that lets light through, then one that emits, then the one of the smaller
// instance, of the smaller slot, of the smaller number. A ray that starts on a face meets no other of its plane. A scene
// without such faces gets the plain accelerator.
std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, PlaneRules rules,
                                               const BuildContext &context);

} // namespace lancer
