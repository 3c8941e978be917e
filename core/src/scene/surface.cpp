#include "scene/surface.h"

#include "sampling/elementary.h"
#include "scene/hit_surface.h"
#include "scene/quadric_point.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lancer {

namespace {

template <class Vector> Vector interpolate_corners(std::span<const Vector> corners, uint32_t triangle, const glm::dvec3 &b) {
  const size_t first = size_t(triangle) * 3;
  return float(b.x) * corners[first] + float(b.y) * corners[first + 1] + float(b.z) * corners[first + 2];
}

} // namespace

bool corner_normals(const MeshView &mesh, Shading shading, uint32_t triangle, float time, glm::vec3 (&n)[3]) {
  if (shading == Shading::Flat)
    return false;
  const bool smooth = mesh.normal_domain == NormalDomain::None && shading != Shading::AsMesh;
  const std::span<const glm::vec3> normals = smooth ? mesh.smooth_normals : mesh.normals;
  if (normals.empty())
    return false;
  const bool corners = mesh.normal_domain == NormalDomain::Corner;
  const bool moves = !smooth && !mesh.moved_normals.empty();
  for (int i = 0; i < 3; ++i) {
    const size_t number = corners ? size_t(triangle) * 3 + size_t(i) : mesh.triangles[triangle][i];
    n[i] = moves ? mesh.moved(mesh.moved_normals, number, time) : normals[number];
  }
  return true;
}

glm::vec3 interpolated_normal(const MeshView &mesh, Shading shading, uint32_t triangle, const glm::dvec2 &bary) {
  glm::vec3 n[3];
  if (!corner_normals(mesh, shading, triangle, kMiddleTime, n))
    return glm::vec3(0.0f);
  const Vector3<float> weights(float(1.0 - bary.x - bary.y), float(bary.x), float(bary.y));
  return interpolate<float>(n[0], n[1], n[2], weights);
}

namespace {

SurfaceLanes<float> surface_of(const GeometryView &geometry, const Ray &ray, const Hit &hit) {
  Instance moved;
  const Instance &instance = geometry.placed_at(hit.instance, ray.time, moved);
  const double *const placement = instance.placement();
  const Placements<float> placed(&placement);
  if (instance.kind != ShapeKind::Mesh)
    return quadric_surface(placed, kinds_of(instance.kind), Vector3<double>(ray.o), Vector3<double>(ray.d), hit.t);
  const MeshView &mesh = geometry.meshes[instance.mesh];
  Vector3<float> v[3], normals[3];
  glm::vec3 n[3] = {};
  const bool smooth = corner_normals(mesh, instance.shading, hit.primitive, ray.time, n);
  for (int corner = 0; corner < 3; ++corner) {
    v[corner] = mesh.vertex(hit.primitive, corner, ray.time);
    normals[corner] = n[corner];
  }
  return triangle_surface(placed, v, normals, smooth, hit.u, hit.v);
}

} // namespace

uint32_t material_of(const GeometryView &geometry, std::span<const uint32_t> slots, uint32_t instance, uint32_t primitive) {
  const Instance &placed = geometry.instances[instance];
  if (placed.slot_count == 0)
    return kNone;
  uint32_t slot = 0;
  if (placed.kind == ShapeKind::Mesh && !geometry.meshes[placed.mesh].material_slots.empty())
    slot = std::min<uint32_t>(geometry.meshes[placed.mesh].material_slots[primitive], placed.slot_count - 1);
  return slots[placed.first_slot + slot];
}

Surface surface_at(const GeometryView &geometry, std::span<const uint32_t> slots, const Ray &ray, const Hit &hit) {
  Surface surface;
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.material = material_of(geometry, slots, hit.instance, hit.primitive);
  const SurfaceLanes<float> found = surface_of(geometry, ray, hit);
  surface.p = found.p;
  surface.offset = found.offset;
  surface.ng = found.ng;
  surface.ns = found.ns;
  surface.time = ray.time;
  if (geometry.instances[hit.instance].kind == ShapeKind::Mesh)
    surface.bary = {hit.u, hit.v};
  return surface;
}

SurfaceAttributes attributes_at(const GeometryView &geometry, const Surface &surface) {
  SurfaceAttributes attributes;
  Instance moved;
  const Instance &instance = geometry.placed_at(surface.instance, surface.time, moved);
  if (instance.kind != ShapeKind::Mesh) {
    attributes.uv = nearest_float(quadric_uv(instance.kind, instance.to_object.point(surface.p)));
    return attributes;
  }
  const MeshView &mesh = geometry.meshes[instance.mesh];
  const glm::dvec3 b(1.0 - surface.bary.x - surface.bary.y, surface.bary.x, surface.bary.y);
  attributes.uv = mesh.uvs.empty() ? glm::vec2(float(surface.bary.x), float(surface.bary.y))
                                   : interpolate_corners(mesh.uvs, surface.primitive, b);
  if (!mesh.colors.empty())
    attributes.color = interpolate_corners(mesh.colors, surface.primitive, b);
  return attributes;
}

