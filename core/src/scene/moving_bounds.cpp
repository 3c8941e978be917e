#include "scene/moving_bounds.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Steps between two keys: a half turn leaves its chord by 0.08 of the radius.
constexpr uint32_t kSteps = 8;

glm::dmat3 magnitudes(const glm::dmat3 &m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

Extent between(const Extent &from, const Extent &to, double share) {
  return {from.lo * (1.0 - share) + to.lo * share, from.hi * (1.0 - share) + to.hi * share};
}

// Returns the largest distance from the origin in a box.
double reach_of(const Extent &box) { return glm::length(glm::max(glm::abs(box.lo), glm::abs(box.hi))); }

} // namespace

std::vector<Extent> own_extents(const MeshView &mesh) {
  std::vector<Extent> extents(std::max(mesh.key_count, 1u));
  for (uint32_t key = 0; key < extents.size(); ++key) {
    Extent &extent = extents[key];
    for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
      for (int corner = 0; corner < 3; ++corner)
        extent.grow(glm::dvec3(mesh.key_count ? mesh.key_vertex(triangle, corner, key) : mesh.vertex(triangle, corner)));
    if (mesh.key_count == 0 || extent.empty())
      continue;
    const double rounding = kKeyRounding * reach_of(extent);
    extent.lo -= rounding;
    extent.hi += rounding;
  }
  return extents;
}

std::vector<Extent> extents_over_time(const GeometryView &geometry, const Instance &instance, std::span<const Extent> own) {
  const std::span<const PlacementKey> keys = geometry.keys_of(instance);
  // The steps end at all keys of both: a path is smooth between two steps.
  const uint32_t own_steps = uint32_t(own.size()) - 1, key_steps = keys.empty() ? 0 : uint32_t(keys.size()) - 1;
  const uint32_t steps = keys.empty() ? own_steps : kSteps * std::max(own_steps, key_steps);
  double way = 0.0, reach = 0.0;
  for (uint32_t i = 0; i < own.size(); ++i) {
    reach = std::max(reach, reach_of(own[i]));
    // A vertex moves from one box to the next.
    if (i > 0)
      way = std::max(way, glm::length(glm::max(own[i].hi, own[i - 1].hi) - glm::min(own[i].lo, own[i - 1].lo)));
  }
  // In a step of the placement, the shape moves by its share of its own step.
  const double way_of_key = own_steps && key_steps ? way * double(own_steps) / double(key_steps) : 0.0;
  std::vector<Extent> extents;
  for (uint32_t i = 0; i <= steps; ++i) {
    const float time = float(i) / float(steps);
    Extent box = own.front();
    if (own_steps > 0) {
      const KeyPlace at = key_at(uint32_t(own.size()), time);
      box = between(own[at.key], own[at.key + 1], double(at.share));
    }
    Affine map = instance.to_world;
    double bend = 0.0;
    if (!keys.empty()) {
      map = placement_at(keys, time);
      // The steps on both sides end here. A chord of 1 / n of a key's time leaves the path by 1 / n^2 of the bound.
      const KeyPlace at = key_at(uint32_t(keys.size()), time);
      for (uint32_t key = at.key - uint32_t(at.share == 0.0f && at.key > 0); key <= at.key; ++key)
        bend = std::max(bend, bend_bound(keys[key], keys[key + 1], reach, way_of_key));
      const double shorter = double(key_steps) / double(steps);
      bend *= 0.125 * shorter * shorter;
    }
    const glm::dvec3 middle = map.point(box.middle()), half = magnitudes(map.linear) * box.half() + bend;
    extents.push_back({middle - half, middle + half});
  }
  return extents;
}

Extent swept_extent(const GeometryView &geometry, const Instance &instance) {
  const bool on_mesh = instance.kind == ShapeKind::Mesh;
  const std::vector<Extent> own =
      on_mesh ? own_extents(geometry.meshes[instance.mesh]) : std::vector<Extent>{{glm::dvec3(-1.0), glm::dvec3(1.0)}};
  Extent all;
  for (const Extent &extent : extents_over_time(geometry, instance, own)) {
    all.grow(extent.lo);
    all.grow(extent.hi);
  }
  return all;
}

} // namespace lancer
