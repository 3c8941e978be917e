#include "lights/emitter.h"

#include "accel/quadric.h"
#include "sampling/warp.h"

#include <cmath>

namespace lancer {

namespace {

double brightness(const Material &material) {
  const glm::vec3 &e = material.emission.value;
  return std::max({e.x, e.y, e.z});
}

double face_area(const Geometry &geometry, const Instance &instance, uint32_t face) {
  const Mesh &mesh = geometry.meshes[instance.mesh];
  const glm::dvec3 v0(mesh.vertex(face, 0)), v1(mesh.vertex(face, 1)), v2(mesh.vertex(face, 2));
  return 0.5 * glm::length(glm::cross(instance.to_world.vector(v1 - v0), instance.to_world.vector(v2 - v0)));
}

// Exact surfaces by their unit parts: 0 the curved side, 1 and 2 the disks at z = -1 and z = 1.
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

// A uniform point of one unit part.
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
  const double phi = glm::two_pi<double>() * double(u.y), c = std::cos(phi), s = std::sin(phi);
  if (kind == ShapeKind::Cylinder)
    return {{c, s, 2.0 * double(u.x) - 1.0}, {c, s, 0.0}};
  // The cone's radius grows linearly from the apex, so its square is uniform.
  const double r = std::sqrt(double(u.x));
  return {{r * c, r * s, 1.0 - 2.0 * r}, glm::normalize(glm::dvec3(2.0 * c, 2.0 * s, 1.0))};
}

// How much a map enlarges an area with unit object normal n.
double area_scale(const Instance &instance, const glm::dvec3 &n) {
  return std::abs(glm::determinant(instance.to_world.linear)) * glm::length(glm::transpose(instance.to_object.linear) * n);
}

} // namespace

Emitter::Emitter(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                 uint32_t instance)
    : instance_(instance) {
  const Instance &placed = geometry.instances[instance];
  std::vector<double> weights;
  const auto emission = [&](uint32_t face) {
    const uint32_t material = material_of(geometry, slots, instance, face);
    return material == kNone ? 0.0 : brightness(materials[material]);
  };
  if (placed.kind == ShapeKind::Mesh) {
    const size_t faces = geometry.meshes[placed.mesh].triangles.size();
    weights.resize(faces);
    for (uint32_t face = 0; face < faces; ++face) {
      const double e = emission(face);
      weights[face] = e > 0.0 ? e * face_area(geometry, placed, face) : 0.0;
      weight_ += weights[face];
    }
  } else if (placed.kind != ShapeKind::Plane) {
    // Parts are weighted by their unit areas; the density accounts for what the map does to them.
    for (int part = 0; part < 3; ++part)
      weights.push_back(part_area(placed.kind, part));
    weight_ = emission(0) * part_area(placed.kind, 0) * std::pow(std::abs(glm::determinant(placed.to_world.linear)), 2.0 / 3.0);
  }
  if (weight_ > 0.0)
    faces_ = Distribution(weights);
}

LightSample Emitter::sample(const Geometry &geometry, const std::vector<uint32_t> &slots,
                            const std::vector<Material> &materials, const glm::dvec3 &p, const glm::vec2 &u) const {
  const Instance &placed = geometry.instances[instance_];
  // Choose a face; what is left of the number places the point on it.
  const auto choice = faces_.sample(u.x);
  const glm::vec2 rest(choice.u, u.y);
  Hit hit;
  hit.instance = instance_;
  hit.primitive = 0;
  Ray ray;
  if (placed.kind == ShapeKind::Mesh) {
    const glm::dvec2 b(warp_triangle(rest));
    hit.primitive = choice.index;
    hit.u = b.x;
    hit.v = b.y;
  } else {
    // Look straight at the chosen point so that the surface stage finds it at t = 1.
    const UnitPoint point = unit_point(placed.kind, int(choice.index), rest);
    ray.o = placed.to_world.point(point.p + point.n);
    ray.d = placed.to_world.vector(-point.n);
    hit.t = 1.0;
  }
  const Surface surface = surface_at(geometry, slots, ray, hit);

  LightSample sample;
  const glm::dvec3 v = surface.p - p;
  sample.distance = glm::length(v);
  if (!(sample.distance > 0.0))
    return sample;
  sample.wi = v / sample.distance;
  // End on the side that p sees, off the surface by its own bound.
  const double side = glm::dot(glm::dvec3(surface.ng), sample.wi) < 0.0 ? 1.0 : -1.0;
  sample.target = surface.p + (side * surface.offset) * glm::dvec3(surface.ng);
  sample.pdf = pdf(geometry, materials, p, surface);
  if (surface.material != kNone) {
    // What is not there does not shine either.
    const Material &material = materials[surface.material];
    sample.radiance = evaluate(material.emission, surface) * evaluate(material.opacity, surface);
  }
  return sample;
}

double Emitter::pdf(const Geometry &geometry, const std::vector<Material> &materials, const glm::dvec3 &p,
                    const Surface &surface) const {
  const Instance &placed = geometry.instances[instance_];
  const glm::dvec3 v = surface.p - p;
  const double d2 = glm::dot(v, v), cosine = std::abs(glm::dot(glm::dvec3(surface.ng), v)) / std::sqrt(d2);
  if (!(cosine > 0.0) || !(d2 > 0.0) || surface.material == kNone)
    return 0.0;
  double per_area;
  if (placed.kind == ShapeKind::Mesh) {
    // A face is chosen by emission times area and covered evenly: its area cancels.
    per_area = brightness(materials[surface.material]) / weight_;
  } else {
    double unit_area = 0.0;
    for (int part = 0; part < 3; ++part)
      unit_area += part_area(placed.kind, part);
    const glm::dvec3 n = glm::normalize(glm::transpose(placed.to_world.linear) * glm::dvec3(surface.ng));
    per_area = 1.0 / (unit_area * area_scale(placed, n));
  }
  return per_area * d2 / cosine;
}

} // namespace lancer