Ray ray_from(const Surface &surface, const glm::dvec3 &d, double tmax) {
  Ray ray;
  ray.o = origin_towards<double>(surface.p, surface.offset, glm::dvec3(surface.ng), d);
  ray.d = d;
  ray.tmax = tmax;
  ray.skip_instance = surface.instance;
  ray.skip_primitive = surface.primitive;
  ray.time = surface.time;
  return ray;
}

SurfacePoint quadric_point(ShapeKind kind, const glm::dvec3 &o, const glm::dvec3 &d, double t) {
  const QuadricPoint<float> point = quadric_point(kinds_of(kind), Vector3<double>(o + t * d));
  return {point.p, point.n};
}

glm::dvec2 quadric_uv(ShapeKind kind, const glm::dvec3 &p) {
  if (kind == ShapeKind::Plane)
    return {p.x, p.y};
  const double turn = atan2(p.y, p.x) * (0.5 * std::numbers::inv_pi);
  const double angle = turn < 0.0 ? std::min(turn + 1.0, std::nextafter(1.0, 0.0)) : turn;
  if (kind == ShapeKind::Sphere)
    return {angle, 0.5 + atan2(p.z, hypot(p.x, p.y)) * std::numbers::inv_pi};
  return {angle, 0.5 * (p.z + 1.0)};
}

namespace {

// Returns the index of a corner's first value.
size_t offset_of(const MeshView &mesh, const MeshAttribute &attribute, uint32_t triangle, int corner) {
  switch (attribute.domain) {
  case Domain::Vertex:
    return size_t(mesh.triangles[triangle][corner]) * attribute.channels;
  case Domain::Face:
    return size_t(triangle) * attribute.channels;
  case Domain::Corner:
    break;
  }
  return (size_t(triangle) * 3 + size_t(corner)) * attribute.channels;
}

glm::vec4 at_corner(const MeshView &mesh, const MeshAttribute &attribute, uint32_t triangle, int corner) {
  const float *values = mesh.attribute_values.data() + attribute.first + offset_of(mesh, attribute, triangle, corner);
  if (attribute.channels == 1)
    return {values[0], values[0], values[0], 1.0f};
  return {values[0], values[1], attribute.channels > 2 ? values[2] : 0.0f, attribute.channels > 3 ? values[3] : 1.0f};
}

} // namespace

const MeshAttribute *find_attribute(const MeshView &mesh, uint32_t name) {
  for (const MeshAttribute &attribute : mesh.attributes)
    if (attribute.name == name)
      return &attribute;
  return nullptr;
}

void corner_values(const MeshView &mesh, const MeshAttribute &attribute, uint32_t triangle, glm::vec4 (&values)[3]) {
  for (int corner = 0; corner < 3; ++corner)
    values[corner] = at_corner(mesh, attribute, triangle, corner);
}

glm::vec4 attribute_at(const MeshView &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary) {
  const MeshAttribute *attribute = find_attribute(mesh, name);
  if (!attribute)
    return {0.0f, 0.0f, 0.0f, 1.0f};
  glm::vec4 at[3];
  corner_values(mesh, *attribute, triangle, at);
  const glm::dvec4 a(at[0]), b(at[1]), c(at[2]);
  return attribute->domain == Domain::Face ? at[0] : glm::vec4((1.0 - bary.x - bary.y) * a + bary.x * b + bary.y * c);
}

glm::vec2 uv_at(const MeshView &mesh, uint32_t name, uint32_t triangle, const glm::dvec2 &bary) {
  glm::vec2 corner[3];
  if (!corner_uvs(mesh, name, triangle, corner))
    return glm::vec2(0.0f);
  const glm::dvec2 a(corner[0]), b(corner[1]), c(corner[2]);
  return {interpolate_uv(a.x, b.x, c.x, bary.x, bary.y), interpolate_uv(a.y, b.y, c.y, bary.x, bary.y)};
}

bool corner_uvs(const MeshView &mesh, const MeshAttribute *attribute, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]) {
  if (!attribute && (name != 0 || mesh.uvs.empty()))
    return false;
  for (int corner = 0; corner < 3; ++corner)
    uvs[corner] =
        attribute ? glm::vec2(at_corner(mesh, *attribute, triangle, corner)) : mesh.uvs[size_t(triangle) * 3 + size_t(corner)];
  return true;
}

bool corner_uvs(const MeshView &mesh, uint32_t name, uint32_t triangle, glm::vec2 (&uvs)[3]) {
  return corner_uvs(mesh, find_attribute(mesh, name), name, triangle, uvs);
}

} // namespace lancer
