// Access to vectors in the lanes of a block, and rays that leave them.
#pragma once

#include "integrator/stages/vertex_kernel.h"
#include "scene/ray.h"

#include <glm/glm.hpp>

namespace lancer {

inline void put(const glm::vec3 &v, VertexBlock::Floats (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = v[i];
}
inline void put(const glm::dvec3 &v, VertexBlock::Doubles (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = v[i];
}
inline glm::vec3 get(const VertexBlock::Floats (&lanes)[3], uint32_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}
inline glm::dvec3 get(const VertexBlock::Doubles (&lanes)[3], uint32_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

// Fills a ray from an origin that a lane has computed, off the surface of the hit. The ray is written in place.
inline void leave(const Hit &hit, const glm::dvec3 &o, const glm::dvec3 &d, double tmax, uint32_t kinds, Ray &ray) {
  ray.o = o;
  ray.d = d;
  ray.tmax = tmax;
  ray.skip_instance = hit.instance;
  ray.skip_primitive = hit.primitive;
  ray.kinds = kinds;
}

} // namespace lancer
