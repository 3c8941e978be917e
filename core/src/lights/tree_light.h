// A light as the light tree knows it: what its importance at a point needs, and nothing else.
#pragma once

#include "lights/light.h"
#include "lights/light_bounds.h"
#include "lights/light_importance.h"

namespace lancer {

// A light, or a face of one, that was chosen.
struct LightChoice {
  uint32_t number = 0;      // as the tree's user counts
  double probability = 0.0; // 0: no light can contribute
  double u = 0.0;           // what is left of the random number, uniform in [0, 1)
};

// A box of lights. A distant one lies beyond everything, towards -axis.
struct ClusterShape {
  glm::vec3 centre{0.0f}, half{0.0f};
  ShineCone cone;
  float energy = 0.0f;
};

struct TreeLight {
  enum class Kind : uint32_t { Disk, Ball, Area, Sun, Sky, Cluster };

  Kind kind = Kind::Disk;
  bool spot = false;
  uint32_t number = 0; // as the tree's user counts
  float energy = 0.0f; // relative to the brightest of the tree
  glm::dvec3 centre{0.0};
  // Disk, Ball of a spot; Area: direction of light. Sun: the other way.
  glm::vec3 axis{0, 0, 1};
  glm::vec3 u{0.0f}, v{0.0f};       // Area: half its sides; Cluster: u is half of it
  float radius = 0.0f;              // Disk, Ball
  float cos_e = 0.0f, blend = 0.0f; // Disk, Ball of a spot: end and width of its rim; Area, Sun: cos_e
  ShineCone cone;                   // Cluster
};

// One that is no light's own: energy 0.
struct DescribedLight {
  TreeLight light;
  LightBounds bounds; // energy in the user's units
  bool met = false;   // a ray may run into it

  // Beyond everything, without a place.
  bool distant() const { return light.kind == TreeLight::Kind::Sun || light.kind == TreeLight::Kind::Sky; }
};

DescribedLight describe(const Light &light, uint32_t number);
// mean: of the radiance over all directions.
DescribedLight describe_sky(double mean, uint32_t number);
// Corners in the tree's space; energy: radiance times area.
DescribedLight describe_triangle(const glm::dvec3 (&corners)[3], double energy, uint32_t number);
DescribedLight describe_cluster(const LightBounds &bounds, uint32_t number);

ShineCone shine_cone(const LightCone &cone);
// Padded by what float may lose.
ClusterShape cluster_shape(const LightBounds &bounds);

Importance importance(const LightQuery &query, const TreeLight &light);

// Of clusters, which are what a choice asks most.
inline Importance importance(const LightQuery &query, const ClusterShape &cluster) {
  const glm::vec3 v = cluster.centre - query.p_float;
  const float d2 = glm::dot(v, v), r2 = glm::dot(cluster.half, cluster.half);
  // Nothing of the box is above the surface.
  const float reach = glm::dot(glm::abs(query.n), cluster.half) + query.slack;
  if (!query.transmits && !(glm::dot(query.n, v) + reach > 0.0f))
    return {};
  LightView view;
  const float d = std::sqrt(d2);
  view.to = d > 0.0f ? v / d : glm::vec3(0.0f);
  const float sin2 = d2 > r2 ? r2 / d2 : 0.0f;
  view.sin_u = std::sqrt(sin2);
  view.cos_u = d2 > r2 ? std::sqrt(1.0f - sin2) : -1.0f;
  view.near2 = view.far2 = std::max(d2, 0.25f * r2);
  return importance(query, view, cluster.cone, -glm::dot(cluster.cone.axis, view.to), cluster.energy);
}

// Of distant ones: a disk of the sky at distance 1.
inline Importance importance_far(const LightQuery &query, const ClusterShape &cluster) {
  LightView view;
  view.to = -cluster.cone.axis;
  view.cos_u = std::max(cluster.cone.cos_all, -1.0f);
  view.sin_u = sine_of(view.cos_u);
  return importance(query, view, cluster.cone, 1.0f, cluster.energy);
}

} // namespace lancer
