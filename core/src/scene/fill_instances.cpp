// Checks and copies placements: existing meshes and materials, invertible or flattening maps.
#include "scene/affine.h"
#include "scene/description.h"
#include "scene/fill.h"
#include "scene/messages.h"
#include "scene/names.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// With larger scales, fourth powers of lengths would overflow double.
constexpr double kLargestScale = 1.2676506002282294e30; // 2^100

// A placement for the tracer; fault: why there is none, or empty.
struct Placement {
  Affine map;
  glm::dvec3 flat_axis{0.0};
  std::string fault;
};

Placement failed(const std::string &fault) { return {{}, glm::dvec3(0.0), fault}; }

// The placement of a singular map: a mesh or a plane with an area in the image of the map stays visible.
Placement flattened(const Affine &map, uint32_t kind) {
  const std::optional<FlatMap> flat = flat_map(map);
  if (flat && kind == LANCER_MESH)
    return {flat->map, flat->axis, ""};
  if (flat && kind == LANCER_PLANE && flat->axis.z * flat->axis.z == 1.0)
    return {flat->map, glm::dvec3(0.0), ""};
  if (flat && kind != LANCER_PLANE)
    return failed("its matrix is singular (a scale of 0), which no exact shape can have");
  return failed("its matrix is singular and leaves it no area");
}

Placement placement_of(const Affine &map, uint32_t kind) {
  if (!map.finite())
    return failed("its matrix is not finite");
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(map.linear[i]);
    if (length != 0.0 && (!(length < kLargestScale) || !(length > 1.0 / kLargestScale)))
      return failed("its scale is outside 2^-100 ... 2^100");
  }
  if (!(largest_coordinate(map.translation) < kLargestScale))
    return failed("its position is beyond 2^100");
  if (is_singular(map.linear))
    return flattened(map, kind);
  return {map, glm::dvec3(0.0), ""};
}

} // namespace

bool is_placement(const Affine &map) {
  const Placement placement = placement_of(map, LANCER_MESH);
  return placement.fault.empty() && placement.flat_axis == glm::dvec3(0.0);
}

namespace {

void check_instance(const Description &description, const std::string &object, const lancer_instance &given,
                    uint32_t slot_count) {
  if (given.kind > LANCER_CONE)
    bad_argument(object + ": kind " + std::to_string(given.kind) + " is not a shape");
  if (given.kind == LANCER_MESH && given.mesh >= description.meshes.size())
    bad_argument(object + ": mesh " + std::to_string(given.mesh) + " >= " + std::to_string(description.meshes.size()) +
                 " meshes");
  if (given.shading > LANCER_SHADING_PHONG)
    bad_argument(object + ": shading " + std::to_string(given.shading) + " is not one of 0 ... 3");
  check_rays(object, given.hidden_from);
  check_flags(object + ": ", given.flags, LANCER_INSTANCE_HOLDOUT | LANCER_INSTANCE_CATCHER);
  for (const uint32_t set : {given.receiver_set, given.blocker_set})
    if (set >= kLinkSets)
      bad_argument(object + ": set " + std::to_string(set) + " of light linking is not one of 0 ... 63");
  if (uint64_t(given.first_slot) + given.slot_count > slot_count)
    bad_argument(object + ": slots " + std::to_string(given.first_slot) + " + " + std::to_string(given.slot_count) + " > " +
                 std::to_string(slot_count) + " slots");
}

void check_slots(std::span<const uint32_t> slots, const Description &description) {
  for (size_t i = 0; i < slots.size(); ++i)
    if (slots[i] >= description.materials.size())
      bad_argument("instances: slot " + std::to_string(i) + " refers to material " + std::to_string(slots[i]) +
                   " >= " + std::to_string(description.materials.size()) + " materials");
}

// Checks an array of finite numbers with a row for each of the first count instances.
void check_rows(const Description &description, const std::string &what, uint32_t count, uint32_t width, const float *values) {
  if (count > description.instances_given)
    bad_argument(what + ": " + std::to_string(count) + " for " + std::to_string(description.instances_given) + " instances");
  for (size_t i = 0; i < size_t(count) * width; ++i)
    if (!std::isfinite(values[i]))
      bad_argument(what + ": number " + std::to_string(i % width) + " of instance " + std::to_string(i / width) + " is " +
                   to_text(values[i]));
}

} // namespace

