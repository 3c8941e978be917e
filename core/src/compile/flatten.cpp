// Meshes of flattening placements: projected to a plane of object space, so that every later step sees a plane surface.
#include "compile/steps.h"
#include "scene/geometry.h"
#include "scene/names.h"
#include "scene/surface.h"
#include "simd/parallel.h"

#include <algorithm>
#include <array>
#include <map>

namespace lancer {

namespace {

glm::dvec3 across(const glm::dvec3 &axis, const glm::dvec3 &v) { return v - glm::dot(axis, v) * axis; }

// Projects the first three channels of each entry.
void lay(std::span<float> values, uint32_t channels, const glm::dvec3 &axis) {
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
  mesh.add_attribute(name, Domain::Vertex, 3);
  const glm::dvec3 low(mesh.low), high(mesh.high);
  for (const glm::vec3 &p : mesh.positions)
    for (int k = 0; k < 3; ++k) {
      const double size = high[k] > low[k] ? high[k] - low[k] : 1.0;
      mesh.attribute_values.push_back(float((double(p[k]) - 0.5 * (low[k] + high[k])) / size + 0.5));
    }
}

// Whether a node reads generated coordinates.
bool reads_generated(const Description &description) {
  const uint32_t generated = attribute_name("generated");
  return std::ranges::any_of(description.materials, [&](const Given<Material> &material) {
    return std::ranges::any_of(material->program.nodes, [&](const Node &node) { return node.name == generated; });
  });
}

// number: of the mesh that was copied.
void lay_mesh(Mesh &mesh, uint32_t number, const glm::dvec3 &axis, bool keeps_generated, Messages &messages) {
  if (keeps_generated)
    keep_generated(mesh, attribute_name("generated"));
  for (const MeshAttribute &attribute : mesh.attributes)
    if (attribute.channels >= 3 && (attribute.name == kUndisplaced || attribute_of(attribute.name).starts_with("tangent:")))
      lay(std::span(mesh.attribute_values).subspan(attribute.first, mesh.count_of(attribute)), attribute.channels, axis);
  for (std::vector<glm::vec3> *positions : {&mesh.positions, &mesh.moved_positions, &mesh.vector_positions})
    for (glm::vec3 &p : *positions)
      p = glm::vec3(across(axis, glm::dvec3(p)));
  // Cofactors map each normal to one side of the plane, or to 0, which selects the face's normal.
  for (std::vector<glm::vec3> *normals : {&mesh.normals, &mesh.moved_normals})
    for (glm::vec3 &n : *normals) {
      const double side = glm::dot(axis, glm::dvec3(n));
      n = side == 0.0 ? glm::vec3(0.0f) : glm::vec3(side < 0.0 ? -axis : axis);
    }
  std::vector<uint32_t> kept;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (has_area(mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2)))
      kept.push_back(i);
  if (kept.empty() && !mesh.triangles.empty())
    messages.add(label("mesh", mesh.name.c_str(), number), "where its placement flattens it, it has no area");
  if (kept.size() != mesh.triangles.size())
    keep_faces(mesh, kept);
}

} // namespace

void flatten(Description &description, const BuildContext &context, MadeMeshes &made, const MadeMeshes *before) {
  using Key = std::pair<uint32_t, std::array<double, 3>>; // mesh and axis
  std::map<Key, uint32_t> laid;
  for (Instance &instance : description.instances) {
    if (instance.flat_axis == glm::dvec3(0.0))
      continue;
    poll_cancel(context);
    const glm::dvec3 axis = instance.flat_axis;
    const auto [known, fresh] = laid.emplace(Key(instance.mesh, {axis.x, axis.y, axis.z}), uint32_t(description.meshes.size()));
    if (fresh) {
      const std::shared_ptr<const Mesh> given = description.meshes[instance.mesh].object;
      LaidMesh laid_mesh{given, nullptr, instance.mesh, axis, reads_generated(description), {}};
      if (const LaidMesh *before_it = find_made(before ? &before->laid : nullptr, laid_mesh)) {
        laid_mesh = *before_it;
      } else {
        count_made(context, &MadeCounts::changed_meshes);
        Mesh mesh(*given);
        lay_mesh(mesh, instance.mesh, axis, laid_mesh.keeps_generated, laid_mesh.messages);
        laid_mesh.made = std::make_shared<const Mesh>(std::move(mesh));
      }
      description.meshes.emplace_back();
      description.meshes.back().object = laid_mesh.made;
      description.made_messages.add(laid_mesh.messages);
      made.laid.push_back(std::move(laid_mesh));
    }
    instance.mesh = known->second;
  }
}

} // namespace lancer
