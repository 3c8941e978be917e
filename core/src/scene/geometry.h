// Meshes and their instances: in the user's units in a Description, in the normalised world in a Scene.
#pragma once

#include "scene/affine.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lancer {

enum class ShapeKind : uint32_t { Mesh = 0, Sphere = 1, Plane = 2, Cylinder = 3, Cone = 4 };
enum class Shading : uint32_t { AsMesh = 0, Flat = 1, Gouraud = 2, Phong = 3 };
enum class NormalDomain : uint32_t { None = 0, Vertex = 1, Corner = 2 };

// A named attribute, one to four numbers each; name is an index into Description::attribute_names.
enum class Domain : uint32_t { Vertex = 0, Face = 1, Corner = 2 };
struct MeshAttribute {
  uint32_t name = 0;
  Domain domain = Domain::Corner;
  uint32_t channels = 3;
  std::vector<float> values;
};

// The point at which flat shading computes a polygon's colour.
struct PolygonCenter {
  uint32_t triangle = 0;  // the triangle that contains it
  glm::dvec2 place{0.0};  // weights of vertices 1 and 2
  glm::vec3 normal{0.0f}; // object space, unit; 0 if the polygon's areas cancel
};

// A triangle mesh in object space. Only faces of finite, non-zero area are kept.
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
  glm::vec3 low{-1.0f}, high{1.0f}; // bounds of the given positions
  NormalDomain normal_domain = NormalDomain::None;
  std::vector<glm::vec3> smooth_normals; // per vertex; only if an instance with PHONG or GOURAUD uses a mesh without normals
  std::vector<PolygonCenter> centers;    // by polygon; only if an instance with FLAT uses a mesh with polygons

  glm::vec3 vertex(uint32_t triangle, int corner) const { return positions[triangles[triangle][corner]]; }
};

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
  uint32_t hidden_from = 0; // RayKind bits
  bool holdout = false;
  float terminator = 0.0f;   // of smooth meshes: cosine below which shadow rays start on the curved surface
  uint32_t number = 0;       // in the user's order of adding
  glm::dvec3 flat_axis{0.0}; // object space, unit: the direction that a flattening placement loses; else 0

  // Places the shape; the map must be invertible.
  void place(const Affine &map);
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
  uint32_t name = 0;             // index into Description::attribute_names
  std::vector<glm::vec4> values; // by Instance::number; missing entries are 0
};

struct Geometry {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<ObjectInfo> object_infos; // by Instance::number; missing entries have the default
  std::vector<ObjectAttribute> object_attributes;
};

// Selection of the faces of a mesh that can be traced.

// Returns whether a vertex is finite and not beyond 2^60, where squares leave the range of float.
bool is_usable(const glm::vec3 &vertex);
// Returns whether the area is above 0, in double.
bool has_area(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c);

// Keeps the triangles with these numbers, in ascending order, with all their data.
void keep_faces(Mesh &mesh, const std::vector<uint32_t> &kept);

} // namespace lancer
