#include "scene/mesh_normals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sampling/elementary.h"

namespace lancer {

namespace {

std::vector<glm::vec3> units(const std::vector<glm::dvec3> &sums) {
  std::vector<glm::vec3> normals(sums.size());
  for (size_t i = 0; i < sums.size(); ++i)
    normals[i] = glm::vec3(unit_or_zero(sums[i]));
  return normals;
}

// The faces' normals by their angles.
std::vector<glm::vec3> normals_by_angle(const Mesh &mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 n = face_normal(mesh, i);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(mesh.vertex(i, corner));
      const glm::dvec3 a = unit_or_zero(glm::dvec3(mesh.vertex(i, (corner + 1) % 3)) - p);
      const glm::dvec3 b = unit_or_zero(glm::dvec3(mesh.vertex(i, (corner + 2) % 3)) - p);
      sums[mesh.triangles[i][corner]] += atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * n;
    }
  }
  return units(sums);
}

// The mean of the faces' normals.
void renew_at_vertices(Mesh &mesh, const std::vector<bool> &triangles) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangles[i])
      for (int corner = 0; corner < 3; ++corner)
        sums[mesh.triangles[i][corner]] += face_normal(mesh, i);
  for (size_t i = 0; i < sums.size(); ++i)
    if (sums[i] != glm::dvec3(0.0))
      mesh.normals[i] = glm::vec3(unit_or_zero(sums[i]));
}

// Corners that had one normal at a vertex get one again; where the skin was creased it stays so.
void renew_at_corners(Mesh &mesh, const std::vector<bool> &triangles) {
  using Key = std::tuple<uint32_t, float, float, float>;
  std::map<Key, glm::dvec3> sums;
  const auto key = [&](uint32_t triangle, int corner) {
    const glm::vec3 &n = mesh.normals[size_t(triangle) * 3 + size_t(corner)];
    return Key{mesh.triangles[triangle][corner], n.x, n.y, n.z};
  };
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangles[i])
      for (int corner = 0; corner < 3; ++corner)
        sums[key(i, corner)] += face_normal(mesh, i);
  std::vector<glm::vec3> normals = mesh.normals;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangles[i])
      for (int corner = 0; corner < 3; ++corner)
        normals[size_t(i) * 3 + size_t(corner)] = glm::vec3(unit_or_zero(sums[key(i, corner)]));
  mesh.normals = std::move(normals);
}

} // namespace

glm::dvec3 twice_area(const Mesh &mesh, uint32_t triangle) {
  const glm::dvec3 v0(mesh.vertex(triangle, 0)), v1(mesh.vertex(triangle, 1)), v2(mesh.vertex(triangle, 2));
  return glm::cross(v1 - v0, v2 - v0);
}

glm::dvec3 face_normal(const Mesh &mesh, uint32_t triangle) { return unit_or_zero(twice_area(mesh, triangle)); }

std::vector<glm::vec3> normals_by_area(const Mesh &mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 n = twice_area(mesh, i);
    for (int corner = 0; corner < 3; ++corner)
      sums[mesh.triangles[i][corner]] += n;
  }
  return units(sums);
}

std::vector<glm::vec3> vertex_normals(const Mesh &mesh) {
  if (mesh.normal_domain != NormalDomain::Vertex)
    return normals_by_angle(mesh);
  const glm::vec3 none(0.0f);
  std::vector<glm::vec3> normals = mesh.normals;
  if (std::find(normals.begin(), normals.end(), none) == normals.end())
    return normals;
  // A normal of 0 stands for the geometric one.
  const std::vector<glm::vec3> geometric = normals_by_angle(mesh);
  for (size_t i = 0; i < normals.size(); ++i)
    if (normals[i] == none)
      normals[i] = geometric[i];
  return normals;
}

void renew_normals(Mesh &mesh, const std::vector<bool> &triangles) {
  if (mesh.normal_domain == NormalDomain::Vertex)
    renew_at_vertices(mesh, triangles);
  else if (mesh.normal_domain == NormalDomain::Corner)
    renew_at_corners(mesh, triangles);
}

} // namespace lancer
