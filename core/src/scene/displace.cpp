#include "scene/displace.h"

#include "accel/parallel.h"
#include "scene/scene.h"

#include <cmath>
#include <map>
#include <tuple>

namespace lancer {

namespace {

bool finite(const glm::dvec3 &v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

glm::dvec3 unit_or_zero(const glm::dvec3 &v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

glm::dvec3 face_normal(const Mesh &mesh, uint32_t triangle) {
  const glm::dvec3 v0(mesh.vertex(triangle, 0)), v1(mesh.vertex(triangle, 1)), v2(mesh.vertex(triangle, 2));
  return unit_or_zero(glm::cross(v1 - v0, v2 - v0));
}

// Normals at vertices of a closed skin, whatever the shading: the faces' by their angles, so that nothing tears apart.
std::vector<glm::vec3> vertex_normals(const Mesh &mesh) {
  if (mesh.normal_domain == NormalDomain::Vertex)
    return mesh.normals;
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 n = face_normal(mesh, i);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(mesh.vertex(i, corner));
      const glm::dvec3 a = unit_or_zero(glm::dvec3(mesh.vertex(i, (corner + 1) % 3)) - p);
      const glm::dvec3 b = unit_or_zero(glm::dvec3(mesh.vertex(i, (corner + 2) % 3)) - p);
      sums[mesh.triangles[i][corner]] += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * n;
    }
  }
  std::vector<glm::vec3> normals(sums.size());
  for (size_t i = 0; i < sums.size(); ++i)
    normals[i] = glm::vec3(unit_or_zero(sums[i]));
  return normals;
}

// A corner at which a material is asked for its displacement.
struct Place {
  uint32_t vertex, triangle, material;
  int corner;
};

// One mesh, moved as its first instance's materials say.
class Displacement {
public:
  Displacement(Description &description, const BuildContext &context, uint32_t instance)
      : description_(description), context_(context), number_(instance), instance_(description.geometry.instances[instance]),
        mesh_(description.geometry.meshes[instance_.mesh]) {}

  void run() {
    find_places();
    if (places_.empty())
      return;
    keep_positions();
    move_vertices();
    if (mesh_.normal_domain == NormalDomain::Vertex)
      renew_vertex_normals();
    else if (mesh_.normal_domain == NormalDomain::Corner)
      renew_corner_normals();
  }

private:
  // Ask each material once for each of its vertices, at the first face that has it.
  void find_places() {
    renews_.assign(mesh_.triangles.size(), false);
    std::map<uint32_t, std::vector<bool>> done;
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const uint32_t material = material_of(description_.geometry, description_.slots, number_, i);
      if (material == kNone || !description_.materials[material].displaces())
        continue;
      const bool keeps = description_.materials[material].flags & LANCER_MATERIAL_KEEP_NORMALS;
      renews_[i] = !keeps;
      keeps_ |= keeps;
      std::vector<bool> &seen = done[material];
      seen.resize(mesh_.positions.size());
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = mesh_.triangles[i][corner];
        if (!seen[vertex])
          places_.push_back({vertex, i, material, corner});
        seen[vertex] = true;
      }
    }
  }

  // For bumps that look at the surface as it was.
  void keep_positions() {
    if (!keeps_)
      return;
    MeshAttribute attribute;
    attribute.name = attribute_name(description_, kUndisplaced);
    attribute.domain = Domain::Vertex;
    attribute.channels = 3;
    for (const glm::vec3 &p : mesh_.positions)
      attribute.values.insert(attribute.values.end(), {p.x, p.y, p.z});
    mesh_.attributes.push_back(std::move(attribute));
  }

