// Nodes that look around a place on a surface by rays: Ambient Occlusion, Bevel, Raycast. One place at a time, for every lane
// width the same code: a ray costs far more than lanes would save.
#pragma once

#include "sampling/sobol.h"
#include "scene/ray.h"
#include "scene/surface.h"

#include <span>

namespace lancer {

// The hits of rays that nodes send: functions of a tracer, one per thread. instance: the only one whose hits count; kNone: all
// count.
struct NodeRays {
  static constexpr uint32_t kMost = 16; // rays of one call

  void *tracer = nullptr;
  uint32_t (*count_open)(void *tracer, std::span<const Ray> rays, uint32_t instance) = nullptr;
  Hit (*find_closest)(void *tracer, const Ray &ray, uint32_t instance) = nullptr;
  std::span<const Hit> (*find_all)(void *tracer, const Ray &ray, uint32_t instance) = nullptr;
  Surface (*find_surface)(const void *tracer, const Ray &ray, const Hit &hit) = nullptr;

  // Returns how many rays meet nothing.
  uint32_t open(std::span<const Ray> rays, uint32_t instance) const { return count_open(tracer, rays, instance); }
  Hit closest(const Ray &ray, uint32_t instance) const { return find_closest(tracer, ray, instance); }
  // Returns the hits with an instance, those at one distance as one, valid until the next call.
  std::span<const Hit> all(const Ray &ray, uint32_t instance) const { return find_all(tracer, ray, instance); }
  Surface surface(const Ray &ray, const Hit &hit) const { return find_surface(tracer, ray, hit); }
};

// Where a node looks around.
struct LookingPlace {
  Surface surface; // normals outwards
  bool backfacing = false;
  // The address of random numbers: pixel and sample of the sampler, and the dimension of the vertex.
  uint32_t pixel = 0, sample = 0, dimension = 0;

  glm::vec3 facing(const glm::vec3 &n) const { return backfacing ? -n : n; }
};

// Returns the share of rays that meet nothing within a distance (normalised units), cosine-distributed around n. count: of
// rays; node: number of the node, whose random numbers are its own.
float open_share(const NodeRays &rays, const LookingPlace &at, const glm::vec3 &n, double distance, uint32_t count, bool alone,
                 uint32_t node);

// Returns the mean normal of the object's own surface within a radius (normalised units), on the side of the place's own: the
// normal of an edge that is rounded; 0 if no point is found. Weights fall with the cube of the distance to the radius; points
// are found by rays along three axes (King et al., BSSRDF Importance Sampling, 2013).
glm::vec3 bevelled_normal(const NodeRays &rays, const LookingPlace &at, double radius, uint32_t count, uint32_t node);

} // namespace lancer
