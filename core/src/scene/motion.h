// Motion while the shutter is open: placements and vertices at keys, at equal steps of time, and between two keys.
//
// Time is 0 where the shutter opens and 1 where it closes. Placements between keys follow Cycles: translation and stretch
// change linearly, the rotation turns by the shortest way at constant speed. Vertices and normals move along straight lines.
#pragma once

#include "scene/affine.h"
#include "simd/vectors.h"

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

namespace lancer {

// The time of everything that is not moved: the middle of the shutter.
inline constexpr float kMiddleTime = 0.5f;

// A number of keys is 2^n + 1: of a mesh and its instance, the one with more keys has all key times of the other.
inline constexpr uint32_t kMostKeys = 129;
constexpr bool is_key_count(uint32_t count) { return count >= 3 && count <= kMostKeys && ((count - 1) & (count - 2)) == 0; }

// The key at or before a time, and the share of the way to the next one. Exact: the number of steps is a power of two.
struct KeyPlace {
  uint32_t key = 0;
  float share = 0.0f;
};
LANCER_LANE KeyPlace key_at(uint32_t count, float time) {
  const float at = time * float(count - 1);
  const uint32_t key = at > 0.0f ? uint32_t(at) : 0u;
  return key >= count - 1 ? KeyPlace{count - 2, 1.0f} : KeyPlace{key, at - float(key)};
}

// A vector between two keys: the same bits in every traversal and at every hit.
template <class F> LANCER_LANE F between_keys(const F &from, const F &to, const F &share) { return from + share * (to - from); }
inline glm::vec3 between_keys(const glm::vec3 &from, const glm::vec3 &to, float share) { return from + share * (to - from); }

// A placement as rotation times stretch, plus translation (polar decomposition).
struct PlacementKey {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dmat3 stretch{1.0};
  double angle = 0.0; // between this rotation and the next key's, as unit quaternions
  double sine = 0.0;  // of the angle
};

// Decomposes the maps of successive keys; their linear parts must be invertible.
std::vector<PlacementKey> placement_keys(std::span<const Affine> maps);
// Returns the placement at a time.
Affine placement_at(std::span<const PlacementKey> keys, float time);

// Returns a bound on the second derivative of a moved point's path from one key to the next, where time runs from 0 to 1.
// reach: the point's largest distance from the origin of its space; way: how far the point itself moves there, along a straight
// line. A path leaves its chord by at most an eighth of the bound.
double bend_bound(const PlacementKey &from, const PlacementKey &to, double reach, double way);

} // namespace lancer
