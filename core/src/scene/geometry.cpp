#include "scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace lancer {

namespace {

// Returns the largest sum of absolute values in a row: the factor by which a map can enlarge the largest component.
double row_norm(const glm::dmat3 &m) {
  double norm = 0.0;
  for (int row = 0; row < 3; ++row)
    norm = std::max(norm, std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row]));
  return norm;
}

} // namespace

double largest_coordinate(const glm::dvec3 &v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

void Instance::place(const Affine &map) {
  to_world = map;
  to_object = inverse(map);
  reach = {row_norm(to_world.linear), largest_coordinate(to_world.translation), row_norm(to_object.linear),
           largest_coordinate(to_object.translation)};
}

namespace {

// Moves the kept entries to the front: width entries per face.
template <class Entry> void retain(std::vector<Entry> &entries, size_t width, const std::vector<uint32_t> &kept) {
  if (entries.empty())
    return;
  for (size_t i = 0; i < kept.size(); ++i)
    std::copy_n(entries.begin() + ptrdiff_t(kept[i] * width), width, entries.begin() + ptrdiff_t(i * width));
  entries.resize(kept.size() * width);
}

// The same for entries of keys, each of which has `count` of them.
template <class Entry>
void retain_keys(std::vector<Entry> &entries, size_t count, size_t width, const std::vector<uint32_t> &kept) {
  std::vector<Entry> all;
  for (size_t first = 0; first < entries.size(); first += count) {
    std::vector<Entry> of_key(entries.begin() + ptrdiff_t(first), entries.begin() + ptrdiff_t(first + count));
    retain(of_key, width, kept);
    all.insert(all.end(), of_key.begin(), of_key.end());
  }
  entries = std::move(all);
}

} // namespace

bool is_usable(const glm::vec3 &vertex) {
  // Each comparison is false for NaN, so a vertex with NaN is not usable.
  constexpr float limit = 0x1p60f;
  return std::abs(vertex.x) <= limit && std::abs(vertex.y) <= limit && std::abs(vertex.z) <= limit;
}

bool has_area(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) != glm::dvec3(0.0);
}

bool Instance::same(const Instance &other) const {
  const auto bits = [](const auto &a, const auto &b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  return bits(to_world, other.to_world) && bits(to_object, other.to_object) && bits(reach, other.reach) && kind == other.kind &&
         shading == other.shading && mesh == other.mesh && first_slot == other.first_slot && slot_count == other.slot_count &&
         object_index == other.object_index && object_matte == other.object_matte && asset_matte == other.asset_matte &&
         light_group == other.light_group && hidden_from == other.hidden_from && holdout == other.holdout &&
         catcher == other.catcher && bits(terminator, other.terminator) && number == other.number &&
         bits(flat_axis, other.flat_axis) && receiver_set == other.receiver_set && blocker_set == other.blocker_set &&
         links == other.links && fast_distance == other.fast_distance && first_key == other.first_key &&
         key_count == other.key_count;
}

MeshAttribute &Mesh::add_attribute(uint32_t attribute, Domain domain, uint32_t channels) {
  return attributes.emplace_back(attribute, domain, channels, attribute_values.size());
}

size_t Mesh::count_of(const MeshAttribute &attribute) const {
  const size_t rows = attribute.domain == Domain::Vertex ? positions.size()
                      : attribute.domain == Domain::Face ? triangles.size()
                                                         : 3 * triangles.size();
  return rows * attribute.channels;
}

Mesh::operator MeshView() const {
  return {.positions = positions,
          .triangles = triangles,
          .face_of = face_of,
          .normals = normals,
          .uvs = uvs,
          .colors = colors,
          .material_slots = material_slots,
          .polygons = polygons,
          .attributes = attributes,
          .attribute_values = attribute_values,
          .low = low,
          .high = high,
          .normal_domain = normal_domain,
          .smooth_normals = {},
          .centers = {},
          .moved_positions = moved_positions,
          .moved_normals = moved_normals,
          .vector_positions = vector_positions,
          .key_count = key_count};
}

size_t Mesh::bytes() const {
  return (positions.size() + moved_positions.size() + moved_normals.size() + vector_positions.size()) * sizeof(glm::vec3) +
         triangles.size() * sizeof(glm::uvec3) + (normals.size() + colors.size()) * sizeof(glm::vec3) +
         uvs.size() * sizeof(glm::vec2) + material_slots.size() * sizeof(uint16_t) +
         (face_of.size() + polygons.size()) * sizeof(uint32_t) + attribute_values.size() * sizeof(float);
}

std::vector<ObjectAttributeView> views_of(std::span<const ObjectAttribute> attributes) {
  std::vector<ObjectAttributeView> views;
  for (const ObjectAttribute &attribute : attributes)
    views.push_back({attribute.name, attribute.values});
  return views;
}

void keep_faces(Mesh &mesh, const std::vector<uint32_t> &kept) {
  std::vector<size_t> counts;
  for (const MeshAttribute &attribute : mesh.attributes)
    counts.push_back(mesh.count_of(attribute));
  // Record the user's face numbers.
  if (mesh.face_of.empty()) {
    mesh.face_of.resize(mesh.triangles.size());
    std::iota(mesh.face_of.begin(), mesh.face_of.end(), 0u);
  }
  retain(mesh.face_of, 1, kept);
  retain(mesh.triangles, 1, kept);
  if (mesh.normal_domain == NormalDomain::Corner) {
    retain_keys(mesh.moved_normals, mesh.normals.size(), 3, kept);
    retain(mesh.normals, 3, kept);
  }
  retain(mesh.uvs, 3, kept);
  retain(mesh.colors, 3, kept);
  retain(mesh.material_slots, 1, kept);
  retain(mesh.polygons, 1, kept);
  std::vector<float> values;
  for (MeshAttribute &attribute : mesh.attributes) {
    const auto from = mesh.attribute_values.begin() + ptrdiff_t(attribute.first);
    std::vector<float> own(from, from + ptrdiff_t(counts[size_t(&attribute - mesh.attributes.data())]));
    if (attribute.domain != Domain::Vertex)
      retain(own, attribute.channels * (attribute.domain == Domain::Corner ? 3u : 1u), kept);
    attribute.first = values.size();
    values.insert(values.end(), own.begin(), own.end());
  }
  mesh.attribute_values = std::move(values);
}

} // namespace lancer
