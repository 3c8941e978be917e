// Meshes of flattening placements: projected to a plane of object space, so that every later step sees a plane surface.
#include "compile/steps.h"
#include "scene/geometry.h"
#include "scene/surface.h"
#include "simd/parallel.h"

#include <array>
#include <map>

namespace lancer {

namespace {

glm::dvec3 across(const glm::dvec3 &axis, const glm::dvec3 &v) { return v - glm::dot(axis, v) * axis; }

// Projects the first three channels of each entry.
void lay(std::vector<float> &values, uint32_t channels, const glm::dvec3 &axis) {
  for (size_t i = 0; i + 2 < values.size(); i += channels) {
    const glm::dvec3 laid = across(axis, {values[i], values[i + 1], values[i + 2]});
    for (int k = 0; k < 3; ++k)
      values[i + size_t(k)] = float(laid[k]);
  }
}

// Generated coordinates before the projection, for a mesh that has none.
void keep_generated(Mesh &mesh, uint32_t name) {
  if (find_attribute(mesh, name))
    return;
  MeshAttribute attribute;
  attribute.name = name;
  attribute.domain = Domain::Vertex;
  attribute.channels = 3;
  const glm::dvec3 low(mesh.low), high(mesh.high);
  for (const glm::vec3 &p : mesh.positions)
    for (int k = 0; k < 3; ++k) {
      const double size = high[k] > low[k] ? high[k] - low[k] : 1.0;
      attribute.values.push_back(float((double(p[k]) - 0.5 * (low[k] + high[k])) / size + 0.5));
    }
  mesh.attributes.push_back(std::move(attribute));
}

// number: of the mesh that was copied.
void lay_mesh(Description &description, Mesh &mesh, uint32_t number, const glm::dvec3 &axis) {
  const std::vector<std::string> &names = description.attribute_names;
  for (uint32_t name = 0; name < names.size(); ++name)
    if (names[name] == "generated")
      keep_generated(mesh, name);
  for (MeshAttribute &attribute : mesh.attributes)
    if (attribute.channels >= 3 && (attribute.name == kUndisplaced || names[attribute.name].starts_with("tangent:")))
      lay(attribute.values, attribute.channels, axis);
  for (glm::vec3 &p : mesh.positions)
    p = glm::vec3(across(axis, glm::dvec3(p)));
  // Cofactors map each normal to one side of the plane, or to 0, which selects the face's normal.
  for (glm::vec3 &n : mesh.normals) {
    const double side = glm::dot(axis, glm::dvec3(n));
    n = side == 0.0 ? glm::vec3(0.0f) : glm::vec3(side < 0.0 ? -axis : axis);
  }
  std::vector<uint32_t> kept;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (has_area(mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2)))
      kept.push_back(i);
  if (kept.empty() && !mesh.triangles.empty())
    description.messages.add(label("mesh", mesh.name.c_str(), number), "where its placement flattens it, it has no area");
  if (kept.size() != mesh.triangles.size())
    keep_faces(mesh, kept);
}

} // namespace

void flatten(Description &description, const BuildContext &context) {
  Geometry &geometry = description.geometry;
  using Key = std::pair<uint32_t, std::array<double, 3>>; // mesh and axis
  std::map<Key, uint32_t> laid;
  for (Instance &instance : geometry.instances) {
    if (instance.flat_axis == glm::dvec3(0.0))
      continue;
    poll_cancel(context);
    const glm::dvec3 axis = instance.flat_axis;
    const auto [known, fresh] = laid.emplace(Key(instance.mesh, {axis.x, axis.y, axis.z}), uint32_t(geometry.meshes.size()));
    if (fresh) {
      geometry.meshes.push_back(Mesh(geometry.meshes[instance.mesh]));
      lay_mesh(description, geometry.meshes.back(), instance.mesh, axis);
    }
    instance.mesh = known->second;
  }
}

} // namespace lancer
