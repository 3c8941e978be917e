// Meshes and their instances: in the user's units in a Description, in the normalised world in a Scene. Kernels read views,
// which hold no memory of their own.
#pragma once

#include "scene/affine.h"
#include "scene/light_links.h"
#include "scene/motion.h"
#include "scene/once.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace lancer {

enum class ShapeKind : uint32_t { Mesh = 0, Sphere = 1, Plane = 2, Cylinder = 3, Cone = 4 };
enum class Shading : uint32_t { AsMesh = 0, Flat = 1, Gouraud = 2, Phong = 3 };
enum class NormalDomain : uint32_t { None = 0, Vertex = 1, Corner = 2 };

// A named attribute, one to four numbers each; name: of scene/names.h; first: of its numbers in Mesh::attribute_values.
enum class Domain : uint32_t { Vertex = 0, Face = 1, Corner = 2 };
struct MeshAttribute {
  uint32_t name = 0;
  Domain domain = Domain::Corner;
  uint32_t channels = 3;
  size_t first = 0;
};

// The point at which flat shading computes a polygon's colour.
struct PolygonCenter {
  uint32_t triangle = 0;  // the triangle that contains it
  glm::dvec2 place{0.0};  // weights of vertices 1 and 2
  glm::vec3 normal{0.0f}; // object space, unit; 0 if the polygon's areas cancel
};

// A triangle mesh in object space.
struct MeshView {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;
  std::span<const uint32_t> face_of;
  std::span<const glm::vec3> normals;
  std::span<const glm::vec2> uvs;
  std::span<const glm::vec3> colors;
  std::span<const uint16_t> material_slots;
  std::span<const uint32_t> polygons;
  std::span<const MeshAttribute> attributes;
  std::span<const float> attribute_values;
  glm::vec3 low{-1.0f}, high{1.0f};
  NormalDomain normal_domain = NormalDomain::None;
  std::span<const glm::vec3>
      smooth_normals;                     // per vertex; only if an instance with PHONG or GOURAUD uses a mesh without normals
  std::span<const PolygonCenter> centers; // by polygon; only if an instance with FLAT uses a mesh with polygons
  std::span<const glm::vec3> moved_positions, moved_normals; // key after key; as positions and normals
  std::span<const glm::vec3> vector_positions;               // as positions, at the moments of scene/vectors.h; or empty
  uint32_t key_count = 0;                                    // 0: the mesh keeps its shape

  glm::vec3 vertex(uint32_t triangle, int corner) const { return positions[triangles[triangle][corner]]; }
  // Returns a corner at a time.
  glm::vec3 vertex(uint32_t triangle, int corner, float time) const {
    return key_count == 0 ? vertex(triangle, corner) : moved(moved_positions, triangles[triangle][corner], time);
  }
  // Returns a corner at a key.
  glm::vec3 key_vertex(uint32_t triangle, int corner, uint32_t key) const {
    return moved_positions[size_t(key) * positions.size() + triangles[triangle][corner]];
  }
  // Returns an entry of moved_positions or moved_normals at a time.
  glm::vec3 moved(std::span<const glm::vec3> of_keys, size_t number, float time) const {
    const KeyPlace at = key_at(key_count, time);
    const size_t count = of_keys.size() / key_count, first = at.key * count + number;
    return between_keys(of_keys[first], of_keys[first + count], at.share);
  }
};

struct MeshBounds; // accel/mesh_bounds.h
struct MeshCells;  // accel/mesh_bounds.h
struct MeshBvh;    // accel/bvh/bvh_build.h
struct KdTree;     // accel/kdtree/kdtree.h

// The memory of a mesh. Only faces of finite, non-zero area are kept.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<uint32_t> face_of;        // triangle -> the user's face number; empty: the same number
  std::vector<glm::vec3> normals;       // by normal_domain: per vertex, or three per triangle
  std::vector<glm::vec2> uvs;           // empty, or three per triangle
  std::vector<glm::vec3> colors;        // empty, or three per triangle
  std::vector<uint16_t> material_slots; // empty (all 0), or per triangle
  std::vector<uint32_t> polygons;       // empty (each triangle is a polygon), or the polygon of each triangle
  std::vector<MeshAttribute> attributes;
  std::vector<float> attribute_values;                   // of all attributes
  std::vector<glm::vec3> moved_positions, moved_normals; // key after key: as positions, and as normals or empty
  std::vector<glm::vec3> vector_positions;               // see MeshView
  uint32_t key_count = 0;                                // 0: the mesh keeps its shape
  glm::vec3 low{-1.0f}, high{1.0f};                      // bounds of the given positions
  NormalDomain normal_domain = NormalDomain::None;

  // Made when a scene first needs them.
  Once<MeshBounds> bounds;
  Once<MeshCells> cells;
  Once<MeshBvh> tree;
  Once<KdTree> kd_tree;
  Once<std::vector<glm::vec3>> smooth_normals;
  Once<std::vector<PolygonCenter>> centers;

  glm::vec3 vertex(uint32_t triangle, int corner) const { return positions[triangles[triangle][corner]]; }
  // Adds an attribute whose numbers begin at the end of attribute_values; returns it.
  MeshAttribute &add_attribute(uint32_t name, Domain domain, uint32_t channels);
  // Returns how many numbers an attribute has.
  size_t count_of(const MeshAttribute &attribute) const;
  // Valid until the mesh changes.
  operator MeshView() const;
  size_t bytes() const;
};
// By the number of a mesh in a geometry: its memory, where data of the mesh are kept. Empty: nothing is kept.
using MeshOwners = std::span<const Mesh *const>;
inline const Mesh *owner_of(MeshOwners owners, size_t mesh) { return owners.empty() ? nullptr : owners[mesh]; }
// Returns make(), or what the owner keeps of an earlier call. slot: of the owner, which may be null.
template <class T, class Make> std::shared_ptr<const T> made_once(const Mesh *owner, Once<T> Mesh::*slot, const Make &make) {
  return owner ? (owner->*slot).get(make) : std::make_shared<const T>(make());
}

