// Normals and what depends on them: normal maps, tangents, displacement, Fresnel and layer weight, bumps.
#include "bsdf/fresnel.h"
#include "sampling/elementary.h"
#include "scene/attribute.h"
#include "scene/node_site.h"
#include "scene/scene.h"

#include <cmath>
#include <optional>

namespace lancer {

namespace {

// A tangent in the object's space and the hand of its frame.
struct Tangent {
  glm::vec3 t{0.0f};
  float sign = 1.0f;
};

// Outwards, of any length: maps stand in the interpolated frame as it is.
glm::vec3 object_normal(const Site &site) {
  if (const Mesh *mesh = site.mesh()) {
    const glm::vec3 n = interpolated_normal(*mesh, site.instance()->shading, site.surface()->primitive, site.bary);
    if (n != glm::vec3(0.0f))
      return n;
    return site.normal_to_object(site.surface()->ng);
  }
  return site.normal_to_object(site.surface()->ns);
}

// Where u grows along a triangle.
std::optional<Tangent> uv_tangent(const Mesh &mesh, uint32_t name, uint32_t triangle, const glm::vec3 &n) {
  glm::vec2 uv[3];
  if (!corner_uvs(mesh, name, triangle, uv))
    return std::nullopt;
  const glm::dvec3 v0(mesh.vertex(triangle, 0));
  const glm::dvec3 e1 = glm::dvec3(mesh.vertex(triangle, 1)) - v0, e2 = glm::dvec3(mesh.vertex(triangle, 2)) - v0;
  const glm::dvec2 d1 = glm::dvec2(uv[1]) - glm::dvec2(uv[0]), d2 = glm::dvec2(uv[2]) - glm::dvec2(uv[0]);
  const double det = d1.x * d2.y - d1.y * d2.x;
  if (det == 0.0)
    return std::nullopt;
  // Keep what lies across the normal.
  glm::dvec3 t = (det < 0.0 ? -1.0 : 1.0) * (d2.y * e1 - d1.y * e2);
  const glm::dvec3 normal(unit_or_zero(n));
  t -= glm::dot(t, normal) * normal;
  const double length = glm::length(t);
  if (!(length > 0.0))
    return std::nullopt;
  return Tangent{glm::vec3(t / length), det < 0.0 ? -1.0f : 1.0f};
}

std::optional<Tangent> tangent_at(const Node &node, const Site &site, const glm::vec3 &n) {
  const Instance *placed = site.instance();
  if (!placed)
    return std::nullopt;
  const Mesh *mesh = site.mesh();
  if (!mesh) {
    // Exact surfaces run around their axis; a plane along x.
    if (placed->kind == ShapeKind::Plane)
      return Tangent{{1.0f, 0.0f, 0.0f}, 1.0f};
    const glm::dvec3 p = placed->to_object.point(site.p);
    const glm::vec3 around = unit_or_zero(glm::vec3(glm::dvec3(-p.y, p.x, 0.0)));
    return around == glm::vec3(0.0f) ? std::nullopt : std::optional(Tangent{around, 1.0f});
  }
  const uint32_t triangle = site.surface()->primitive;
  if (const MeshAttribute *found = find_attribute(*mesh, node.tangent)) {
    const glm::vec4 value = attribute_at(*mesh, *found, triangle, site.bary);
    return Tangent{glm::vec3(value), value.w < 0.0f ? -1.0f : 1.0f};
  }
  return uv_tangent(*mesh, node.name, triangle, n);
}

bool usable(const glm::vec3 &n) {
  return n != glm::vec3(0.0f) && std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z);
}

} // namespace

