// Vectors in and out of the lanes of a block.
#pragma once

#include "integrator/vertex_block.h"

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

} // namespace lancer
