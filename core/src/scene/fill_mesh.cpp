// Checks and copies meshes: every index in range, every kept face of finite and non-zero area.
#include "scene/description.h"
#include "scene/fill.h"
#include "scene/geometry.h"
#include "scene/messages.h"
#include "scene/names.h"

#include <cmath>

namespace lancer {

namespace {

bool finite(const glm::vec3 &v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_indices(const std::string &object, const lancer_mesh &mesh) {
  for (size_t i = 0; i < size_t(mesh.triangle_count) * 3; ++i) {
    if (mesh.triangles[i] >= mesh.vertex_count)
      bad_argument(object + ": index " + std::to_string(mesh.triangles[i]) + " >= " + std::to_string(mesh.vertex_count) +
                   " vertices");
  }
}

// Returns whether a face has corners at all keys that can be hit, and an area at some of them.
bool can_be_hit(const Mesh &mesh, uint32_t face, size_t &not_finite, size_t &flat) {
  const uint32_t shapes = mesh.key_count + 1;
  bool area = false;
  for (uint32_t shape = 0; shape < shapes; ++shape) {
    glm::vec3 p[3];
    for (int corner = 0; corner < 3; ++corner)
      p[corner] = shape == 0 ? mesh.vertex(face, corner)
                             : mesh.moved_positions[size_t(shape - 1) * mesh.positions.size() + mesh.triangles[face][corner]];
    if (!is_usable(p[0]) || !is_usable(p[1]) || !is_usable(p[2])) {
      ++not_finite;
      return false;
    }
    area = area || has_area(p[0], p[1], p[2]);
  }
  flat += !area;
  return area;
}

// Returns the faces that can be hit: finite corners, and an area that is not zero in double.
std::vector<uint32_t> kept_faces(const std::string &object, const Mesh &mesh, Messages &messages) {
  std::vector<uint32_t> kept;
  kept.reserve(mesh.triangles.size());
  size_t not_finite = 0, flat = 0;
  for (uint32_t face = 0; face < mesh.triangles.size(); ++face)
    if (can_be_hit(mesh, face, not_finite, flat))
      kept.push_back(face);
  if (not_finite)
    messages.add(object, std::to_string(not_finite) + " faces with vertices that are not finite were left out");
  if (flat)
    messages.add(object, std::to_string(flat) + " faces without area were left out");
  return kept;
}

// Copies an array of count vectors; NULL copies none.
template <class Vector> void copy(const float *source, size_t count, std::vector<Vector> &target) {
  const auto *in = reinterpret_cast<const Vector *>(source);
  if (in)
    target.assign(in, in + count);
}

void copy_normals(const lancer_mesh &source, Mesh &mesh) {
  if (!source.normals || source.normal_domain == LANCER_NORMALS_NONE)
    return;
  mesh.normal_domain = static_cast<NormalDomain>(source.normal_domain);
  const bool corners = mesh.normal_domain == NormalDomain::Corner;
  copy(source.normals, corners ? size_t(source.triangle_count) * 3 : source.vertex_count, mesh.normals);
}

// Replaces normals that are not finite by zero, which means the geometric normal.
void check_normals(const std::string &object, Mesh &mesh, Messages &messages) {
  size_t replaced = 0;
  for (std::vector<glm::vec3> *normals : {&mesh.normals, &mesh.moved_normals})
    for (glm::vec3 &n : *normals) {
      if (!finite(n)) {
        n = glm::vec3(0.0f);
        ++replaced;
      }
    }
  if (replaced)
    messages.add(object, std::to_string(replaced) + " normals that are not finite were replaced by geometric ones");
}

size_t zero_where_not_finite(std::vector<float> &values) {
  size_t replaced = 0;
  for (float &value : values) {
    if (std::isfinite(value))
      continue;
    value = 0.0f;
    ++replaced;
  }
  return replaced;
}

template <class Vector> size_t zero_where_not_finite(std::vector<Vector> &values) {
  size_t replaced = 0;
  for (Vector &v : values) {
    for (int i = 0; i < v.length(); ++i) {
      if (!std::isfinite(v[i])) {
        v[i] = 0.0f;
        ++replaced;
      }
    }
  }
  return replaced;
}

void check_polygons(const std::string &object, const lancer_mesh &mesh) {
  for (uint32_t i = 0; mesh.polygons && i < mesh.triangle_count; ++i)
    if (mesh.polygons[i] >= mesh.triangle_count)
      bad_argument(object + ": polygon " + std::to_string(mesh.polygons[i]) + " >= " + std::to_string(mesh.triangle_count) +
                   " triangles");
}

void check_attributes(const std::string &object, const lancer_mesh &mesh) {
  if (mesh.attribute_count && !mesh.attributes)
    bad_argument(object + ": attributes is NULL for " + std::to_string(mesh.attribute_count) + " attributes");
  for (uint32_t i = 0; i < mesh.attribute_count; ++i) {
    const lancer_attribute &attribute = mesh.attributes[i];
    const std::string where = object + ": " + label("attribute", attribute.name, i) + ": ";
    if (!attribute.name || !*attribute.name)
      bad_argument(where + "it has no name");
    if (attribute.domain > LANCER_DOMAIN_CORNER)
      bad_argument(where + "domain " + std::to_string(attribute.domain) + " is not one of 0, 1, 2");
    if (attribute.channels < 1 || attribute.channels > 4)
      bad_argument(where + "channels " + std::to_string(attribute.channels) + " is not 1 ... 4");
    if (!attribute.values && (attribute.domain == LANCER_DOMAIN_VERTEX ? mesh.vertex_count : mesh.triangle_count))
      bad_argument(where + "values is NULL");
  }
}

void copy_attribute(const lancer_attribute &source, Mesh &mesh) {
  const MeshAttribute &attribute =
      mesh.add_attribute(attribute_name(source.name), static_cast<Domain>(source.domain), source.channels);
  mesh.attribute_values.insert(mesh.attribute_values.end(), source.values, source.values + mesh.count_of(attribute));
}

// Copies the vertices at the moments of the pass Vector. A vertex that is not finite there stands still.
void copy_vector_positions(const std::string &object, const lancer_mesh &source, Mesh &mesh, Messages &messages) {
  copy(source.vector_positions, size_t(source.vertex_count) * kMoments, mesh.vector_positions);
  size_t replaced = 0;
  for (size_t i = 0; i < mesh.vector_positions.size(); ++i)
    if (!is_usable(mesh.vector_positions[i])) {
      mesh.vector_positions[i] = mesh.positions[i % mesh.positions.size()];
      ++replaced;
    }
  if (replaced)
    messages.add(object, std::to_string(replaced) +
                             " vertices one frame before or after are not finite; in the pass Vector they stand still");
}

// Finds the bounds of all usable vertices.
void find_bounds(Mesh &mesh) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const glm::vec3 &p : mesh.positions) {
    if (!is_usable(p))
      continue;
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  if (!(low.x <= high.x))
    return;
  mesh.low = low;
  mesh.high = high;
}

} // namespace

Mesh read_mesh(const lancer_mesh &source, size_t number, Messages &messages) {
  const std::string object = label("mesh", source.name, number);
  // Reject invalid arrays.
  if (source.vertex_count && !source.positions)
    bad_argument(object + ": positions is NULL for " + std::to_string(source.vertex_count) + " vertices");
  if (source.triangle_count && !source.triangles)
    bad_argument(object + ": triangles is NULL for " + std::to_string(source.triangle_count) + " triangles");
  if (source.normal_domain > LANCER_NORMALS_CORNER)
    bad_argument(object + ": normal_domain " + std::to_string(source.normal_domain) + " is not one of 0, 1, 2");
  check_indices(object, source);
  check_polygons(object, source);
  check_attributes(object, source);
  if (source.key_count > 0) {
    check_key_count(object, source.key_count);
    if (source.vertex_count && !source.moved_positions)
      bad_argument(object + ": moved_positions is NULL for " + std::to_string(source.key_count) + " keys");
  }

  // Copy the mesh, then drop the faces that cannot be hit.
  Mesh mesh;
  mesh.name = source.name ? source.name : "";
  copy(source.positions, source.vertex_count, mesh.positions);
  const auto *triangles = reinterpret_cast<const glm::uvec3 *>(source.triangles);
  mesh.triangles.assign(triangles, triangles + source.triangle_count);
  copy_normals(source, mesh);
  mesh.key_count = source.key_count;
  copy(source.moved_positions, size_t(source.vertex_count) * source.key_count, mesh.moved_positions);
  copy(source.moved_normals, mesh.normals.size() * source.key_count, mesh.moved_normals);
  copy_vector_positions(object, source, mesh, messages);
  copy(source.uvs, size_t(source.triangle_count) * 3, mesh.uvs);
  copy(source.colors, size_t(source.triangle_count) * 3, mesh.colors);
  if (source.material_slots)
    mesh.material_slots.assign(source.material_slots, source.material_slots + source.triangle_count);
  if (source.polygons)
    mesh.polygons.assign(source.polygons, source.polygons + source.triangle_count);
  for (uint32_t i = 0; i < source.attribute_count; ++i)
    copy_attribute(source.attributes[i], mesh);
  const std::vector<uint32_t> kept = kept_faces(object, mesh, messages);
  if (kept.size() != mesh.triangles.size())
    keep_faces(mesh, kept);
  find_bounds(mesh);

  // Replace values that are not finite.
  check_normals(object, mesh, messages);
  const size_t replaced =
      zero_where_not_finite(mesh.uvs) + zero_where_not_finite(mesh.colors) + zero_where_not_finite(mesh.attribute_values);
  if (replaced)
    messages.add(object, std::to_string(replaced) + " texture coordinates or colours that are not finite were set to 0");
  return mesh;
}

void add_mesh(Description &description, const lancer_mesh &source) {
  Messages messages;
  Mesh mesh = read_mesh(source, description.meshes.size(), messages);
  description.meshes.emplace_back(std::move(mesh), std::move(messages));
}

} // namespace lancer
