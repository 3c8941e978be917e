#include "compile/steps.h"

#include "sampling/elementary.h"
#include "simd/parallel.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lancer {

namespace {

// Sets the light's axes: keeps z and makes x and y orthogonal to it. An axis of length 0 is replaced by any orthogonal
// direction.
void set_axes(Light &light, const Affine &map) {
  const auto unit = [](const glm::dvec3 &v) { return glm::length(v) > 0.0 ? v / glm::length(v) : glm::dvec3(0.0); };
  const glm::dvec3 z = unit(map.linear[2]), x = unit(map.linear[0]), y = unit(map.linear[1]);
  light.z = z == glm::dvec3(0.0) ? glm::dvec3(0.0, 0.0, 1.0) : z;
  light.x = unit(x - glm::dot(x, light.z) * light.z);
  if (light.x == glm::dvec3(0.0))
    light.x = unit(std::abs(light.z.x) < 0.5 ? glm::cross(light.z, {1, 0, 0}) : glm::cross(light.z, {0, 1, 0}));
  light.y = glm::cross(light.z, light.x);
  if (glm::dot(light.y, y) < 0.0)
    light.y = -light.y;
}

// Cosine between columns above which a matrix is sheared. Float matrices under parents without shear stay below 1e-5; a shear
// of ten times that is not visible.
constexpr double kSheared = 1e-4;

glm::dmat3 unit_columns(const glm::dmat3 &m) { return {unit_or_zero(m[0]), unit_or_zero(m[1]), unit_or_zero(m[2])}; }

bool is_sheared(const glm::dmat3 &unit) {
  const auto along = [&](int i, int k) { return std::abs(glm::dot(unit[i], unit[k])); };
  return std::max({along(0, 1), along(0, 2), along(1, 2)}) > kSheared;
}

// Shears an area light: its sides are the columns x and y, and it emits along the normal of its plane, to the side of -z.
void shear_area(Light &light, const glm::dmat3 &unit) {
  const glm::dvec3 normal = unit_or_zero(glm::cross(unit[0], unit[1]));
  if (normal == glm::dvec3(0.0)) {
    light.half_y = 0.0;
    return;
  }
  light.z = glm::dot(normal, unit[2]) < 0.0 ? -normal : normal;
  light.x = unit[0];
  light.y = glm::cross(light.z, light.x);
  const glm::dvec2 side(glm::dot(unit[1], light.x), std::abs(glm::dot(unit[1], light.y)));
  if (glm::dot(unit[1], light.y) < 0.0)
    light.y = -light.y;
  light.skew = light.half_y * side.x;
  light.half_y *= side.y;
  if (!light.ellipse)
    return;
  // A skewed ellipse is an ellipse about other axes: the eigenvectors of the matrix of its half axes times its transpose.
  const double x = light.half_x, y = light.half_y, s = light.skew;
  const double apart = x * x + s * s - y * y, across = 2.0 * s * y, root = std::sqrt(apart * apart + across * across);
  const double longer = std::sqrt(0.5 * (x * x + s * s + y * y + root));
  light.skew = 0.0;
  if (!(root > 0.0))
    return;
  const double c = std::sqrt(0.5 + 0.5 * apart / root), d = std::copysign(std::sqrt(0.5 - 0.5 * apart / root), across);
  const glm::dvec3 turned_x = c * light.x + d * light.y, turned_y = c * light.y - d * light.x;
  light.x = turned_x;
  light.y = turned_y;
  light.half_x = longer;
  light.half_y = x * y / longer;
}

// Shears the cone of a spot: directions are looked at in the space of its columns, where the cone is round.
void shear_cone(Light &light, const glm::dmat3 &unit) {
  const glm::dmat3 columns(light.stretch_x * unit[0], light.stretch_y * unit[1], unit[2]);
  if (std::abs(glm::determinant(columns)) == 0.0)
    return;
  const glm::dmat3 rows = glm::transpose(glm::inverse(columns));
  light.skewed_cone = true;
  light.x = glm::normalize(rows[0]);
  light.y = glm::normalize(rows[1]);
  light.z = glm::normalize(rows[2]);
  light.stretch_x = glm::length(rows[2]) / glm::length(rows[0]);
  light.stretch_y = glm::length(rows[2]) / glm::length(rows[1]);
}

// Upper bound of the tolerance, in normalised units; the scene is at least 512 wide. With it, a scene far from the origin keeps
// the shadows of objects right before a lamp.
constexpr double kMostApart = 0x1p-7;

// Returns the largest distance between a lamp and a face that are meant to lie in one plane, in normalised units. Blender
// computes transforms in float and stores corners as floats: locations, axes and corners of both together have an error of
// about ten half units in the last place.
double apart_by_rounding(const LightDescription &from, double scale) {
  const glm::dvec3 &p = from.to_world.translation;
  const double reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) + 0.5 * double(from.size.x + from.size.y);
  return std::min(0x1p-20 * reach * scale, kMostApart);
}

} // namespace

