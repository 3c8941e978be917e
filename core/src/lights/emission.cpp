#include "lights/emission.h"

#include "bsdf/material_lobes.h"
#include "simd/parallel.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>

namespace lancer {

bool is_light(const MaterialView &material) { return material.emits() && !(material.flags & MaterialFlag::NotALight); }

bool emission_varies(const MaterialView &material) { return material.emission.varies() || material.layered_emission; }

double emission_level(const glm::vec3 &radiance) {
  const double level = double(mean(glm::abs(radiance)));
  return std::isfinite(level) ? level : 0.0;
}

glm::vec3 EmissionAt::operator()(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path) {
  if (surface.material == kNone)
    return glm::vec3(0.0f);
  const MaterialView *const material = &materials_[surface.material];
  ScheduleView nodes = material->layered_emission ? material->surface_nodes : material->emission_nodes;
  nodes_.run(material->program, nodes, surface, {.wo = wo, .path = path});
  const glm::vec3 own = nodes_.value(material->emission);
  if (!material->layered_emission)
    return own;
  // The tint of the layers above the emitting one depends on the direction: build all lobes.
  find_lobes<float>(&material, PlaceValues{nodes_.values()}, false, wo, surface.ns, surface.ng, bsdf_, {.ends = true});
  return own + bsdf_.emission;
}

double EmissionAt::level(const Surface &surface) {
  const LightPath<float> path{.depth = 1.0f};
  return std::max(emission_level((*this)(surface, surface.ng, path)), emission_level((*this)(surface, -surface.ng, path)));
}

namespace {

// The barycentric places at which a face is evaluated: its middle, and halfway from there to each corner.
constexpr double kLooks[4][2] = {{1.0 / 3, 1.0 / 3}, {1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}};
// The least weight of a face, as a share of the mean over all: a texture may be bright between the evaluated places.
constexpr double kLeastShare = 0.05;
// Lengths of the axes that differ by less than this share are treated as one uniform scale.
constexpr double kOneScale = 1e-4;

struct Corners {
  glm::dvec3 p[3];
  double area() const { return 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])); }
};

Corners corners_of(const MeshView &mesh, const Affine *to_world, uint32_t face) {
  Corners corners;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 p(mesh.vertex(face, i));
    corners.p[i] = to_world ? to_world->point(p) : p;
  }
  return corners;
}

Surface point_of(const GeometryView &geometry, std::span<const uint32_t> slots, uint32_t instance, uint32_t face,
                 const double (&weights)[2]) {
  Hit hit;
  hit.instance = instance;
  hit.primitive = face;
  hit.u = weights[0];
  hit.v = weights[1];
  return surface_at(geometry, slots, Ray{}, hit);
}

} // namespace

std::vector<double> EmissiveFaces::powers(const GeometryView &geometry, std::span<const uint32_t> slots,
                                          std::span<const MaterialView> materials, uint32_t instance, EmissionAt &emission,
                                          const BuildContext &context) const {
  const Instance &placed = geometry.instances[instance];
  const MeshView &mesh = geometry.meshes[placed.mesh];
  const uint32_t faces = uint32_t(mesh.triangles.size());
  std::vector<double> powers(faces);
  std::vector<bool> textured(faces);
  double looked_at = 0.0, seen = 0.0;
  for (uint32_t face = 0; face < faces; ++face) {
    poll_cancel(context);
    const uint32_t number = material_of(geometry, slots, instance, face);
    if (number == kNone || !is_light(materials[number]))
      continue;
    const MaterialView &material = materials[number];
    const double area = corners_of(mesh, of_mesh_ ? nullptr : &placed.to_world, face).area();
    double level = emission_level(material.emission.value);
    if (emission_varies(material)) {
      // Average over a few points; one suffices where the emission depends on the direction alone.
      const bool by_nodes = !material.emission_nodes.empty();
      level = 0.0;
      const int looks = by_nodes ? 4 : 1;
      for (int i = 0; i < looks; ++i)
        level += emission.level(point_of(geometry, slots, instance, face, kLooks[i])) / looks;
      textured[face] = by_nodes;
      looked_at += by_nodes ? area : 0.0;
      seen += by_nodes ? level * area : 0.0;
    }
    powers[face] = level * area;
  }
  // Give the dark faces of a texture their least share.
  const double least = looked_at > 0.0 ? kLeastShare * seen / looked_at : 0.0;
  for (uint32_t face = 0; face < faces && least > 0.0; ++face)
    if (textured[face])
      powers[face] = std::max(powers[face], least * corners_of(mesh, of_mesh_ ? nullptr : &placed.to_world, face).area());
  return powers;
}

