// Bumps: the height's slope, looked at a pixel's width away, tilts the normal.
#include "scene/attribute.h"
#include "scene/node_site.h"
#include "scene/scene.h"

#include <array>
#include <cmath>

namespace lancer {

namespace {

// Two directions along the surface, and how the surface moves along them: lengths of a pixel, in the user's units.
struct Steps {
  glm::dvec3 x{0.0}, y{0.0}; // unit, in the normalised world
  glm::dvec3 px{0.0}, py{0.0};
  const MeshAttribute *undisplaced = nullptr; // px, py and the normal are the object's
};

double user_scale(const Site &site) { return site.context->normalisation ? site.context->normalisation->scale : 1.0; }

Steps steps_at(const Node &node, const Site &site) {
  Steps steps;
  glm::vec3 along = glm::cross(glm::vec3(1.0f), site.ng);
  if (site.ng.x == site.ng.y && site.ng.x == site.ng.z)
    along = glm::cross(glm::vec3(-1.0f, 1.0f, 1.0f), site.ng);
  steps.x = glm::normalize(glm::dvec3(along));
  steps.y = glm::cross(glm::dvec3(site.ng), steps.x);
  const double footprint = double(site.context->footprint);
  steps.px = steps.x * (footprint / user_scale(site));
  steps.py = steps.y * (footprint / user_scale(site));
  if (!(node.flags & 2))
    return steps;
  steps.undisplaced = site.mesh() ? find_attribute(*site.mesh(), node.name) : nullptr;
  if (!steps.undisplaced) {
    // Nothing was displaced: the same surface, in its object's space.
    steps.px = site.instance()->to_object.vector(steps.x * footprint);
    steps.py = site.instance()->to_object.vector(steps.y * footprint);
    return steps;
  }
  // The same steps in weights of the vertices, taken on the surface as it was.
  const uint32_t triangle = site.surface()->primitive;
  const auto corner = [&](double u, double v) {
    return glm::dvec3(attribute_at(*site.mesh(), *steps.undisplaced, triangle, {u, v}));
  };
  const glm::dvec3 e1 = corner(1.0, 0.0) - corner(0.0, 0.0), e2 = corner(0.0, 1.0) - corner(0.0, 0.0);
  const glm::dvec2 bx = site.moved(steps.x * footprint).bary - site.bary, by = site.moved(steps.y * footprint).bary - site.bary;
  steps.px = bx.x * e1 + bx.y * e2;
  steps.py = by.x * e1 + by.y * e2;
  return steps;
}

// Where the height is looked at: moved, and on the surface as it was where that is asked for.
Site height_site(const Site &site, const Steps &steps, const glm::dvec3 &offset) {
  Site place = site.moved(offset);
  place.in_height = true;
  if (steps.undisplaced) {
    const glm::vec4 p = attribute_at(*site.mesh(), *steps.undisplaced, site.surface()->primitive, place.bary);
    place.p = site.instance()->to_world.point(glm::dvec3(p));
  }
  return place;
}

// The normal input; on a flat face that was displaced its normal before that.
glm::vec3 flat_normal_before(const Inputs &in, const Site &site) {
  const glm::vec3 normal = in.normal(3, site);
  const MeshAttribute *before = site.mesh() ? find_attribute(*site.mesh(), kUndisplaced) : nullptr;
  if (!before || normal != site.ng)
    return normal;
  const auto corner = [&](double u, double v) {
    return glm::vec3(attribute_at(*site.mesh(), *before, site.surface()->primitive, {u, v}));
  };
  const glm::vec3 v0 = corner(0.0, 0.0);
  const glm::vec3 flat = site.normal_to_world(glm::cross(corner(1.0, 0.0) - v0, corner(0.0, 1.0) - v0));
  return glm::dot(flat, site.ng) < 0.0f ? -flat : flat;
}

} // namespace

glm::vec3 bump(const Program &program, const Inputs &in, const Site &site, std::span<glm::vec4> values) {
  const glm::vec3 normal = in.node.flags & 4 ? flat_normal_before(in, site) : in.normal(3, site);
  const float filter = in.scalar(4);
  // The height of a bump does not see other bumps: each would look at its own three times as often.
  if (site.in_height || !site.surface() || !(site.context->footprint > 0.0f) || !(filter > 0.0f))
    return normal;
  const bool in_object = in.node.flags & 2;
  const Steps steps = steps_at(in.node, site);

  // Compute the height here and beside, and leave the values as they were.
  const Schedule &schedule = program.heights[in.node.heights];
  std::array<glm::vec4, 64> few;
  std::vector<glm::vec4> many(schedule.size() > few.size() ? schedule.size() : 0);
  glm::vec4 *saved = many.empty() ? few.data() : many.data();
  for (size_t i = 0; i < schedule.size(); ++i)
    saved[i] = values[schedule[i]];
  const auto height = [&](const glm::dvec3 &offset) {
    run_at(program, schedule, height_site(site, steps, offset), values);
    return double(in.scalar(2));
  };
  const double step = double(site.context->footprint) * double(filter);
  const double here = height(glm::dvec3(0.0)), dx = height(step * steps.x) - here, dy = height(step * steps.y) - here;
  for (size_t i = 0; i < schedule.size(); ++i)
    values[schedule[i]] = saved[i];

  // Tilt the normal against the slope.
  const glm::vec3 straight = in_object ? site.normal_to_object(normal) : normal;
  const glm::dvec3 n(straight), rx = glm::cross(steps.py, n), ry = glm::cross(n, steps.px);
  const double det = glm::dot(steps.px, rx), distance = double(in.scalar(1)) * (in.node.flags & 1 ? -1.0 : 1.0);
  const glm::dvec3 slope = (dx * rx + dy * ry) * (det < 0.0 ? -distance : distance);
  const glm::dvec3 sum = double(filter) * std::abs(det) * n - slope;
  const double length = glm::length(sum);
  if (!(length > 0.0) || !std::isfinite(length))
    return normal;
  const float strength = std::max(in.scalar(0), 0.0f);
  const glm::vec3 tilted = unit_or_zero(strength * glm::vec3(sum / length) + (1.0f - strength) * straight);
  return in_object ? site.normal_to_world(tilted) : tilted;
}

} // namespace lancer
