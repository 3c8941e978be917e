#include "scene/geometry.h"

#include <algorithm>
#include <cmath>
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

} // namespace

bool is_usable(const glm::vec3 &vertex) {
  // Each comparison is false for NaN, so a vertex with NaN is not usable.
  constexpr float limit = 0x1p60f;
  return std::abs(vertex.x) <= limit && std::abs(vertex.y) <= limit && std::abs(vertex.z) <= limit;
}

bool has_area(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) != glm::dvec3(0.0);
}

void keep_faces(Mesh &mesh, const std::vector<uint32_t> &kept) {
  // Record the user's face numbers.
  if (mesh.face_of.empty()) {
    mesh.face_of.resize(mesh.triangles.size());
    std::iota(mesh.face_of.begin(), mesh.face_of.end(), 0u);
  }
  retain(mesh.face_of, 1, kept);
  retain(mesh.triangles, 1, kept);
  if (mesh.normal_domain == NormalDomain::Corner)
    retain(mesh.normals, 3, kept);
  retain(mesh.uvs, 3, kept);
  retain(mesh.colors, 3, kept);
  retain(mesh.material_slots, 1, kept);
  retain(mesh.polygons, 1, kept);
  for (MeshAttribute &attribute : mesh.attributes)
    if (attribute.domain != Domain::Vertex)
      retain(attribute.values, attribute.channels * (attribute.domain == Domain::Corner ? 3u : 1u), kept);
}

} // namespace lancer