Light place_light(const LightDescription &from, const Normalisation &normalisation) {
  Light light;
  const double scale = normalisation.scale;
  light.kind = from.kind;
  light.position = normalisation.to_normalised(from.to_world.translation);
  set_axes(light, from.to_world);
  const glm::dmat3 columns = unit_columns(from.to_world.linear);
  const bool sheared = is_sheared(columns);
  light.emission = glm::dvec3(from.emission);
  if (!from.strength.varies())
    light.emission *= glm::dvec3(from.strength.value);
  // Irradiance is intensity over distance squared: lengths scale, so intensity scales with their square.
  if (from.kind == LightKind::Point || from.kind == LightKind::Spot)
    light.emission *= scale * scale;
  light.radius = double(from.radius) * scale;
  light.soft_falloff = from.soft_falloff;
  if (from.kind == LightKind::Spot) {
    light.cos_half_angle = cos(0.5 * double(from.spot_angle));
    light.blend_width = (1.0 - light.cos_half_angle) * double(from.spot_blend);
    light.spot_cosine = from.spot_cosine;
    light.stretch_x = double(from.size.x);
    light.stretch_y = double(from.size.y);
    if (sheared)
      shear_cone(light, columns);
    light.stretched = sheared || light.stretch_x != 1.0 || light.stretch_y != 1.0;
  }
  // A flat disk cannot fill half of the sky.
  const double sun_angle = from.sun_flat ? std::min(double(from.sun_angle), glm::radians(179.9)) : double(from.sun_angle);
  // 1 - cos(a) = 2 sin^2(a / 2), exact for the smallest suns.
  const double s = sin(0.25 * sun_angle);
  light.one_minus_cos_sun = 2.0 * s * s;
  light.flat_radius = from.sun_flat ? tan(0.5 * sun_angle) : 0.0;
  // A disk below the rounding of a float direction becomes a single direction.
  if (0.5 * double(from.sun_angle) < 0x1p-24)
    light.one_minus_cos_sun = 0.0;
  light.half_x = 0.5 * double(from.size.x) * scale;
  light.half_y = 0.5 * double(from.size.y) * scale;
  light.ellipse = from.shape == AreaShape::Ellipse;
  if (from.kind == LightKind::Area)
    light.plane_tolerance = apart_by_rounding(from, scale);
  if (from.kind == LightKind::Area && sheared)
    shear_area(light, columns);
  light.area = (light.ellipse ? glm::pi<double>() : 4.0) * light.half_x * light.half_y;
  if (from.spread < glm::pi<float>()) {
    const double half = 0.5 * std::max(double(from.spread), 1e-3);
    light.tan_half_spread = tan(half);
    light.spread_scale = 1.0 / (light.tan_half_spread - half);
  }
  light.hidden_from = from.no_catchers ? hidden_of_other(from.hidden_from) : hidden_of_catcher(from.hidden_from);
  light.no_shadow = from.no_shadow;
  light.light_group = from.light_group;
  light.links = from.links;
  light.lit_surfaces = from.lit_surfaces;
  light.classic = {from.falloff,       double(from.falloff_radius) * scale, scale, from.ambient_color, from.diffuse_color,
                   from.specular_color};
  return light;
}

namespace {

// Makes the tree of an instance's faces, or takes that of the scene before.
std::shared_ptr<const EmissiveFaces> faces_of(const GeometryView &geometry, std::span<const uint32_t> slots,
                                              std::span<const MaterialView> materials, uint32_t number, bool of_mesh,
                                              EmissionAt &emission, const BuildContext &context,
                                              const EmitterSources &sources) {
  const auto make = [&] {
    count_made(context, &MadeCounts::emitters);
    return std::make_shared<EmissiveFaces>(geometry, slots, materials, number, of_mesh, emission, context);
  };
  if (!sources.made)
    return make();
  const Instance &instance = geometry.instances[number];
  MadeEmissiveFaces wanted;
  wanted.mesh = sources.meshes[instance.mesh];
  for (const uint32_t slot : slots.subspan(instance.first_slot, instance.slot_count)) {
    wanted.materials.push_back(sources.materials[slot]);
    wanted.by_nodes = wanted.by_nodes || !materials[slot].emission_nodes.empty();
  }
  wanted.of_mesh = of_mesh;
  wanted.instance = instance;
  const MadeEmissiveFaces *const known = find_made(sources.before, wanted);
  wanted.faces = known ? known->faces : make();
  sources.made->push_back(wanted);
  return wanted.faces;
}

} // namespace

std::vector<Emitter> make_emitters(const GeometryView &geometry, std::span<const uint32_t> slots,
                                   std::span<const MaterialView> materials, EmissionAt &emission, const BuildContext &context,
                                   const EmitterSources &sources) {
  // Collect the emitting instances: exact surfaces alone, meshes grouped by mesh and materials.
  using Key = std::pair<uint32_t, std::vector<uint32_t>>;
  struct Shared {
    uint32_t users = 0;
    std::shared_ptr<const EmissiveFaces> faces;
  };
  std::map<Key, Shared> shared;
  std::vector<std::pair<uint32_t, Shared *>> emitting;
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance &instance = geometry.instances[i];
    const auto begin = slots.begin() + instance.first_slot, end = begin + instance.slot_count;
    if (std::none_of(begin, end, [&](uint32_t slot) { return is_light(materials[slot]); }))
      continue;
    Shared *user = nullptr;
    if (instance.kind == ShapeKind::Mesh) {
      user = &shared[{instance.mesh, std::vector<uint32_t>(begin, end)}];
      ++user->users;
    }
    emitting.push_back({i, user});
  }
  // Make the lights in the order of the instances.
  std::vector<Emitter> emitters;
  for (const auto &[instance, user] : emitting) {
    poll_cancel(context);
    if (!user) {
      Emitter emitter(geometry, slots, materials, instance, emission);
      if (!emitter.empty())
        emitters.push_back(std::move(emitter));
      continue;
    }
    if (!user->faces)
      user->faces = faces_of(geometry, slots, materials, instance,
                             user->users > 1 || geometry.moves(geometry.instances[instance]), emission, context, sources);
    if (!user->faces->empty())
      emitters.emplace_back(geometry, instance, user->faces);
  }
  return emitters;
}

} // namespace lancer
