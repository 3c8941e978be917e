#include "compile/steps.h"

#include "compile/scene.h"
#include "nodes/run.h"
#include "scene/geometry.h"
#include "scene/surface.h"
#include "simd/parallel.h"

#include <algorithm>
#include <cstring>
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
  // views: of all meshes of the description; the displaced one is updated. attributes: of its objects.
  Displacement(const Description &description, std::span<MeshView> views, std::span<const ObjectAttributeView> attributes,
               const BuildContext &context, const Move &move)
      : description_(description), context_(context), number_(move.instance), given_mesh_(move.given_mesh),
        views_(views), geometry_{views, description.instances, description.object_infos, attributes, description.keys},
        instance_(geometry_.placed_at(number_, kMiddleTime, moved_)) {}

  // Returns the displaced mesh; the given one if no face is displaced.
  std::shared_ptr<const Mesh> run() {
    find_places();
    if (places_.empty())
      return description_.meshes[instance_.mesh].object;
    mesh_ = *description_.meshes[instance_.mesh];
    keep_positions();
    move_vertices();
    drop_flat_faces();
    renew_all_normals();
    return std::make_shared<const Mesh>(std::move(mesh_));
  }
  const Messages &messages() const { return messages_; }

private:
  // Collects each vertex of each material once, at the first face that has the vertex.
  void find_places() {
    const MeshView &mesh = views_[instance_.mesh];
    renews_.assign(mesh.triangles.size(), false);
    std::map<uint32_t, std::vector<bool>> done;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const uint32_t material = material_of(geometry_, description_.slots, number_, i);
      if (material == kNone || !description_.materials[material]->displaces())
        continue;
      const bool keeps = description_.materials[material]->flags & MaterialFlag::KeepNormals;
      renews_[i] = !keeps;
      keeps_ |= keeps;
      std::vector<bool> &seen = done[material];
      seen.resize(mesh.positions.size());
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = mesh.triangles[i][corner];
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
    mesh_.add_attribute(kUndisplaced, Domain::Vertex, 3);
    for (const glm::vec3 &p : mesh_.positions)
      mesh_.attribute_values.insert(mesh_.attribute_values.end(), {p.x, p.y, p.z});
  }

  glm::dvec3 offset(const Place &place, const std::vector<glm::vec3> &normals, std::span<glm::vec4> values) const {
    const Material &material = *description_.materials[place.material];
    Surface surface;
    surface.instance = number_;
    surface.primitive = place.triangle;
    surface.material = place.material;
    surface.p = instance_.to_world.point(glm::dvec3(mesh_.positions[place.vertex]));
    surface.bary = {place.corner == 1 ? 1.0 : 0.0, place.corner == 2 ? 1.0 : 0.0};
    surface.ng = carried_normal(instance_.to_object, face_normal(views_[instance_.mesh], place.triangle));
    surface.ns = carried_normal(instance_.to_object, glm::dvec3(normals[place.vertex]));
    // Faces with opposite normals leave a vertex without a normal.
    if (surface.ns == glm::vec3(0.0f))
      surface.ns = surface.ng;
    static const Normalisation unchanged;
    NodeContext context;
    context.geometry = &geometry_;
    context.normalisation = &unchanged;
    context.surface = &surface;
    context.wo = surface.ng;
    context.displaces = true;
    lancer::run(material.program, material.displacement_nodes, context, values);
    return glm::dvec3(value_of(material.displacement, values));
  }

  void move_vertices() {
    views_[instance_.mesh] = mesh_;
    const std::vector<glm::vec3> normals = vertex_normals(mesh_);
    std::vector<glm::dvec3> offsets(places_.size());
    size_t most = 0;
    for (const Given<Material> &material : description_.materials)
      most = std::max(most, material->program.value_count());
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
    // As in Cycles, the mesh is displaced at all keys and moments as it is in the picture.
    for (std::vector<glm::vec3> *positions : {&mesh_.moved_positions, &mesh_.vector_positions})
      for (size_t i = 0; i < positions->size(); ++i)
        if (const size_t vertex = i % sums.size(); counts[vertex])
          (*positions)[i] = glm::vec3(glm::dvec3((*positions)[i]) + sums[vertex] / double(counts[vertex]));
  }

  // Recomputes the normals of the displaced faces, at all keys.
  void renew_all_normals() {
    renew_normals(mesh_, renews_);
    if (mesh_.moved_normals.empty())
      return;
    Mesh at_key;
    at_key.triangles = mesh_.triangles;
    at_key.normal_domain = mesh_.normal_domain;
    const size_t vertices = mesh_.positions.size(), normals = mesh_.moved_normals.size() / mesh_.key_count;
    std::vector<glm::vec3> all;
    for (uint32_t key = 0; key < mesh_.key_count; ++key) {
      const auto position = mesh_.moved_positions.begin() + ptrdiff_t(key * vertices);
      const auto normal = mesh_.moved_normals.begin() + ptrdiff_t(key * normals);
      at_key.positions.assign(position, position + ptrdiff_t(vertices));
      at_key.normals.assign(normal, normal + ptrdiff_t(normals));
      renew_normals(at_key, renews_);
      all.insert(all.end(), at_key.normals.begin(), at_key.normals.end());
    }
    mesh_.moved_normals = std::move(all);
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
        ++flat[material_of(geometry_, description_.slots, number_, i)];
      }
    }
    if (flat.empty())
      return;
    keep_faces(mesh_, kept);
    tell(flat, "faces", "that displacement leaves without area were left out");
  }

  void tell(const std::map<uint32_t, size_t> &counts, const char *things, const char *what) {
    const std::string object = label("mesh", mesh_.name.c_str(), given_mesh_);
    for (const auto &[material, count] : counts) {
      const std::string of =
          material == kNone ? "" : "of " + label("material", description_.materials[material]->name.c_str(), material) + " ";
      messages_.add(object, std::to_string(count) + " " + things + " " + of + what);
    }
  }

  const Description &description_;
  const BuildContext &context_;
  uint32_t number_, given_mesh_;
  std::span<MeshView> views_;
  const GeometryView geometry_;
  Instance moved_;           // memory of instance_
  const Instance &instance_; // in the middle of its motion
  Mesh mesh_;                // the displaced copy
  std::vector<bool> renews_; // per triangle: its material displaces, and its normals are recomputed
  bool keeps_ = false;       // some displaced triangle keeps its normals
  std::vector<Place> places_;
  Messages messages_;
};