// Input of bounds of rounding errors: the factors by which a placement can enlarge the largest coordinate of a point, and its
// largest translation.
struct Reach {
  double there = 1.0, moved = 0.0;     // object to world
  double back = 1.0, moved_back = 0.0; // world to object
};

// One placed shape, in the normalised world: (world - centre) * 2^k.
struct Instance {
  Affine to_world;
  Affine to_object; // set by place()
  Reach reach;      // set by place()
  ShapeKind kind = ShapeKind::Mesh;
  Shading shading = Shading::AsMesh;
  uint32_t mesh = 0;
  uint32_t first_slot = 0, slot_count = 0;
  uint32_t object_index = 0;
  uint32_t object_matte = 0, asset_matte = 0; // ids; 0 = none
  uint32_t light_group = 0;                   // of its own light; 0 = none
  uint32_t hidden_from = 0;                   // RayKind bits; in a scene with shadow catchers also the second ones
  bool holdout = false;
  bool catcher = false;
  float terminator = 0.0f;   // of smooth meshes: cosine below which shadow rays start on the curved surface
  uint32_t number = 0;       // in the user's order of adding
  glm::dvec3 flat_axis{0.0}; // object space, unit: the direction that a flattening placement loses; else 0
  uint32_t receiver_set = 0, blocker_set = 0;
  LightLinks links;                      // of the light that it emits
  double fast_distance = 0.0;            // see lancer_instance; user's units
  uint32_t first_key = 0, key_count = 0; // of the geometry's keys; 0: the instance stands still

  // Places the shape; the map must be invertible.
  void place(const Affine &map);
  // Whether all members have the same bits.
  bool same(const Instance &other) const;
  // Returns the doubles of to_world, to_object and reach in a row, as kernels read them.
  const double *placement() const { return &to_world.linear[0][0]; }
};

// Returns the largest absolute coordinate.
double largest_coordinate(const glm::dvec3 &v);

// Data of OBJECT_INFO nodes.
struct ObjectInfo {
  glm::vec4 color{1.0f};
  float random = 0.0f;
};

// A named value of each instance, which OBJECT_INFO nodes read.
struct ObjectAttribute {
  uint32_t name = 0;             // of scene/names.h
  std::vector<glm::vec4> values; // by Instance::number; missing entries are 0
};
struct ObjectAttributeView {
  uint32_t name = 0;
  std::span<const glm::vec4> values;
};
std::vector<ObjectAttributeView> views_of(std::span<const ObjectAttribute> attributes);

struct GeometryView {
  std::span<const MeshView> meshes;
  std::span<const Instance> instances;
  std::span<const ObjectInfo> object_infos; // by Instance::number; missing entries have the default
  std::span<const ObjectAttributeView> object_attributes;
  std::span<const PlacementKey> keys = {}; // of all instances that move

  std::span<const PlacementKey> keys_of(const Instance &instance) const {
    return keys.subspan(instance.first_key, instance.key_count);
  }
  // Whether a shape has another place or form at another time.
  bool moves(const Instance &instance) const {
    return instance.key_count > 0 || (instance.kind == ShapeKind::Mesh && meshes[instance.mesh].key_count > 0);
  }
  // Returns an instance as it is placed at a time: itself where it stands still, otherwise `moved`, which is filled.
  const Instance &placed_at(uint32_t number, float time, Instance &moved) const {
    const Instance &instance = instances[number];
    if (instance.key_count == 0)
      return instance;
    moved = instance;
    moved.place(placement_at(keys_of(instance), time));
    return moved;
  }
};

// Selection of the faces of a mesh that can be traced.

// Returns whether a vertex is finite and not beyond 2^60, where squares leave the range of float.
bool is_usable(const glm::vec3 &vertex);
// Returns whether the area is above 0, in double.
bool has_area(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c);

// Keeps the triangles with these numbers, in ascending order, with all their data.
void keep_faces(Mesh &mesh, const std::vector<uint32_t> &kept);

} // namespace lancer
