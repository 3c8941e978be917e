#include "accel/coplanar/flat_face.h"

#include "accel/hit_tests.h"
#include "accel/mesh_bounds.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Half a unit in the last place of each corner is 2^-24; modelling tools need two or three operations in float to compute it.
constexpr double kCornerRounding = 0x1p-22;
// A placement is a product of a few matrices, whose rounding this bound covers. A larger bound would treat instances one unit
// apart as coplanar.
constexpr double kPlaceRounding = 0x1p-23;
// A distance between faces above this share of the instance's size is intended, however far the instance is from the origin.
constexpr double kMeant = 0x1p-10;

glm::dmat3 magnitudes(const glm::dmat3 &m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

std::optional<FlatFace> quadric_face(const Instance &instance, const glm::dvec3 &o, const glm::dvec3 &d, double t) {
  if (instance.kind == ShapeKind::Sphere)
    return {};
  const SurfacePoint at = quadric_point(instance.kind, instance.to_object.point(o), instance.to_object.vector(d), t);
  // Only the disks of cylinders and cones, and planes, have a normal along the axis.
  if (at.n.x != 0.0 || at.n.y != 0.0)
    return {};
  const glm::dvec3 n = glm::transpose(instance.to_object.linear) * at.n;
  return FlatFace{instance.to_world.point(at.p), n / glm::length(n), kInfinity};
}

} // namespace

FlatFace triangle_face(const glm::dvec3 corner[3]) {
  const glm::dvec3 a = corner[1] - corner[0], b = corner[2] - corner[0], c = b - a;
  const glm::dvec3 n = glm::cross(a, b);
  const double length = glm::length(n);
  const double longest = std::sqrt(std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)}));
  return {corner[0], n / length, length / longest};
}

void world_corners(const GeometryView &geometry, uint32_t instance, uint32_t triangle, glm::dvec3 corner[3]) {
  const Instance &placed = geometry.instances[instance];
  for (int i = 0; i < 3; ++i)
    corner[i] = placed.to_world.point(glm::dvec3(geometry.meshes[placed.mesh].vertex(triangle, i)));
}

FaceCoordinates coordinates_on_face(const GeometryView &geometry, uint32_t instance, uint32_t primitive) {
  const Instance &placed = geometry.instances[instance];
  if (placed.kind != ShapeKind::Mesh) {
    const glm::dmat3 rows = glm::transpose(placed.to_object.linear);
    return {placed.to_world.translation, rows[0], rows[1]};
  }
  glm::dvec3 corner[3];
  world_corners(geometry, instance, primitive, corner);
  const glm::dvec3 a = corner[1] - corner[0], b = corner[2] - corner[0], n = glm::cross(a, b);
  const double area = glm::dot(n, n);
  return {corner[0], glm::cross(b, n) / area, glm::cross(n, a) / area};
}

std::optional<FlatFace> face_met(const GeometryView &geometry, const Ray &ray, const Hit &hit) {
  const Instance &instance = geometry.instances[hit.instance];
  if (instance.kind != ShapeKind::Mesh)
    return quadric_face(instance, ray.o, ray.d, hit.t);
  glm::dvec3 corner[3];
  world_corners(geometry, hit.instance, hit.primitive, corner);
  FlatFace face = triangle_face(corner);
  face.p = (1.0 - hit.u - hit.v) * corner[0] + hit.u * corner[1] + hit.v * corner[2];
  return face;
}

std::optional<FlatFace> face_left(const GeometryView &geometry, const Ray &ray) {
  const Instance &instance = geometry.instances[ray.skip_instance];
  if (instance.kind != ShapeKind::Mesh)
    return quadric_face(instance, ray.o, glm::dvec3(0.0), 0.0);
  glm::dvec3 corner[3];
  world_corners(geometry, ray.skip_instance, ray.skip_primitive, corner);
  FlatFace face = triangle_face(corner);
  face.p = ray.o - glm::dot(ray.o - face.p, face.n) * face.n;
  return face;
}

FaceRounding::FaceRounding(const GeometryView &g, const glm::dvec3 &o, MeshOwners owners) : geometry(g), origin(o) {
  for (size_t i = 0; i < geometry.meshes.size(); ++i) {
    const Extent vertices = bounds_of(geometry.meshes[i], owner_of(owners, i))->vertices;
    low.push_back(vertices.empty() ? glm::dvec3(0.0) : vertices.lo);
    high.push_back(vertices.empty() ? glm::dvec3(0.0) : vertices.hi);
  }
}

// Bounds the displacement of a surface along each axis of the world by the rounding of its own coordinates.
glm::dvec3 FaceRounding::within(uint32_t number, const glm::dvec3 &p) const {
  const Instance &instance = geometry.instances[number];
  const glm::dvec3 reach = instance.kind == ShapeKind::Mesh
                               ? glm::max(glm::abs(low[instance.mesh]), glm::abs(high[instance.mesh]))
                           : instance.kind == ShapeKind::Plane ? glm::abs(instance.to_object.point(p))
                                                               : glm::dvec3(1.0);
  return kCornerRounding * (magnitudes(instance.to_world.linear) * reach);
}

