#include "lights/emitter.h"

#include "accel/quadric.h"
#include "sampling/color.h"
#include "sampling/warp.h"

#include <cmath>

namespace lancer {

namespace {

bool sampled(const Material &material) { return material.emits() && !(material.flags & LANCER_MATERIAL_NOT_A_LIGHT); }

bool varies(const Material &material) { return material.emission.varies() || material.layered_emission; }

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

// A point of a mesh's face by the weights of its corners 1 and 2.
Surface face_point(const Geometry &geometry, const std::vector<uint32_t> &slots, uint32_t instance, uint32_t face,
                   const glm::dvec2 &weights) {
  Hit hit;
  hit.instance = instance;
  hit.primitive = face;
  hit.u = weights.x;
  hit.v = weights.y;
  return surface_at(geometry, slots, Ray{}, hit);
}

// A point of an exact surface: looked straight at, so that the surface stage finds it at t = 1.
Surface part_point(const Geometry &geometry, const std::vector<uint32_t> &slots, uint32_t instance, int part,
                   const glm::vec2 &u) {
  const Instance &placed = geometry.instances[instance];
  const UnitPoint point = unit_point(placed.kind, part, u);
  Ray ray;
  ray.o = placed.to_world.point(point.p + point.n);
  ray.d = placed.to_world.vector(-point.n);
  Hit hit;
  hit.instance = instance;
  hit.primitive = 0;
  hit.t = 1.0;
  return surface_at(geometry, slots, ray, hit);
}

// Seen straight on, from the brighter side.
double brightness_at(const EmissionAt &emission, const Surface &surface) {
  const double both = std::max(brightest(emission(surface, surface.ng)), brightest(emission(surface, -surface.ng)));
  return std::isfinite(both) ? both : 0.0;
}

// Where a face is looked at: middle, and halfway from there to each corner.
constexpr double kLooks[4][2] = {{1.0 / 3, 1.0 / 3}, {1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}};
// What a face counts for at least, as a share of the mean over all: a texture may shine between the looks.
constexpr double kLeastShare = 0.05;

} // namespace

Emitter::Emitter(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                 uint32_t instance, const EmissionAt &emission)
    : instance_(instance), hidden_from_(geometry.instances[instance].hidden_from) {
  const ShapeKind kind = geometry.instances[instance].kind;
  if (kind == ShapeKind::Mesh)
    add_faces(geometry, slots, materials, emission);
  else if (kind != ShapeKind::Plane)
    add_parts(geometry, slots, materials, emission);
}

void Emitter::add_faces(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                        const EmissionAt &emission) {
  const Instance &placed = geometry.instances[instance_];
  const uint32_t faces = uint32_t(geometry.meshes[placed.mesh].triangles.size());
  std::vector<double> weights(faces);
  std::vector<bool> textured(faces);
  double looked_at = 0.0, seen = 0.0;
  for (uint32_t face = 0; face < faces; ++face) {
    const uint32_t number = material_of(geometry, slots, instance_, face);
    if (number == kNone || !sampled(materials[number]))
      continue;
    const Material &material = materials[number];
    const double area = face_area(geometry, placed, face);
    double level = brightest(material.emission.value);
    if (varies(material)) {
      // Look at a few points; at one where nothing but the direction matters.
      const bool by_nodes = !material.emission_nodes.empty();
      level = 0.0;
      const int looks = by_nodes ? 4 : 1;
      for (int i = 0; i < looks; ++i)
        level += brightness_at(emission, face_point(geometry, slots, instance_, face, {kLooks[i][0], kLooks[i][1]})) / looks;
      brightness_.resize(faces);
      brightness_[face] = float(level);
      textured[face] = by_nodes;
      looked_at += by_nodes ? area : 0.0;
      seen += by_nodes ? level * area : 0.0;
    }
    weights[face] = level * area;
  }
  // Give the dark faces of a texture their least share.
  const double least = looked_at > 0.0 ? kLeastShare * seen / looked_at : 0.0;
  for (uint32_t face = 0; face < faces; ++face) {
    if (textured[face] && double(brightness_[face]) < least) {
      brightness_[face] = float(least);
      weights[face] = double(brightness_[face]) * face_area(geometry, placed, face);
    }
    weight_ += weights[face];
  }
  if (weight_ > 0.0)
    faces_ = WeightedChoice(weights);
}

void Emitter::add_parts(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                        const EmissionAt &emission) {
  const Instance &placed = geometry.instances[instance_];
  const uint32_t number = material_of(geometry, slots, instance_, 0);
  if (number == kNone || !sampled(materials[number]))
    return;
  double level = brightest(materials[number].emission.value);
  if (varies(materials[number])) {
    // Look at 8 x 8 points of the curved side; the parts are covered evenly whatever is seen.
    level = 0.0;
    for (int i = 0; i < 64; ++i) {
      const glm::vec2 u((float(i % 8) + 0.5f) / 8.0f, (float(i / 8) + 0.5f) / 8.0f);
      level += brightness_at(emission, part_point(geometry, slots, instance_, 0, u)) / 64.0;
    }
  }
  // Parts are weighted by their unit areas; the density accounts for what the map does to them.
  std::vector<double> weights;
  for (int part = 0; part < 3; ++part)
    weights.push_back(part_area(placed.kind, part));
  weight_ = level * part_area(placed.kind, 0) * std::pow(std::abs(glm::determinant(placed.to_world.linear)), 2.0 / 3.0);
  if (weight_ > 0.0)
    faces_ = WeightedChoice(weights);
}

double Emitter::brightness(const Material &material, uint32_t face) const {
  if (!sampled(material))
    return 0.0;
  return varies(material) ? double(brightness_[face]) : brightest(material.emission.value);
}

LightSample Emitter::sample(const Geometry &geometry, const std::vector<uint32_t> &slots,
                            const std::vector<Material> &materials, const glm::dvec3 &p, const glm::vec2 &u,
                            Surface &surface) const {
  // Choose a face; what is left of the number places the point on it.
  const auto choice = faces_.sample(u.x);
  const glm::vec2 rest(choice.u, u.y);
  if (geometry.instances[instance_].kind == ShapeKind::Mesh)
    surface = face_point(geometry, slots, instance_, choice.index, glm::dvec2(warp_triangle(rest)));
  else
    surface = part_point(geometry, slots, instance_, int(choice.index), rest);

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
  return sample;
}

double Emitter::pdf(const Geometry &geometry, const std::vector<Material> &materials, const glm::dvec3 &p,
                    const Surface &surface) const {
  const Instance &placed = geometry.instances[instance_];
  const glm::dvec3 v = surface.p - p;
  const double d2 = glm::dot(v, v), cosine = std::abs(glm::dot(glm::dvec3(surface.ng), v)) / std::sqrt(d2);
  if (!(cosine > 0.0) || !(d2 > 0.0) || surface.material == kNone || !(weight_ > 0.0))
    return 0.0;
  double per_area;
  if (placed.kind == ShapeKind::Mesh) {
    // A face is chosen by emission times area and covered evenly: its area cancels.
    per_area = brightness(materials[surface.material], surface.primitive) / weight_;
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
