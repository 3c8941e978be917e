// Everything that a ray can meet, as the user described it: meshes and their placements.
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

// A named attribute, one to four numbers each; name is a number of Description::attribute_names.
enum class Domain : uint32_t { Vertex = 0, Face = 1, Corner = 2 };
struct MeshAttribute {
  uint32_t name = 0;
  Domain domain = Domain::Corner;
  uint32_t channels = 3;
  std::vector<float> values;
};

// Where a polygon's one colour is computed, under flat shading.
struct PolygonCenter {
  uint32_t triangle = 0;  // it lies in this one
  glm::dvec2 place{0.0};  // weights of vertex 1 and 2 there
  glm::vec3 normal{0.0f}; // object space, unit; 0 where its areas add up to none
};

// A triangle mesh in its object's space. Only faces of finite, non-zero area are kept.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<uint32_t> face_of;        // triangle -> face as the user numbered it; empty: the same number
  std::vector<glm::vec3> normals;       // by normal_domain: per vertex, or three per triangle
  std::vector<glm::vec2> uvs;           // empty, or three per triangle
  std::vector<glm::vec3> colors;        // empty, or three per triangle
  std::vector<uint16_t> material_slots; // empty (all 0), or per triangle
  std::vector<uint32_t> polygons;       // empty (each triangle is one), or which polygon each triangle is a part of
  std::vector<MeshAttribute> attributes;
  glm::vec3 low{-1.0f}, high{1.0f}; // bounds of the positions as they were given
  NormalDomain normal_domain = NormalDomain::None;
  std::vector<glm::vec3> smooth_normals; // per vertex; only where PHONG or GOURAUD is asked of a mesh without normals
  std::vector<PolygonCenter> centers;    // by polygon; only where FLAT is asked of a mesh with polygons

  glm::vec3 vertex(uint32_t triangle, int corner) const { return positions[triangles[triangle][corner]]; }
};

// How much a placement can enlarge the largest coordinate of a point, and what it adds: bounds of rounding errors need them.
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
  uint32_t hidden_from = 0; // LANCER_RAY_* bits
  bool holdout = false;
  float terminator = 0.0f; // cosine below which shadow rays start on the curved surface
  uint32_t number = 0;     // in the user's order of adding

  // Puts the shape there; the map has an inverse.
  void place(const Affine &map);
  // The doubles of to_world, to_object and reach in a row, as kernels read them.
  const double *placement() const { return &to_world.linear[0][0]; }
};

// The largest of the coordinates' absolute values.
double largest_coordinate(const glm::dvec3 &v);

// What OBJECT_INFO nodes tell of an object.
struct ObjectInfo {
  glm::vec4 color{1.0f};
  float random = 0.0f;
};

struct Geometry {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<ObjectInfo> object_infos; // by Instance::number; what is missing is as it begins
};

// Which faces of a mesh can be traced, and a mesh of some of its faces only.

// Finite, and not beyond 2^60, where squares leave float's range; no scene is measured so.
bool is_usable(const glm::vec3 &vertex);
// More than 0, in double.
bool has_area(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c);

// Leaves the triangles with these numbers, in rising order, with all that belongs to them.
void keep_faces(Mesh &mesh, const std::vector<uint32_t> &kept);

} // namespace lancer