  glm::dvec3 offset(const Place &place, const std::vector<glm::vec3> &normals, std::span<glm::vec4> values) const {
    const Material &material = description_.materials[place.material];
    Surface surface;
    surface.instance = number_;
    surface.primitive = place.triangle;
    surface.material = place.material;
    surface.p = instance_.to_world.point(glm::dvec3(mesh_.positions[place.vertex]));
    surface.bary = {place.corner == 1 ? 1.0 : 0.0, place.corner == 2 ? 1.0 : 0.0};
    const auto to_world = [&](const glm::dvec3 &n) {
      return glm::vec3(unit_or_zero(glm::transpose(instance_.to_object.linear) * n));
    };
    surface.ng = to_world(face_normal(mesh_, place.triangle));
    surface.ns = to_world(glm::dvec3(normals[place.vertex]));
    static const Normalisation unchanged;
    NodeContext context;
    context.geometry = &description_.geometry;
    context.images = &description_.images;
    context.normalisation = &unchanged;
    context.surface = &surface;
    context.wo = surface.ng;
    lancer::run(material.program, material.displacement_nodes, context, values);
    const glm::dvec3 moved(value_of(material.displacement, values));
    return finite(moved) ? moved : glm::dvec3(0.0);
  }

  void move_vertices() {
    const std::vector<glm::vec3> normals = vertex_normals(mesh_);
    std::vector<glm::dvec3> offsets(places_.size());
    size_t most = 0;
    for (const Material &material : description_.materials)
      most = std::max(most, material.program.nodes.size());
    constexpr size_t at_once = 4096;
    parallel_for(context_, (places_.size() + at_once - 1) / at_once, [&](size_t piece) {
      std::vector<glm::vec4> values(most);
      for (size_t i = piece * at_once; i < std::min(places_.size(), (piece + 1) * at_once); ++i)
        offsets[i] = offset(places_[i], normals, values);
    });
    // A vertex of several materials goes to the mean.
    std::vector<glm::dvec3> sums(mesh_.positions.size(), glm::dvec3(0.0));
    std::vector<uint32_t> counts(mesh_.positions.size());
    for (size_t i = 0; i < places_.size(); ++i) {
      sums[places_[i].vertex] += offsets[i];
      ++counts[places_[i].vertex];
    }
    for (size_t i = 0; i < sums.size(); ++i)
      if (counts[i])
        mesh_.positions[i] = glm::vec3(glm::dvec3(mesh_.positions[i]) + sums[i] / double(counts[i]));
  }

  // The mean of the faces' normals, those that follow.
  void renew_vertex_normals() {
    std::vector<glm::dvec3> sums(mesh_.positions.size(), glm::dvec3(0.0));
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      if (renews_[i])
        for (int corner = 0; corner < 3; ++corner)
          sums[mesh_.triangles[i][corner]] += face_normal(mesh_, i);
    for (size_t i = 0; i < sums.size(); ++i)
      if (sums[i] != glm::dvec3(0.0))
        mesh_.normals[i] = glm::vec3(unit_or_zero(sums[i]));
  }

  // Corners that had one normal at a vertex get one again; where the skin was creased it stays so.
  void renew_corner_normals() {
    using Key = std::tuple<uint32_t, float, float, float>;
    std::map<Key, glm::dvec3> sums;
    const auto key = [&](uint32_t triangle, int corner) {
      const glm::vec3 &n = mesh_.normals[size_t(triangle) * 3 + size_t(corner)];
      return Key{mesh_.triangles[triangle][corner], n.x, n.y, n.z};
    };
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      if (renews_[i])
        for (int corner = 0; corner < 3; ++corner)
          sums[key(i, corner)] += face_normal(mesh_, i);
    std::vector<glm::vec3> normals = mesh_.normals;
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      if (renews_[i])
        for (int corner = 0; corner < 3; ++corner)
          normals[size_t(i) * 3 + size_t(corner)] = glm::vec3(unit_or_zero(sums[key(i, corner)]));
    mesh_.normals = std::move(normals);
  }

  Description &description_;
  const BuildContext &context_;
  uint32_t number_;
  const Instance &instance_;
  Mesh &mesh_;
  std::vector<bool> renews_; // per triangle: it moves, and its normals follow
  bool keeps_ = false;       // some triangle's normals do not
  std::vector<Place> places_;
};

} // namespace

void displace(Description &description, const BuildContext &context) {
  std::vector<bool> done(description.geometry.meshes.size());
  std::vector<Instance> &instances = description.geometry.instances;
  for (uint32_t i = 0; i < instances.size(); ++i) {
    Instance &instance = instances[i];
    if (instance.kind != ShapeKind::Mesh || done[instance.mesh])
      continue;
    done[instance.mesh] = true;
    instance.to_object = inverse(instance.to_world);
    Displacement(description, context, i).run();
  }
}

} // namespace lancer