glm::vec3 normal_map(const Inputs &in, const Site &site) {
  if (!site.surface())
    return site.ns;
  float strength = in.scalar(0);
  glm::vec3 color = 2.0f * (in[1] - 0.5f), n;
  if (in.node.option == 0) {
    const glm::vec3 interpolated = object_normal(site);
    const glm::vec3 normal = in.node.flags & 1 ? unit_or_zero(interpolated) : interpolated;
    const std::optional<Tangent> frame = tangent_at(in.node, site, normal);
    if (!frame)
      return site.ns;
    // Strength flattens the map before it is turned into the frame.
    color.x *= strength;
    color.y *= strength;
    color.z = 1.0f + (color.z - 1.0f) * glm::clamp(strength, 0.0f, 1.0f);
    const glm::vec3 bitangent = frame->sign * glm::cross(normal, frame->t);
    n = site.normal_to_world(unit_or_zero(color.x * frame->t + color.y * bitangent + color.z * normal));
    n = site.backfacing ? -n : n;
  } else {
    const bool inverted = in.node.option >= 3, object = in.node.option == 1 || in.node.option == 3;
    if (inverted)
      color = {color.x, -color.y, -color.z};
    n = object ? site.normal_to_world(color) : unit_or_zero(color);
    n = site.backfacing ? -n : n;
    strength = std::max(strength, 0.0f);
    if (strength != 1.0f)
      n = unit_or_zero(site.ns + (n - site.ns) * strength);
  }
  return usable(n) ? n : site.ns;
}

glm::vec3 tangent(const Node &node, const Site &site) {
  if (!site.surface())
    return glm::vec3(0.0f);
  glm::vec3 t;
  if (node.option == 3) {
    const std::optional<Tangent> frame = tangent_at(node, site, object_normal(site));
    if (!frame)
      return glm::vec3(0.0f);
    t = frame->t;
  } else {
    // Around the axis through the middle of the generated coordinates.
    Node place;
    place.kind = LANCER_NODE_COORDINATE;
    place.option = LANCER_COORDINATE_GENERATED;
    place.name = node.name;
    const glm::vec3 g = glm::vec3(coordinate(place, site)) - 0.5f;
    t = node.option == 0   ? glm::vec3(0.0f, -g.z, g.y)
        : node.option == 1 ? glm::vec3(-g.z, 0.0f, g.x)
                           : glm::vec3(-g.y, g.x, 0.0f);
  }
  t = site.normal_to_world(t);
  return glm::cross(site.ns, unit_or_zero(glm::cross(t, site.ns)));
}

glm::vec3 displacement(const Inputs &in, const Site &site) {
  const float offset = (in.scalar(0) - in.scalar(1)) * in.scalar(2);
  const glm::vec3 n = in.normal(3, site);
  const Instance *placed = site.instance();
  if (!placed)
    return n * offset;
  if (in.node.option == 0)
    return site.normal_to_object(n) * offset;
  // A length in the world, in the user's units, as the object sees it.
  const double scale = site.context->normalisation ? site.context->normalisation->scale : 1.0;
  return glm::vec3(placed->to_object.vector(glm::dvec3(n) * (double(offset) * scale)));
}

float fresnel_weight(const Inputs &in, const Site &site) {
  const float ior = std::max(in.scalar(0), 1e-5f);
  return fresnel_dielectric(std::abs(glm::dot(site.context->wo, in.normal(1, site))), site.backfacing ? 1.0f / ior : ior);
}

float layer_weight(const Inputs &in, const Site &site) {
  const float blend = in.scalar(0), cosine = std::abs(glm::dot(site.context->wo, in.normal(1, site)));
  if (in.node.option == 0) {
    const float inverse = std::max(1.0f - blend, 1e-5f);
    return fresnel_dielectric(cosine, site.backfacing ? inverse : 1.0f / inverse);
  }
  if (blend == 0.5f)
    return 1.0f - cosine;
  const float share = glm::clamp(blend, 0.0f, 1.0f - 1e-5f);
  return 1.0f - pow(cosine, share < 0.5f ? 2.0f * share : 0.5f / (1.0f - share));
}

} // namespace lancer
