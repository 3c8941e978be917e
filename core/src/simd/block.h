// Blocks: arrays that hold a number for each of 16 lanes, and vectors in them. Kernels of any width read and write them.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

namespace lancer {

inline constexpr int kBlockLanes = 16;

// Aligned, so that kernels load whole registers.
using Floats [[gnu::aligned(64)]] = float[kBlockLanes];
using Doubles [[gnu::aligned(64)]] = double[kBlockLanes];
using Words [[gnu::aligned(64)]] = uint32_t[kBlockLanes];

inline void put(const glm::vec3 &v, Floats (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = v[i];
}
inline void put(const glm::dvec3 &v, Doubles (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = v[i];
}
inline glm::vec3 get(const Floats (&lanes)[3], uint32_t lane) { return {lanes[0][lane], lanes[1][lane], lanes[2][lane]}; }
inline glm::dvec3 get(const Doubles (&lanes)[3], uint32_t lane) { return {lanes[0][lane], lanes[1][lane], lanes[2][lane]}; }

// Calls visit(lane) for each lane of the bits, the first lane first.
template <class Visit> void each_lane(uint32_t lanes, Visit &&visit) {
  for (; lanes != 0; lanes &= lanes - 1)
    visit(uint32_t(std::countr_zero(lanes)));
}

} // namespace lancer
