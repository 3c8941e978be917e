#include "lights/emission.h"

#include "lights/seen_face.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"
#include "scene/geometry.h"
#include "scene/moving_bounds.h"
#include "scene/quadric_point.h"

#include <cmath>

namespace lancer {

namespace {

SeenFace<float> see_face(const GeometryView &geometry, const Instance &instance, uint32_t face, float time,
                         const glm::dvec3 &p) {
  const MeshView &mesh = geometry.meshes[instance.mesh];
  const Vector3<float> corner[3] = {mesh.vertex(face, 0, time), mesh.vertex(face, 1, time), mesh.vertex(face, 2, time)};
  return {MapLanes<float>(instance.to_world), corner, Vector3<double>(p)};
}

// Returns the unit area of a part of an exact surface: 0 the curved side, 1 and 2 the disks at z = -1 and z = 1.
double part_area(ShapeKind kind, int part) {
  constexpr double pi = glm::pi<double>();
  if (kind == ShapeKind::Sphere)
    return part == 0 ? 4.0 * pi : 0.0;
  if (kind == ShapeKind::Cylinder)
    return part == 0 ? 4.0 * pi : pi;
  if (kind == ShapeKind::Cone)
    return part == 0 ? std::sqrt(5.0) * pi : (part == 1 ? pi : 0.0);
  return 0.0;
}

struct UnitPoint {
  glm::dvec3 p{0.0}, n{0, 0, 1};
};

// Returns a uniform point of one unit part.
UnitPoint unit_point(ShapeKind kind, int part, const glm::vec2 &u) {
  if (part > 0) {
    const glm::dvec2 d(warp_disk(u));
    const double z = part == 1 ? -1.0 : 1.0;
    return {{d.x, d.y, z}, {0.0, 0.0, z}};
  }
  if (kind == ShapeKind::Sphere) {
    const glm::dvec3 p = glm::normalize(glm::dvec3(warp_sphere(u)));
    return {p, p};
  }
  const SinCos turn = sin_cos_turn(double(u.y));
  if (kind == ShapeKind::Cylinder)
    return {{turn.cos, turn.sin, 2.0 * double(u.x) - 1.0}, {turn.cos, turn.sin, 0.0}};
  // The cone's radius grows linearly from the apex, so its square is uniform.
  const double r = std::sqrt(double(u.x));
  return {{r * turn.cos, r * turn.sin, 1.0 - 2.0 * r}, glm::normalize(glm::dvec3(2.0 * turn.cos, 2.0 * turn.sin, 1.0))};
}

// Returns the factor by which a map enlarges an area with unit object normal n.
double area_scale(const Instance &instance, const glm::dvec3 &n) {
  return std::abs(glm::determinant(instance.to_world.linear)) * glm::length(glm::transpose(instance.to_object.linear) * n);
}

// Returns a point of an exact surface, hit at t = 1 by a ray along the normal, as the surface stage expects.
Surface part_point(const GeometryView &geometry, std::span<const uint32_t> slots, uint32_t instance, int part,
                   const glm::vec2 &u, float time) {
  Instance moved;
  const Instance &placed = geometry.placed_at(instance, time, moved);
  const UnitPoint point = unit_point(placed.kind, part, u);
  Ray ray;
  ray.time = time;
  ray.o = placed.to_world.point(point.p + point.n);
  ray.d = placed.to_world.vector(-point.n);
  Hit hit;
  hit.instance = instance;
  hit.primitive = 0;
  hit.t = 1.0;
  return surface_at(geometry, slots, ray, hit);
}

// Extends bounds to all places of an object that moves, whose faces may then turn anywhere.
void grow_along_motion(const GeometryView &geometry, uint32_t instance, LightBounds &bounds) {
  if (!geometry.moves(geometry.instances[instance]))
    return;
  const Extent swept = swept_extent(geometry, geometry.instances[instance]);
  bounds.grow(swept.lo);
  bounds.grow(swept.hi);
  bounds.cone.theta_o = glm::pi<double>();
}

} // namespace

Emitter::Emitter(const GeometryView &geometry, uint32_t instance, std::shared_ptr<const EmissiveFaces> faces)
    : instance_(instance), hidden_from_(geometry.instances[instance].hidden_from), links_(geometry.instances[instance].links),
      bounds_(faces->bounds(geometry.instances[instance])), faces_(std::move(faces)) {
  grow_along_motion(geometry, instance, bounds_);
}

Emitter::Emitter(const GeometryView &geometry, std::span<const uint32_t> slots, std::span<const MaterialView> materials,
                 uint32_t instance, EmissionAt &emission)
    : instance_(instance), hidden_from_(geometry.instances[instance].hidden_from), links_(geometry.instances[instance].links) {
  const Instance &placed = geometry.instances[instance_];
  const uint32_t number = material_of(geometry, slots, instance_, 0);
  if (placed.kind == ShapeKind::Plane || number == kNone || !is_light(materials[number]))
    return;
  double level = emission_level(materials[number].emission.value);
  if (emission_varies(materials[number])) {
    // Average over 8 x 8 points of the curved side. The result is the level alone; the parts are weighted by area below.
    level = 0.0;
    for (int i = 0; i < 64; ++i) {
      const glm::vec2 u((float(i % 8) + 0.5f) / 8.0f, (float(i / 8) + 0.5f) / 8.0f);
      level += emission.level(part_point(geometry, slots, instance_, 0, u, kMiddleTime)) / 64.0;
    }
  }
  // Parts are weighted by their unit areas; the density accounts for the scale of the map.
  std::vector<double> weights;
  for (int part = 0; part < 3; ++part)
    weights.push_back(part_area(placed.kind, part));
  parts_ = WeightedChoice(weights);
  // The box of the shape bounds the light, and the cone covers all directions.
  for (int corner = 0; corner < 8; ++corner)
    bounds_.grow(placed.to_world.point({corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0}));
  grow_along_motion(geometry, instance_, bounds_);
  bounds_.cone = {{0.0, 0.0, 1.0}, glm::pi<double>(), glm::half_pi<double>()};
  bounds_.energy = level * part_area(placed.kind, 0) * mean_area_scale(placed.to_world.linear);
}

double Emitter::pdf(const GeometryView &geometry, const glm::dvec3 &p, const Surface &surface) const {
  const double pdf = face_pdf(geometry, p, surface);
  return faces_ ? double(faces_->by_power().pmf(surface.primitive)) * pdf : pdf;
}

LightSample Emitter::sample_shape(const GeometryView &geometry, std::span<const uint32_t> slots, const glm::dvec3 &p,
                                  float time, const glm::vec2 &u, Surface &surface) const {
  const auto part = parts_.sample(u.x);
  surface = part_point(geometry, slots, instance_, int(part.index), {part.u, u.y}, time);
  LightSample sample;
  const glm::dvec3 v = surface.p - p;
  sample.distance = glm::length(v);
  if (!(sample.distance > 0.0))
    return sample;
  sample.wi = v / sample.distance;
  // End on the side that p sees, off the surface by the surface's own error bound.
  const double side = glm::dot(glm::dvec3(surface.ng), sample.wi) < 0.0 ? 1.0 : -1.0;
  sample.target = surface.p + (side * surface.offset) * glm::dvec3(surface.ng);
  sample.pdf = face_pdf(geometry, p, surface);
  return sample;
}

double Emitter::face_pdf(const GeometryView &geometry, const glm::dvec3 &p, const Surface &surface) const {
  const glm::dvec3 v = surface.p - p;
  if (empty())
    return 0.0;
  Instance moved;
  const Instance &placed = geometry.placed_at(instance_, surface.time, moved);
  if (faces_)
    return see_face(geometry, placed, surface.primitive, surface.time, p).pdf(Vector3<double>(v), Vector3<float>(surface.ng));
  const double d2 = glm::dot(v, v), cosine = std::abs(glm::dot(glm::dvec3(surface.ng), v)) / std::sqrt(d2);
  if (!(cosine > 0.0) || !(d2 > 0.0))
    return 0.0;
  double area = 0.0;
  for (int part = 0; part < 3; ++part)
    area += part_area(placed.kind, part);
  area *= area_scale(placed, glm::normalize(glm::transpose(placed.to_world.linear) * glm::dvec3(surface.ng)));
  return d2 / (cosine * area);
}

} // namespace lancer