EmissiveFaces::EmissiveFaces(const GeometryView &geometry, std::span<const uint32_t> slots,
                             std::span<const MaterialView> materials, uint32_t instance, bool of_mesh, EmissionAt &emission,
                             const BuildContext &context)
    : of_mesh_(of_mesh) {
  const Instance &placed = geometry.instances[instance];
  const MeshView &mesh = geometry.meshes[placed.mesh];
  const std::vector<double> power = powers(geometry, slots, materials, instance, emission, context);
  by_power_ = WeightedChoice(power);
  // Scale the emitting faces to coordinates of at most about 1024 around 0, where float is precise enough.
  LightBounds box;
  uint32_t shining = 0;
  for (uint32_t face = 0; face < power.size(); ++face) {
    if (!(power[face] > 0.0))
      continue;
    ++shining;
    for (const glm::dvec3 &p : corners_of(mesh, of_mesh_ ? nullptr : &placed.to_world, face).p)
      box.grow(p);
  }
  if (shining == 0)
    return;
  centre_ = box.centre();
  const glm::dvec3 size = box.high - box.low;
  scale_ = std::ldexp(1.0, 9 - std::ilogb(std::max({size.x, size.y, size.z})));
  std::vector<DescribedLight> lights;
  lights.reserve(shining);
  for (uint32_t face = 0; face < power.size(); ++face) {
    if (!(power[face] > 0.0))
      continue;
    Corners corners = corners_of(mesh, of_mesh_ ? nullptr : &placed.to_world, face);
    for (glm::dvec3 &p : corners.p)
      p = (p - centre_) * scale_;
    lights.push_back(describe_triangle(corners.p, power[face], face));
    if (mesh.key_count == 0)
      continue;
    // A face that changes its shape may be anywhere between its keys, and turned anywhere.
    LightBounds bounds = lights.back().bounds;
    for (uint32_t key = 0; key < mesh.key_count; ++key)
      for (int i = 0; i < 3; ++i)
        bounds.grow((glm::dvec3(mesh.key_vertex(face, i, key)) - centre_) * scale_);
    bounds.cone.theta_o = glm::pi<double>();
    lights.back() = describe_cluster(bounds, face);
  }
  tree_ = LightTree(std::move(lights), uint32_t(power.size()), context);
}

LightQuery EmissiveFaces::to_tree(const Instance &placed, const LightQuery &query) const {
  if (!of_mesh_)
    return LightQuery((query.p - centre_) * scale_, query.n, query.transmits);
  const glm::dvec3 n = glm::transpose(placed.to_world.linear) * glm::dvec3(query.n);
  return LightQuery((placed.to_object.point(query.p) - centre_) * scale_, glm::vec3(unit_or_zero(n)), query.transmits);
}

LightBounds EmissiveFaces::bounds(const Instance &placed) const {
  const LightBounds &own = tree_.bounds();
  LightBounds result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1 ? own.high.x : own.low.x, corner & 2 ? own.high.y : own.low.y,
                        corner & 4 ? own.high.z : own.low.z);
    const glm::dvec3 p = at / scale_ + centre_;
    result.grow(of_mesh_ ? placed.to_world.point(p) : p);
  }
  result.cone = own.cone;
  result.energy = own.energy;
  if (!of_mesh_)
    return result;
  // A uniform scale preserves angles; otherwise the cone covers all directions.
  const glm::dmat3 &m = placed.to_world.linear;
  const double x = glm::length(m[0]), y = glm::length(m[1]), z = glm::length(m[2]), widest = std::max({x, y, z});
  const double skew =
      std::max({std::abs(glm::dot(m[0], m[1])), std::abs(glm::dot(m[1], m[2])), std::abs(glm::dot(m[2], m[0]))});
  if (widest - std::min({x, y, z}) > kOneScale * widest || skew > kOneScale * widest * widest)
    result.cone.theta_o = glm::pi<double>();
  else
    result.cone.axis = glm::normalize(m * own.cone.axis);
  result.energy *= mean_area_scale(m);
  return result;
}

} // namespace lancer
