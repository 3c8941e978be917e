// What encloses lights: where they are, where they shine, how much. Clusters of the light tree are made of it (Conty and Kulla,
// Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018).
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace lancer {

// Normals within theta_o of the axis; light leaves within theta_e of each of them.
struct LightCone {
  glm::dvec3 axis{0.0}; // unit; 0: empty
  double theta_o = 0.0, theta_e = 0.0;

  bool empty() const { return axis == glm::dvec3(0.0); }
  // The smallest cone around both, nearly.
  void add(const LightCone &other);
  // The solid angle that it shines into, weighted with the cosine beyond theta_o.
  double measure() const;
};

struct LightBounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  LightCone cone;
  double energy = 0.0; // what arrives at distance 1: intensity, or radiance times area

  void grow(const glm::dvec3 &p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  // What has no energy adds nothing.
  void add(const LightBounds &other);
  glm::dvec3 centre() const { return 0.5 * (low + high); }
  // Whether all of it lies behind the plane through p with unit normal n: no direction to it, told in floats, has a cosine
  // above 0.
  bool behind(const glm::dvec3 &p, const glm::dvec3 &n) const;
  // The cost of asking this cluster: the surface area orientation heuristic.
  double cost() const;
};

} // namespace lancer