// Returns one triangle for each material slot that occurs.
std::vector<uint32_t> parts_of(const MeshView &mesh, const BuildContext &context) {
  constexpr uint32_t between_polls = 1u << 16;
  const std::span<const uint16_t> slots = mesh.material_slots;
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
// in common. Returns the first instance of each list that displaces.
std::vector<Move> separate(Description &description, const BuildContext &context) {
  std::vector<MeshView> views;
  std::vector<std::vector<uint32_t>> parts;
  for (const Given<Mesh> &mesh : description.meshes) {
    poll_cancel(context);
    parts.push_back(parts_of(views.emplace_back(*mesh), context));
  }
  const GeometryView geometry{views, description.instances, {}, {}};
  std::map<std::pair<uint32_t, std::vector<uint32_t>>, uint32_t> meshes; // by the mesh of the description and the materials
                                                                         // that displace it
  std::vector<bool> taken(views.size());
  std::vector<Move> firsts;
  for (uint32_t i = 0; i < description.instances.size(); ++i) {
    Instance &instance = description.instances[i];
    if (instance.kind != ShapeKind::Mesh)
      continue;
    std::vector<uint32_t> movers;
    for (const uint32_t triangle : parts[instance.mesh]) {
      const uint32_t material = material_of(geometry, description.slots, i, triangle);
      movers.push_back(material != kNone && description.materials[material]->displaces() ? material : kNone);
    }
    const bool moves = std::ranges::any_of(movers, [](uint32_t mover) { return mover != kNone; });
    const auto [known, fresh] = meshes.emplace(std::pair(instance.mesh, std::move(movers)), instance.mesh);
    if (fresh) {
      poll_cancel(context);
      if (moves)
        firsts.push_back({i, instance.mesh});
      if (taken[instance.mesh]) {
        known->second = uint32_t(description.meshes.size());
        description.meshes.push_back(description.meshes[instance.mesh]);
      }
      taken[known->first.first] = true;
    }
    instance.mesh = known->second;
  }
  return firsts;
}

} // namespace

bool DisplacedMesh::same_source(const DisplacedMesh &other) const {
  const auto bits = [](const auto &a, const auto &b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  return from == other.from && number == other.number && slots == other.slots && materials == other.materials &&
         bits(instance.to_world, other.instance.to_world) && instance.object_index == other.instance.object_index &&
         bits(info, other.info) && std::ranges::equal(attributes, other.attributes, bits);
}

namespace {

// Returns the source of a displaced mesh.
DisplacedMesh source_of(const Description &description, const Move &move) {
  DisplacedMesh source;
  source.instance = description.instances[move.instance];
  source.from = description.meshes[source.instance.mesh].object;
  source.number = move.given_mesh;
  for (uint32_t i = 0; i < source.instance.slot_count; ++i) {
    source.slots.push_back(description.slots[source.instance.first_slot + i]);
    source.materials.push_back(description.materials[source.slots.back()].object);
  }
  const uint32_t number = source.instance.number;
  if (number < description.object_infos.size())
    source.info = description.object_infos[number];
  for (const ObjectAttribute &attribute : description.object_attributes)
    source.attributes.emplace_back(attribute.name,
                                   number < attribute.values.size() ? attribute.values[number] : glm::vec4(0.0f));
  return source;
}

} // namespace

void displace(Description &description, const BuildContext &context, MadeMeshes &made, const MadeMeshes *before) {
  const std::vector<Move> moves = separate(description, context);
  std::vector<MeshView> views;
  for (const Given<Mesh> &mesh : description.meshes)
    views.push_back(*mesh);
  const std::vector<ObjectAttributeView> attributes = views_of(description.object_attributes);
  for (const Move &move : moves) {
    poll_cancel(context);
    DisplacedMesh source = source_of(description, move);
    if (const DisplacedMesh *known = find_made(before ? &before->displaced : nullptr, source)) {
      source.made = known->made;
      source.messages = known->messages;
    } else {
      Instance &instance = description.instances[move.instance];
      instance.place(instance.to_world);
      count_made(context, &MadeCounts::changed_meshes);
      Displacement displacement(description, views, attributes, context, move);
      source.made = displacement.run();
      source.messages = displacement.messages();
    }
    description.meshes[source.instance.mesh].object = source.made;
    description.made_messages.add(source.messages);
    made.displaced.push_back(std::move(source));
  }
}

} // namespace lancer