// Bounds the displacement by the rounding of the instance's position.
glm::dvec3 FaceRounding::moved(uint32_t instance) const {
  return kPlaceRounding * glm::abs(geometry.instances[instance].to_world.translation - origin);
}

double FaceRounding::most(uint32_t instance, double sum) const { return std::min(sum, 2.0 * kMeant * extent(instance)); }

double FaceRounding::extent(uint32_t number) const {
  if (geometry.instances[number].kind == ShapeKind::Plane)
    return kInfinity;
  glm::dvec3 lo, hi;
  box(number, lo, hi);
  return std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
}

double FaceRounding::extent_of_mesh(uint32_t mesh) const {
  const glm::dvec3 size = high[mesh] - low[mesh];
  return std::max({size.x, size.y, size.z});
}

void FaceRounding::box(uint32_t number, glm::dvec3 &lo, glm::dvec3 &hi) const {
  const Instance &instance = geometry.instances[number];
  if (instance.kind == ShapeKind::Plane) {
    lo = glm::dvec3(-kInfinity);
    hi = glm::dvec3(kInfinity);
    return;
  }
  const bool mesh = instance.kind == ShapeKind::Mesh;
  const glm::dvec3 l = mesh ? low[instance.mesh] : glm::dvec3(-1.0), h = mesh ? high[instance.mesh] : glm::dvec3(1.0);
  const glm::dvec3 middle = instance.to_world.point(0.5 * (l + h));
  const glm::dvec3 half = magnitudes(instance.to_world.linear) * (0.5 * (h - l)) + within(number, middle) + moved(number);
  lo = middle - half;
  hi = middle + half;
}

double FaceRounding::apart(uint32_t one, uint32_t other, const glm::dvec3 &n, const glm::dvec3 &p) const {
  glm::dvec3 sum = within(one, p) + within(other, p);
  if (one != other)
    sum += moved(one) + moved(other);
  return std::min(glm::dot(glm::abs(n), sum), kMeant * std::min(extent(one), extent(other)));
}

double FaceRounding::share(uint32_t instance, const glm::dvec3 &p) const {
  return glm::length(within(instance, p) + moved(instance));
}

bool parallel(const FlatFace &one, const FlatFace &other, double apart) {
  // Float matrices rotate by up to some 2^-22.
  const double turned = 0x1p-20 + apart / one.height + apart / other.height;
  const glm::dvec3 sine = glm::cross(one.n, other.n);
  return glm::dot(sine, sine) <= turned * turned;
}

namespace {

// Returns whether two triangles in one plane overlap by more than a border of this width.
bool overlap(const FaceCandidate &one, const FaceCandidate &other, double border) {
  const glm::dvec3 &n = one.face.n;
  for (const FaceCandidate *c : {&one, &other})
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 edge = c->corner[i == 2 ? 0 : i + 1] - c->corner[i];
      const glm::dvec3 across = glm::cross(n, edge);
      double low[2], high[2];
      const FaceCandidate *both[2] = {&one, &other};
      for (int k = 0; k < 2; ++k) {
        const double a = glm::dot(across, both[k]->corner[0] - c->corner[i]),
                     b = glm::dot(across, both[k]->corner[1] - c->corner[i]),
                     d = glm::dot(across, both[k]->corner[2] - c->corner[i]);
        low[k] = std::min({a, b, d});
        high[k] = std::max({a, b, d});
      }
      if (std::min(high[0], high[1]) - std::max(low[0], low[1]) <= border * glm::length(across))
        return false;
    }
  return true;
}

} // namespace

bool in_one_plane(const FaceRounding &rounding, const FaceCandidate &one, const FaceCandidate &other) {
  const FaceCandidate &large = one.face.height >= other.face.height ? one : other, &small = &large == &one ? other : one;
  const glm::dvec3 middle = (small.corner[0] + small.corner[1] + small.corner[2]) / 3.0;
  // Reject most pairs by the cheap upper bound.
  const double most = large.rounding + small.rounding;
  if (!parallel(large.face, small.face, most))
    return false;
  const double apart = rounding.apart(large.instance, small.instance, large.face.n, middle);
  if (!parallel(large.face, small.face, apart))
    return false;
  // Allow more outside the larger face, where its plane is less precise.
  const glm::dvec3 centre = (large.corner[0] + large.corner[1] + large.corner[2]) / 3.0;
  for (const glm::dvec3 &corner : small.corner)
    if (!(std::abs(glm::dot(corner - large.face.p, large.face.n)) <=
          apart * (1.0 + glm::length(corner - centre) / large.face.height)))
      return false;
  return overlap(one, other, 8.0 * apart);
}

} // namespace lancer
