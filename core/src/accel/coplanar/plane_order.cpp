#include "accel/coplanar/plane_order.h"

#include <algorithm>

namespace lancer {

namespace {

uint32_t slot_of(const Geometry &geometry, uint32_t number, uint32_t primitive) {
  const Instance &instance = geometry.instances[number];
  if (instance.kind != ShapeKind::Mesh || instance.slot_count == 0 || geometry.meshes[instance.mesh].material_slots.empty())
    return 0;
  return std::min<uint32_t>(geometry.meshes[instance.mesh].material_slots[primitive], instance.slot_count - 1);
}

bool is(const Geometry &geometry, const std::vector<uint8_t> &slots, uint32_t number, uint32_t primitive) {
  const Instance &instance = geometry.instances[number];
  return instance.slot_count > 0 && !slots.empty() && slots[instance.first_slot + slot_of(geometry, number, primitive)] != 0;
}

} // namespace

PlaneOrder plane_order(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive) {
  return {is(geometry, rules.passing_slots, instance, primitive), !face_emits(geometry, rules, instance, primitive), instance,
          slot_of(geometry, instance, primitive), primitive};
}

bool face_emits(const Geometry &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive) {
  return is(geometry, rules.emitting_slots, instance, primitive);
}

} // namespace lancer
