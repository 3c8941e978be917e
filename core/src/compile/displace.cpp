#include "compile/steps.h"

#include "compile/scene.h"
#include "nodes/run.h"
#include "scene/geometry.h"
#include "scene/surface.h"
#include "simd/parallel.h"

#include <map>

namespace lancer {

namespace {

// An instance whose mesh is displaced, and the number of that mesh in the description.
struct Move {
  uint32_t instance, given_mesh;
};

// A corner at which the displacement of a material is evaluated.
struct Place {
  uint32_t vertex, triangle, material;
  int corner;
};

// Displaces one mesh by the materials of an instance.
class Displacement {
public:
  Displacement(Description &description, const BuildContext &context, const Move &move)
      : description_(description), context_(context), number_(move.instance), given_mesh_(move.given_mesh),
        instance_(description.geometry.instances[number_]), mesh_(description.geometry.meshes[instance_.mesh]) {}

  void run() {
    find_places();
    if (places_.empty())
      return;
    keep_positions();
    move_vertices();
    drop_flat_faces();
    renew_normals(mesh_, renews_);
  }

private:
  // Collects each vertex of each material once, at the first face that has the vertex.
  void find_places() {
    renews_.assign(mesh_.triangles.size(), false);
    std::map<uint32_t, std::vector<bool>> done;
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const uint32_t material = material_of(description_.geometry, description_.slots, number_, i);
      if (material == kNone || !description_.materials[material].displaces())
        continue;
      const bool keeps = description_.materials[material].flags & MaterialFlag::KeepNormals;
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

  // Keeps the undisplaced positions for materials that keep their normals: their bumps read them.
  void keep_positions() {
    if (!keeps_)
      return;
    MeshAttribute attribute;
    attribute.name = kUndisplaced;
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
    surface.ng = carried_normal(instance_.to_object, face_normal(mesh_, place.triangle));
    surface.ns = carried_normal(instance_.to_object, glm::dvec3(normals[place.vertex]));
    // Faces with opposite normals leave a vertex without a normal.
    if (surface.ns == glm::vec3(0.0f))
      surface.ns = surface.ng;
    static const Normalisation unchanged;
    NodeContext context;
    context.geometry = &description_.geometry;
    context.images = &description_.images;
    context.normalisation = &unchanged;
    context.surface = &surface;
    context.wo = surface.ng;
    context.displaces = true;
    lancer::run(material.program, material.displacement_nodes, context, values);
    return glm::dvec3(value_of(material.displacement, values));
  }

  void move_vertices() {
    const std::vector<glm::vec3> normals = vertex_normals(mesh_);
    std::vector<glm::dvec3> offsets(places_.size());
    size_t most = 0;
    for (const Material &material : description_.materials)
      most = std::max(most, material.program.value_count());
    constexpr size_t at_once = 4096;
    parallel_for(context_, (places_.size() + at_once - 1) / at_once, [&](size_t piece) {
      std::vector<glm::vec4> values(most);
      for (size_t i = piece * at_once; i < std::min(places_.size(), (piece + 1) * at_once); ++i)
        offsets[i] = offset(places_[i], normals, values);
    });
    // A vertex of several materials moves by the mean of their displacements.
    std::vector<glm::dvec3> sums(mesh_.positions.size(), glm::dvec3(0.0));
    std::vector<uint32_t> counts(mesh_.positions.size());
    std::map<uint32_t, size_t> refused; // by material
    for (size_t i = 0; i < places_.size(); ++i) {
      const Place &place = places_[i];
      ++counts[place.vertex];
      if (is_usable(glm::vec3(glm::dvec3(mesh_.positions[place.vertex]) + offsets[i])))
        sums[place.vertex] += offsets[i];
      else
        ++refused[place.material];
    }
    tell(refused, "vertices", "were not moved: their displacement is not finite or too large");
    for (size_t i = 0; i < sums.size(); ++i)
      if (counts[i])
        mesh_.positions[i] = glm::vec3(glm::dvec3(mesh_.positions[i]) + sums[i] / double(counts[i]));
  }

  // Drops the faces that displacement has collapsed: no ray can hit them.
  void drop_flat_faces() {
    std::vector<uint32_t> kept;
    std::map<uint32_t, size_t> flat; // by material
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (has_area(mesh_.vertex(i, 0), mesh_.vertex(i, 1), mesh_.vertex(i, 2))) {
        renews_[kept.size()] = renews_[i];
        kept.push_back(i);
      } else {
        ++flat[material_of(description_.geometry, description_.slots, number_, i)];
      }
    }
    if (flat.empty())
      return;
    keep_faces(mesh_, kept);
    tell(flat, "faces", "that displacement leaves without area were left out");
  }