void add_instances(Description &description, uint32_t count, const lancer_instance *instances, uint32_t slot_count,
                   const uint32_t *slots, const char *names, size_t names_size) {
  if (count && !instances)
    bad_argument("instances: NULL for " + std::to_string(count) + " instances");
  if (slot_count && !slots)
    bad_argument("instances: slots is NULL for " + std::to_string(slot_count) + " slots");
  if (names_size && (!names || names[names_size - 1] != '\0'))
    bad_argument("instances: names must end with a NUL");
  check_slots(std::span(slots, slot_count), description);
  // Check all before adding any: a rejected call adds nothing.
  const auto name_of = [&](const lancer_instance &given) { return given.name < names_size ? names + given.name : ""; };
  for (uint32_t i = 0; i < count; ++i) {
    if (names_size && instances[i].name >= names_size)
      bad_argument("instance #" + std::to_string(description.instances_given + i) + ": name offset " +
                   std::to_string(instances[i].name) + " >= " + std::to_string(names_size) + " bytes of names");
    check_instance(description, label("object", name_of(instances[i]), description.instances_given + i), instances[i],
                   slot_count);
  }

  const uint32_t slot_base = uint32_t(description.slots.size());
  description.slots.insert(description.slots.end(), slots, slots + slot_count);
  description.instances.reserve(description.instances.size() + count);
  for (uint32_t i = 0; i < count; ++i) {
    const lancer_instance &given = instances[i];
    Instance instance;
    instance.number = description.instances_given + i;
    const Placement placement = placement_of(Affine::from_rows(given.matrix), given.kind);
    if (!placement.fault.empty()) {
      description.instance_messages.add(label("object", name_of(given), instance.number),
                                        placement.fault + "; it was left out");
      continue;
    }
    instance.to_world = placement.map;
    instance.flat_axis = placement.flat_axis;
    instance.kind = static_cast<ShapeKind>(given.kind);
    instance.shading = static_cast<Shading>(given.shading);
    instance.mesh = given.kind == LANCER_MESH ? given.mesh : 0;
    instance.first_slot = slot_base + given.first_slot;
    instance.slot_count = given.slot_count;
    instance.object_index = given.object_index;
    instance.object_matte = given.object_matte;
    instance.asset_matte = given.asset_matte;
    instance.light_group = given.light_group;
    instance.hidden_from = given.hidden_from;
    instance.terminator = std::isfinite(given.terminator) ? std::clamp(given.terminator, 0.0f, 1.0f) : 0.0f;
    instance.holdout = (given.flags & LANCER_INSTANCE_HOLDOUT) != 0;
    instance.catcher = (given.flags & LANCER_INSTANCE_CATCHER) != 0;
    instance.receiver_set = given.receiver_set;
    instance.blocker_set = given.blocker_set;
    instance.links = {given.unlit_sets, given.clear_sets};
    instance.fast_distance = given.fast_distance > 0.0f ? double(given.fast_distance) : 0.0;
    description.instances.push_back(std::move(instance));
  }
  description.instances_given += count;
}

void check_references(const Description &description) {
  for (const Instance &instance : description.instances)
    if (instance.kind == ShapeKind::Mesh && instance.mesh >= description.meshes.size())
      bad_argument("instance #" + std::to_string(instance.number) + ": mesh " + std::to_string(instance.mesh) +
                   " >= " + std::to_string(description.meshes.size()) + " meshes");
  check_slots(description.slots, description);
}

void set_object_infos(Description &description, uint32_t count, const float *infos) {
  constexpr uint32_t kNumbers = 5;
  check_rows(description, "object infos", count, kNumbers, infos);
  std::vector<ObjectInfo> all(count);
  for (size_t i = 0; i < count; ++i) {
    const float *info = infos + i * kNumbers;
    all[i] = {{info[0], info[1], info[2], info[3]}, info[4]};
  }
  description.object_infos = std::move(all);
}

void add_object_attribute(Description &description, const char *name, uint32_t count, const float *values) {
  constexpr uint32_t kNumbers = 4;
  const std::string what = std::string("object attribute '") + (name ? name : "") + "'";
  if (!name)
    bad_argument(what + ": name is NULL");
  check_rows(description, what, count, kNumbers, values);
  ObjectAttribute attribute;
  attribute.name = attribute_name(name);
  for (const ObjectAttribute &other : description.object_attributes)
    if (other.name == attribute.name)
      bad_argument(what + ": was added before");
  attribute.values.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const float *row = values + i * kNumbers;
    attribute.values.emplace_back(row[0], row[1], row[2], row[3]);
  }
  description.object_attributes.push_back(std::move(attribute));
}

} // namespace lancer
