// Bounds of lights: the space that they occupy and the directions into which they shine.
#pragma once

#include "lights/light.h"

#include <glm/glm.hpp>
#include <limits>

namespace lancer {

// Bounds of a cluster of the light tree: position, directions and energy (Conty and Kulla, Importance Sampling of Many Lights
// with Adaptive Tree Splitting, 2018).

// The cone holds normals within theta_o of the axis; light leaves within theta_e of each of them.
struct LightCone {
  glm::dvec3 axis{0.0}; // unit; 0: empty
  double theta_o = 0.0, theta_e = 0.0;

  bool empty() const { return axis == glm::dvec3(0.0); }
  // Grows the cone to nearly the smallest one around both.
  void add(const LightCone &other);
  // Returns the solid angle that the light shines into, weighted by the cosine beyond theta_o.
  double measure() const;
};

struct LightBounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  LightCone cone;
  double energy = 0.0; // contribution at distance 1: intensity, or radiance times area

  void grow(const glm::dvec3 &p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  // Adds other bounds; bounds without energy change nothing.
  void add(const LightBounds &other);
  glm::dvec3 centre() const { return 0.5 * (low + high); }
  // Whether the bounds lie behind the plane through p with unit normal n: no direction to them, rounded to float, has a cosine
  // above 0.
  bool behind(const glm::dvec3 &p, const glm::dvec3 &n) const;
  // Returns the cost of choosing from this cluster by the surface area orientation heuristic.
  double cost() const;
};

// A shading point that chooses a light: its position, its shading normal, whether its surface transmits light, and the set of
// receivers that it belongs to.
struct LightQuery {
  glm::dvec3 p{0.0};
  glm::vec3 n{0, 0, 1};
  bool transmits = false;
  uint32_t receiver_set = 0;

  LightQuery(const glm::dvec3 &point, const glm::vec3 &normal, bool through, uint32_t set = 0)
      : p(point), n(normal), transmits(through), receiver_set(set) {}
};

// A light, or a face of one, that was chosen.
struct LightChoice {
  uint32_t number = 0;      // as the tree's owner counts
  double probability = 0.0; // 0: no light can contribute
  double u = 0.0;           // rest of the random number, uniform in [0, 1)
};

// The directions into which a light shines: LightCone as cosines.
struct ShineCone {
  glm::vec3 axis{0, 0, 1};
  float cos_o = 1.0f, sin_o = 0.0f;
  float cos_all = 0.0f;  // of theta_o + theta_e; -2 where the sum is beyond pi
  float cos_full = 0.0f; // of theta_e - theta_o; 2 where the difference is negative
};

// A box of lights. A distant cluster lies at infinity towards -axis.
struct ClusterShape {
  glm::vec3 centre{0.0f}, half{0.0f};
  ShineCone cone;
  float energy = 0.0f;
};

struct TreeLight {
  enum class Kind : uint32_t { Disk, Ball, Area, Sun, Sky, Cluster };

  Kind kind = Kind::Disk;
  bool spot = false;
  uint32_t number = 0; // as the tree's owner counts
  float energy = 0.0f; // relative to the brightest light of the tree
  glm::dvec3 centre{0.0};
  // Disk, Ball of a spot; Area: the direction into which it shines. Sun: the opposite direction.
  glm::vec3 axis{0, 0, 1};
  glm::vec3 u{0.0f}, v{0.0f};       // Area: half its sides; Cluster: u is half of its box
  float radius = 0.0f;              // Disk, Ball
  float cos_e = 0.0f, blend = 0.0f; // Disk, Ball of a spot: end and width of its rim; Area, Sun: cos_e
  ShineCone cone;                   // Cluster
};

// A light as input to the builders of the trees. energy is 0 for a light without power of its own.
struct DescribedLight {
  TreeLight light;
  LightBounds bounds; // energy in the user's units
  bool met = false;   // a ray may hit the light

  // Whether the light is at infinity, without a position.
  bool distant() const { return light.kind == TreeLight::Kind::Sun || light.kind == TreeLight::Kind::Sky; }
};

DescribedLight describe(const Light &light, uint32_t number);
// mean: of the radiance over all directions.
DescribedLight describe_sky(double mean, uint32_t number);
// Corners in the tree's space; energy: radiance times area.
DescribedLight describe_triangle(const glm::dvec3 (&corners)[3], double energy, uint32_t number);
DescribedLight describe_cluster(const LightBounds &bounds, uint32_t number);

ShineCone shine_cone(const LightCone &cone);
// Returns the box in float, padded by the rounding error of float.
ClusterShape cluster_shape(const LightBounds &bounds);

} // namespace lancer
