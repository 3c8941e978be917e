// Whose turn it is to be there, of faces in one plane.
#pragma once

#include "accel/ray.h"
#include "scene/geometry.h"

#include <tuple>
#include <vector>

namespace lancer {

// What is known of a scene beyond its geometry.
struct PlaneRules {
  glm::dvec3 origin{0.0};                // of the user's world, which floats placed the instances from
  std::vector<uint8_t> passing_slots{};  // by slot: its material lets light through; empty: none does
  std::vector<uint8_t> emitting_slots{}; // by slot: its material shines; empty: none does
};

// The least is there.
using PlaneOrder = std::tuple<bool, bool, uint32_t, uint32_t, uint32_t>;
PlaneOrder plane_order(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);
bool face_emits(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);

} // namespace lancer
