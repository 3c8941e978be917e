#include "compile/steps.h"

#include "sampling/elementary.h"
#include "scene/affine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <tuple>

namespace lancer {

namespace {

std::vector<glm::vec3> units(const std::vector<glm::dvec3> &sums) {
  std::vector<glm::vec3> normals(sums.size());
  for (size_t i = 0; i < sums.size(); ++i)
    normals[i] = glm::vec3(unit_or_zero(sums[i]));
  return normals;
}

// Returns the mean of the faces' normals at each vertex, weighted by the faces' angles there.
std::vector<glm::vec3> normals_by_angle(const MeshView &mesh) {
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

// Sets the normals of vertices to the mean of the faces' normals.
void renew_at_vertices(Mesh &mesh, const std::vector<bool> &triangles) {
  const MeshView view = mesh;
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangles[i])
      for (int corner = 0; corner < 3; ++corner)
        sums[mesh.triangles[i][corner]] += face_normal(view, i);
  for (size_t i = 0; i < sums.size(); ++i)
    if (sums[i] != glm::dvec3(0.0))
      mesh.normals[i] = glm::vec3(unit_or_zero(sums[i]));
}

// Corners of a vertex that shared a normal share one again; creases stay.
void renew_at_corners(Mesh &mesh, const std::vector<bool> &triangles) {
  using Key = std::tuple<uint32_t, float, float, float>;
  const MeshView view = mesh;
  std::map<Key, glm::dvec3> sums;
  const auto key = [&](uint32_t triangle, int corner) {
    const glm::vec3 &n = mesh.normals[size_t(triangle) * 3 + size_t(corner)];
    return Key{mesh.triangles[triangle][corner], n.x, n.y, n.z};
  };
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangles[i])
      for (int corner = 0; corner < 3; ++corner)
        sums[key(i, corner)] += face_normal(view, i);
  std::vector<glm::vec3> normals(mesh.normals.begin(), mesh.normals.end());
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangles[i])
      for (int corner = 0; corner < 3; ++corner)
        normals[size_t(i) * 3 + size_t(corner)] = glm::vec3(unit_or_zero(sums[key(i, corner)]));
  mesh.normals = std::move(normals);
}

} // namespace

glm::dvec3 twice_area(const MeshView &mesh, uint32_t triangle) {
  const glm::dvec3 v0(mesh.vertex(triangle, 0)), v1(mesh.vertex(triangle, 1)), v2(mesh.vertex(triangle, 2));
  return glm::cross(v1 - v0, v2 - v0);
}

glm::dvec3 face_normal(const MeshView &mesh, uint32_t triangle) { return unit_or_zero(twice_area(mesh, triangle)); }

std::vector<glm::vec3> normals_by_area(const MeshView &mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 n = twice_area(mesh, i);
    for (int corner = 0; corner < 3; ++corner)
      sums[mesh.triangles[i][corner]] += n;
  }
  return units(sums);
}

std::vector<glm::vec3> vertex_normals(const MeshView &mesh) {
  if (mesh.normal_domain != NormalDomain::Vertex)
    return normals_by_angle(mesh);
  const glm::vec3 none(0.0f);
  std::vector<glm::vec3> normals(mesh.normals.begin(), mesh.normals.end());
  if (std::find(normals.begin(), normals.end(), none) == normals.end())
    return normals;
  // Replace a normal of 0 by the geometric normal.
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

namespace {

// Returns the weights of vertices 1 and 2 at the place of a triangle nearest to the origin (Ericson, Real-Time Collision
// Detection, 5.1.5): a corner, a place on an edge, or the foot of the perpendicular within. Returns NaN where the triangle has
// no extent.
glm::dvec2 nearest_place(const glm::dvec3 (&v)[3]) {
  const glm::dvec3 ab = v[1] - v[0], ac = v[2] - v[0];
  const double d1 = -glm::dot(ab, v[0]), d2 = -glm::dot(ac, v[0]);
  if (d1 <= 0.0 && d2 <= 0.0)
    return {0.0, 0.0};
  const double d3 = -glm::dot(ab, v[1]), d4 = -glm::dot(ac, v[1]);
  if (d3 >= 0.0 && d4 <= d3)
    return {1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
    return {d1 / (d1 - d3), 0.0};
  const double d5 = -glm::dot(ab, v[2]), d6 = -glm::dot(ac, v[2]);
  if (d6 >= 0.0 && d5 <= d6)
    return {0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
    return {0.0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1.0 - along, along};
  }
  return glm::dvec2(vb, vc) / (va + vb + vc);
}

// Returns the mean of the vertices of some triangles, each vertex counted once.
glm::dvec3 mean_vertex(const MeshView &mesh, std::span<const uint32_t> triangles) {
  std::vector<uint32_t> vertices;
  for (const uint32_t triangle : triangles)
    for (int corner = 0; corner < 3; ++corner)
      vertices.push_back(mesh.triangles[triangle][corner]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  glm::dvec3 sum(0.0);
  for (const uint32_t vertex : vertices)
    sum += glm::dvec3(mesh.positions[vertex]);
  return sum / double(vertices.size());
}

PolygonCenter center_of(const MeshView &mesh, std::span<const uint32_t> triangles) {
  PolygonCenter center;
  const glm::dvec3 mean = mean_vertex(mesh, triangles);
  glm::dvec3 area(0.0);
  for (const uint32_t triangle : triangles)
    area += twice_area(mesh, triangle);
  const glm::dvec3 normal = unit_or_zero(area);
  // Project along the normal, so that a warped polygon's centre lies straight above or below the mean. Where the area vectors
  // do not sum to 0, some triangle keeps an area in the projection.
  const auto seen = [&](uint32_t triangle, int corner) {
    const glm::dvec3 way = glm::dvec3(mesh.vertex(triangle, corner)) - mean;
    return way - glm::dot(way, normal) * normal;
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (const uint32_t triangle : triangles) {
    const glm::dvec3 v[3] = {seen(triangle, 0), seen(triangle, 1), seen(triangle, 2)};
    const glm::dvec2 place = nearest_place(v);
    const glm::dvec3 away = v[0] + place.x * (v[1] - v[0]) + place.y * (v[2] - v[0]);
    const double distance2 = glm::dot(away, away);
    if (distance2 < nearest) {
      nearest = distance2;
      center.triangle = triangle;
      center.place = place;
    }
  }
  center.normal = glm::vec3(normal);
  return center;
}

} // namespace

std::vector<PolygonCenter> polygon_centers(const MeshView &mesh) {
  if (mesh.polygons.empty())
    return {};
  std::vector<uint32_t> order(mesh.polygons.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return mesh.polygons[a] < mesh.polygons[b]; });
  std::vector<PolygonCenter> centers(size_t(mesh.polygons[order.back()]) + 1);
  for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const uint32_t polygon = mesh.polygons[order[begin]];
    for (end = begin; end < order.size() && mesh.polygons[order[end]] == polygon; ++end)
      continue;
    centers[polygon] = center_of(mesh, std::span(order).subspan(begin, end - begin));
  }
  return centers;
}

Hit center_hit(const MeshView &mesh, const Hit &hit) {
  Hit center = hit;
  center.u = center.v = 1.0 / 3.0;
  if (!mesh.centers.empty()) {
    const PolygonCenter &polygon = mesh.centers[mesh.polygons[hit.primitive]];
    center.primitive = polygon.triangle;
    center.u = polygon.place.x;
    center.v = polygon.place.y;
  }
  return center;
}

} // namespace lancer