  void tell(const std::map<uint32_t, size_t> &counts, const char *things, const char *what) const {
    const std::string object = label("mesh", mesh_.name.c_str(), given_mesh_);
    for (const auto &[material, count] : counts) {
      const std::string of =
          material == kNone ? "" : "of " + label("material", description_.materials[material].name.c_str(), material) + " ";
      description_.messages.add(object, std::to_string(count) + " " + things + " " + of + what);
    }
  }

  Description &description_;
  const BuildContext &context_;
  uint32_t number_, given_mesh_;
  const Instance &instance_;
  Mesh &mesh_;
  std::vector<bool> renews_; // per triangle: its material displaces, and its normals are recomputed
  bool keeps_ = false;       // some displaced triangle keeps its normals
  std::vector<Place> places_;
};

// Returns one triangle for each material slot that occurs.
std::vector<uint32_t> parts_of(const Mesh &mesh, const BuildContext &context) {
  constexpr uint32_t between_polls = 1u << 16;
  const std::vector<uint16_t> &slots = mesh.material_slots;
  std::map<uint16_t, uint32_t> first;
  for (uint32_t i = 0; i < slots.size(); ++i) {
    if (i % between_polls == 0)
      poll_cancel(context);
    // Neighbours mostly share a slot.
    if (i == 0 || slots[i] != slots[i - 1])
      first.try_emplace(slots[i], i);
  }
  if (slots.empty() && !mesh.triangles.empty())
    first.try_emplace(uint16_t(0), 0u);
  std::vector<uint32_t> parts;
  for (const auto &[slot, triangle] : first)
    parts.push_back(triangle);
  return parts;
}

// Copies a mesh for each further list of displacing materials among its instances; instances without displacement have one list
// in common. Returns the first instance of each list.
std::vector<Move> separate(Description &description, const BuildContext &context) {
  Geometry &geometry = description.geometry;
  std::vector<std::vector<uint32_t>> parts;
  for (const Mesh &mesh : geometry.meshes) {
    poll_cancel(context);
    parts.push_back(parts_of(mesh, context));
  }
  std::map<std::pair<uint32_t, std::vector<uint32_t>>, uint32_t> meshes; // by the mesh of the description and the materials
                                                                         // that displace it
  std::vector<bool> taken(geometry.meshes.size());
  std::vector<Move> firsts;
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    Instance &instance = geometry.instances[i];
    if (instance.kind != ShapeKind::Mesh)
      continue;
    std::vector<uint32_t> movers;
    for (const uint32_t triangle : parts[instance.mesh]) {
      const uint32_t material = material_of(geometry, description.slots, i, triangle);
      movers.push_back(material != kNone && description.materials[material].displaces() ? material : kNone);
    }
    const auto [known, fresh] = meshes.emplace(std::pair(instance.mesh, std::move(movers)), instance.mesh);
    if (fresh) {
      poll_cancel(context);
      firsts.push_back({i, instance.mesh});
      if (taken[instance.mesh]) {
        known->second = uint32_t(geometry.meshes.size());
        geometry.meshes.push_back(Mesh(geometry.meshes[instance.mesh]));
      }
      taken[known->first.first] = true;
    }
    instance.mesh = known->second;
  }
  return firsts;
}

} // namespace

void displace(Description &description, const BuildContext &context) {
  for (const Move &move : separate(description, context)) {
    poll_cancel(context);
    Instance &instance = description.geometry.instances[move.instance];
    instance.place(instance.to_world);
    Displacement(description, context, move).run();
  }
}

} // namespace lancer
