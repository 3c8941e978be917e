#include "scene/attribute.h"

namespace lancer {

namespace {

// Returns the index of a corner's first value.
size_t offset_of(const Mesh &mesh, const MeshAttribute &attribute, uint32_t triangle, int corner) {
  switch (attribute.domain) {
  case Domain::Vertex:
    return size_t(mesh.triangles[triangle][corner]) * attribute.channels;
  case Domain::Face:
    return size_t(triangle) * attribute.channels;
  case Domain::Corner:
    break;
  }
  return (size_t(triangle) * 3 + size_t(corner)) * attribute.channels;
}

glm::vec4 at_corner(const Mesh &mesh, const MeshAttribute &attribute, uint32_t triangle, int corner) {
  const float *values = attribute.values.data() + offset_of(mesh, attribute, triangle, corner);
  if (attribute.channels == 1)
    return {values[0], values[0], values[0], 1.0f};
  return {values[0], values[1], attribute.channels > 2 ? values[2] : 0.0f, attribute.channels > 3 ? values[3] : 1.0f};
}

} // namespace

const MeshAttribute *find_attribute(const Mesh &mesh, uint32_t name) {
  for (const MeshAttribute &attribute : mesh.attributes)
    if (attribute.name == name)
      return &attribute;
  return nullptr;
}

void corner_values(const Mesh &mesh, const MeshAttribute &attribute, uint32_t triangle, glm::vec4 (&values)[3]) {
  for (int corner = 0; corner < 3; ++corner)
    values[corner] = at_corner(mesh, attribute, triangle, corner);
}

glm::vec2 uv_at(const Mesh &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary) {
  glm::vec2 corner[3];
  if (!corner_uvs(mesh, name, triangle, corner))
    return glm::vec2(0.0f);
  const glm::dvec2 a(corner[0]), b(corner[1]), c(corner[2]);
  return {interpolate_uv(a.x, b.x, c.x, bary.x, bary.y), interpolate_uv(a.y, b.y, c.y, bary.x, bary.y)};
}

bool corner_uvs(const Mesh &mesh, const MeshAttribute *attribute, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]) {
  if (!attribute && (name != 0 || mesh.uvs.empty()))
    return false;
  for (int corner = 0; corner < 3; ++corner)
    uvs[corner] =
        attribute ? glm::vec2(at_corner(mesh, *attribute, triangle, corner)) : mesh.uvs[size_t(triangle) * 3 + size_t(corner)];
  return true;
}

bool corner_uvs(const Mesh &mesh, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]) {
  return corner_uvs(mesh, find_attribute(mesh, name), name, triangle, uvs);
}

} // namespace lancer
