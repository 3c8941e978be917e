#include "scene/surface.h"

#include "accel/quadric.h"
#include "sampling/nearest_float.h"
#include "scene/interpolate.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Bound of the distance between the computed point and the surface, seen through the maps there and back again.
// Each coordinate of M p + T is three products and three sums: at most gamma(4) of the sum of absolute values, and the ray that
// leaves is mapped back with the same kind of error, enlarged again by M. 2^-49 is eight times the unit roundoff of double.
double position_bound(const Instance &instance, const glm::dvec3 &p_object, const glm::dvec3 &p_world) {
  const Reach &reach = instance.reach;
  const double there = reach.there * largest_coordinate(p_object) + reach.moved;
  const double back = reach.there * (reach.back * largest_coordinate(p_world) + reach.moved_back);
  return (there + back) * 0x1p-49;
}

glm::vec3 unit(const glm::dvec3 &v) {
  const double length2 = glm::dot(v, v);
  if (length2 > 1e-200 && length2 < 1e200)
    return glm::vec3(v * (1.0 / std::sqrt(length2)));
  // Squares of very small or large normals leave the range of double: scale by the largest component first.
  const double scale = largest_coordinate(v);
  return glm::vec3(glm::normalize(v / scale));
}

// A normal of the object's space in the world: the inverse transpose keeps the outward side, mirrored or not.
glm::vec3 normal_to_world(const Instance &instance, const glm::dvec3 &n) {
  return unit(glm::transpose(instance.to_object.linear) * n);
}

template <class Vector> Vector interpolate_corners(const std::vector<Vector> &corners, uint32_t triangle, const glm::dvec3 &b) {
  const size_t first = size_t(triangle) * 3;
  return float(b.x) * corners[first] + float(b.y) * corners[first + 1] + float(b.z) * corners[first + 2];
}

} // namespace

bool corner_normals(const Mesh &mesh, Shading shading, uint32_t triangle, glm::vec3 (&n)[3]) {
  if (shading == Shading::Flat)
    return false;
  const bool smooth = mesh.normal_domain == NormalDomain::None && shading != Shading::AsMesh;
  const std::vector<glm::vec3> &normals = smooth ? mesh.smooth_normals : mesh.normals;
  if (normals.empty())
    return false;
  const bool corners = mesh.normal_domain == NormalDomain::Corner;
  for (int i = 0; i < 3; ++i)
    n[i] = normals[corners ? size_t(triangle) * 3 + size_t(i) : mesh.triangles[triangle][i]];
  return true;
}

glm::vec3 interpolated_normal(const Mesh &mesh, Shading shading, uint32_t triangle, const glm::dvec2 &bary) {
  glm::vec3 n[3];
  if (!corner_normals(mesh, shading, triangle, n))
    return glm::vec3(0.0f);
  const Vector3<float> weights(float(1.0 - bary.x - bary.y), float(bary.x), float(bary.y));
  return interpolate<float>(n[0], n[1], n[2], weights);
}

namespace {

void mesh_surface(const Geometry &geometry, const Hit &hit, Surface &surface) {
  const Instance &instance = geometry.instances[hit.instance];
  const Mesh &mesh = geometry.meshes[instance.mesh];
  // Take the point from the barycentrics: it lies in the triangle's plane however far the ray came.
  const glm::dvec3 b(1.0 - hit.u - hit.v, hit.u, hit.v);
  const glm::dvec3 v0(mesh.vertex(hit.primitive, 0)), v1(mesh.vertex(hit.primitive, 1)), v2(mesh.vertex(hit.primitive, 2));
  const glm::dvec3 p = b.x * v0 + b.y * v1 + b.z * v2;
  surface.p = instance.to_world.point(p);
  surface.bary = {hit.u, hit.v};
  surface.offset = position_bound(instance, glm::max(glm::abs(v0), glm::max(glm::abs(v1), glm::abs(v2))), surface.p);
  // Take both normals outwards.
  surface.ng = normal_to_world(instance, glm::cross(v1 - v0, v2 - v0));
  surface.ns = surface.ng;
  const glm::vec3 n = interpolated_normal(mesh, instance.shading, hit.primitive, surface.bary);
  if (n != glm::vec3(0.0f))
    surface.ns = normal_to_world(instance, glm::dvec3(n));
}

void quadric_surface(const Geometry &geometry, const Ray &ray, const Hit &hit, Surface &surface) {
  const Instance &instance = geometry.instances[hit.instance];
  const SurfacePoint point =
      quadric_point(instance.kind, instance.to_object.point(ray.o), instance.to_object.vector(ray.d), hit.t);
  surface.p = instance.to_world.point(point.p);
  surface.offset = position_bound(instance, glm::max(glm::abs(point.p), glm::dvec3(1.0)), surface.p);
  surface.ng = surface.ns = normal_to_world(instance, point.n);
}

} // namespace

uint32_t material_of(const Geometry &geometry, const std::vector<uint32_t> &slots, uint32_t instance, uint32_t primitive) {
  const Instance &placed = geometry.instances[instance];
  if (placed.slot_count == 0)
    return kNone;
  uint32_t slot = 0;
  if (placed.kind == ShapeKind::Mesh && !geometry.meshes[placed.mesh].material_slots.empty())
    slot = std::min<uint32_t>(geometry.meshes[placed.mesh].material_slots[primitive], placed.slot_count - 1);
  return slots[placed.first_slot + slot];
}

Surface surface_at(const Geometry &geometry, const std::vector<uint32_t> &slots, const Ray &ray, const Hit &hit) {
  Surface surface;
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.material = material_of(geometry, slots, hit.instance, hit.primitive);
  if (geometry.instances[hit.instance].kind == ShapeKind::Mesh)
    mesh_surface(geometry, hit, surface);
  else
    quadric_surface(geometry, ray, hit, surface);
  return surface;
}

SurfaceAttributes attributes_at(const Geometry &geometry, const Surface &surface) {
  SurfaceAttributes attributes;
  const Instance &instance = geometry.instances[surface.instance];
  if (instance.kind != ShapeKind::Mesh) {
    attributes.uv = nearest_float(quadric_uv(instance.kind, instance.to_object.point(surface.p)));
    return attributes;
  }
  const Mesh &mesh = geometry.meshes[instance.mesh];
  const glm::dvec3 b(1.0 - surface.bary.x - surface.bary.y, surface.bary.x, surface.bary.y);
  attributes.uv = mesh.uvs.empty() ? glm::vec2(float(surface.bary.x), float(surface.bary.y))
                                   : interpolate_corners(mesh.uvs, surface.primitive, b);
  if (!mesh.colors.empty())
    attributes.color = interpolate_corners(mesh.colors, surface.primitive, b);
  return attributes;
}

Ray leave(const Surface &surface, const glm::dvec3 &d, double tmax) {
  Ray ray;
  const double side = glm::dot(glm::dvec3(surface.ng), d) < 0.0 ? -1.0 : 1.0;
  ray.o = surface.p + side * surface.offset * glm::dvec3(surface.ng);
  ray.d = d;
  ray.tmax = tmax;
  ray.skip_instance = surface.instance;
  ray.skip_primitive = surface.primitive;
  return ray;
}

} // namespace lancer
