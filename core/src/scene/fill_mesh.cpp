// Checks and copies meshes: every index in range, every kept face of finite and non-zero area.
#include "scene/description.h"
#include "scene/error.h"

#include <cmath>
#include <numeric>

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

// A vertex beyond 2^60 squares out of float's range; no scene is measured so.
bool usable(const glm::vec3 &v) {
  constexpr float limit = 1152921504606846976.0f;
  return finite(v) && std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
}

// The faces that can be hit: finite corners, and an area that is not zero in double.
std::vector<uint32_t> kept_faces(const std::string &object, const lancer_mesh &mesh, Messages &messages) {
  std::vector<uint32_t> kept;
  kept.reserve(mesh.triangle_count);
  const auto *positions = reinterpret_cast<const glm::vec3 *>(mesh.positions);
  size_t not_finite = 0, flat = 0;
  for (uint32_t face = 0; face < mesh.triangle_count; ++face) {
    const uint32_t *corner = mesh.triangles + size_t(face) * 3;
    const glm::vec3 &a = positions[corner[0]], &b = positions[corner[1]], &c = positions[corner[2]];
    if (!usable(a) || !usable(b) || !usable(c)) {
      ++not_finite;
      continue;
    }
    const glm::dvec3 area = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    if (area == glm::dvec3(0.0)) {
      ++flat;
      continue;
    }
    kept.push_back(face);
  }
  if (not_finite)
    messages.add(object, std::to_string(not_finite) + " faces with vertices that are not finite were left out");
  if (flat)
    messages.add(object, std::to_string(flat) + " faces without area were left out");
  return kept;
}

// Copies an array of three entries per face, kept faces only.
template <class Out> void copy_corners(const float *source, const std::vector<uint32_t> &kept, std::vector<Out> &target) {
  if (!source)
    return;
  const auto *in = reinterpret_cast<const Out *>(source);
  target.resize(kept.size() * 3);
  for (size_t i = 0; i < kept.size(); ++i)
    for (size_t corner = 0; corner < 3; ++corner)
      target[3 * i + corner] = in[3 * size_t(kept[i]) + corner];
}

void copy_normals(const std::string &object, const lancer_mesh &source, const std::vector<uint32_t> &kept, Mesh &mesh,
                  Messages &messages) {
  if (!source.normals || source.normal_domain == LANCER_NORMALS_NONE)
    return;
  mesh.normal_domain = static_cast<NormalDomain>(source.normal_domain);
  if (mesh.normal_domain == NormalDomain::Corner) {
    copy_corners(source.normals, kept, mesh.normals);
  } else {
    const auto *normals = reinterpret_cast<const glm::vec3 *>(source.normals);
    mesh.normals.assign(normals, normals + source.vertex_count);
  }
  // A zero normal makes the surface take its geometric one; so does one that is not finite.
  size_t replaced = 0;
  for (glm::vec3 &n : mesh.normals) {
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

// Copies an attribute, of kept faces only where it stands for faces.
MeshAttribute copy_attribute(Description &description, const lancer_attribute &source, uint32_t vertex_count,
                             const std::vector<uint32_t> &kept) {
  MeshAttribute attribute;
  attribute.name = attribute_name(description, source.name);
  attribute.domain = static_cast<Domain>(source.domain);
  attribute.channels = source.channels;
  if (attribute.domain == Domain::Vertex) {
    attribute.values.assign(source.values, source.values + size_t(vertex_count) * source.channels);
    return attribute;
  }
  const size_t size = size_t(source.channels) * (attribute.domain == Domain::Corner ? 3 : 1);
  attribute.values.reserve(kept.size() * size);
  for (const uint32_t face : kept)
    attribute.values.insert(attribute.values.end(), source.values + face * size, source.values + (face + 1) * size);
  return attribute;
}

// The bounds of all vertices that are somewhere.
void find_bounds(Mesh &mesh) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const glm::vec3 &p : mesh.positions) {
    if (!usable(p))
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

void add_mesh(Description &description, const lancer_mesh &source) {
  const std::string object = label("mesh", source.name, description.geometry.meshes.size());
  // Refuse what cannot be read.
  if (source.vertex_count && !source.positions)
    bad_argument(object + ": positions is NULL for " + std::to_string(source.vertex_count) + " vertices");
  if (source.triangle_count && !source.triangles)
    bad_argument(object + ": triangles is NULL for " + std::to_string(source.triangle_count) + " triangles");
  if (source.normal_domain > LANCER_NORMALS_CORNER)
    bad_argument(object + ": normal_domain " + std::to_string(source.normal_domain) + " is not one of 0, 1, 2");
  check_indices(object, source);
  check_attributes(object, source);

  // Keep the faces that can be hit, with their attributes.
  const std::vector<uint32_t> kept = kept_faces(object, source, description.messages);
  Mesh mesh;
  mesh.name = source.name ? source.name : "";
  const auto *positions = reinterpret_cast<const glm::vec3 *>(source.positions);
  mesh.positions.assign(positions, positions + source.vertex_count);
  mesh.triangles.resize(kept.size());
  for (size_t i = 0; i < kept.size(); ++i) {
    const uint32_t *corner = source.triangles + size_t(kept[i]) * 3;
    mesh.triangles[i] = {corner[0], corner[1], corner[2]};
  }
  if (kept.size() != source.triangle_count)
    mesh.face_of = kept;
  copy_normals(object, source, kept, mesh, description.messages);
  copy_corners(source.uvs, kept, mesh.uvs);
  copy_corners(source.colors, kept, mesh.colors);
  find_bounds(mesh);
  size_t replaced = zero_where_not_finite(mesh.uvs) + zero_where_not_finite(mesh.colors);
  for (uint32_t i = 0; i < source.attribute_count; ++i) {
    mesh.attributes.push_back(copy_attribute(description, source.attributes[i], source.vertex_count, kept));
    replaced += zero_where_not_finite(mesh.attributes.back().values);
  }
  if (replaced)
    description.messages.add(object,
                             std::to_string(replaced) + " texture coordinates or colours that are not finite were set to 0");
  if (source.material_slots) {
    mesh.material_slots.resize(kept.size());
    for (size_t i = 0; i < kept.size(); ++i)
      mesh.material_slots[i] = source.material_slots[kept[i]];
  }
  description.geometry.meshes.push_back(std::move(mesh));
}

} // namespace lancer
