// Where surfaces lie in one plane, one of them is there: the priority order among coplanar faces, and the rule on top of any
// accelerator.
#pragma once

#include "accel/accelerator.h"

#include <tuple>
#include <vector>

namespace lancer {

// What is known of a scene beyond its geometry.
struct PlaneRules {
  glm::dvec3 origin{0.0};                   // of the user's world, which floats placed the instances from
  std::vector<uint8_t> transparent_slots{}; // by slot: its material lets light through; empty: none does
  std::vector<uint8_t> emitting_slots{};    // by slot: its material shines; empty: none does
};

// The least is there.
using PlaneOrder = std::tuple<bool, bool, uint32_t, uint32_t, uint32_t>;
PlaneOrder plane_order(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);
bool face_emits(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);

// An accelerator with one rule more. Where two faces cover the same place of a plane, as far as rounding tells, the one is met
// that lets no light through, then one that shines, then the one of the smaller instance, of the smaller slot, of the smaller
// number: from either side, whichever is closer by rounding. A ray that starts on a face meets no other of its plane. A scene
// without such faces gets the plain accelerator.
std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, PlaneRules rules,
                                               const BuildContext &context);

} // namespace lancer
