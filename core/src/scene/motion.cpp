#include "scene/motion.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Enough for any invertible map: the iteration first halves the logarithm of each stretch and then converges quadratically.
constexpr int kMostIterations = 100;

// Returns the rotation nearest to a map (Higham, "Computing the Polar Decomposition", 1986). A mirrored map has a rotation,
// too: its stretch is negative.
glm::dmat3 nearest_rotation(const glm::dmat3 &map) {
  glm::dmat3 turn = map;
  for (int i = 0; i < kMostIterations; ++i) {
    const glm::dmat3 next = 0.5 * (turn + glm::transpose(glm::inverse(turn)));
    double change = 0.0;
    for (int column = 0; column < 3; ++column)
      change = std::max(change, glm::length(next[column] - turn[column]));
    turn = next;
    if (change < 0x1p-50)
      break;
  }
  return glm::determinant(turn) < 0.0 ? -turn : turn;
}

double norm(const glm::dmat3 &m) { return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])); }

// Returns the quaternion at a share of the way from one key's to another's.
glm::dquat turned(const PlacementKey &key, const glm::dquat &to, double share) {
  // Below this angle, the chord is the arc to the last digit of double.
  constexpr double kStraight = 1e-8;
  if (key.angle < kStraight)
    return glm::normalize(key.rotation * (1.0 - share) + to * share);
  const double of_from = sin((1.0 - share) * key.angle) / key.sine, of_to = sin(share * key.angle) / key.sine;
  return key.rotation * of_from + to * of_to;
}

} // namespace

std::vector<PlacementKey> placement_keys(std::span<const Affine> maps) {
  std::vector<PlacementKey> keys;
  for (const Affine &map : maps) {
    PlacementKey key;
    const glm::dmat3 turn = nearest_rotation(map.linear);
    key.translation = map.translation;
    key.rotation = glm::normalize(glm::quat_cast(turn));
    key.stretch = glm::transpose(turn) * map.linear;
    // Turn by the shortest way.
    if (!keys.empty() && glm::dot(keys.back().rotation, key.rotation) < 0.0)
      key.rotation = -key.rotation;
    keys.push_back(key);
  }
  for (size_t i = 0; i + 1 < keys.size(); ++i) {
    // The angle from the chord keeps its digits where the rotations are nearly equal.
    const glm::dquat chord = keys[i + 1].rotation - keys[i].rotation;
    keys[i].angle = 2.0 * asin(std::min(0.5 * std::sqrt(glm::dot(chord, chord)), 1.0));
    keys[i].sine = sin(keys[i].angle);
  }
  return keys;
}

Affine placement_at(std::span<const PlacementKey> keys, float time) {
  const KeyPlace at = key_at(uint32_t(keys.size()), time);
  const PlacementKey &from = keys[at.key], &to = keys[at.key + 1];
  const double share = double(at.share);
  Affine map;
  map.linear = glm::mat3_cast(turned(from, to.rotation, share)) * (from.stretch * (1.0 - share) + to.stretch * share);
  map.translation = from.translation * (1.0 - share) + to.translation * share;
  return map;
}

double bend_bound(const PlacementKey &from, const PlacementKey &to, double reach, double way) {
  // A rotation of twice the quaternions' angle. With p = R S x + T, where S, x and T are linear in time,
  // p'' = R'' S x + 2 R' (S' x + S x') + 2 R S' x'.
  const double turn = 2.0 * from.angle, stretch = std::max(norm(from.stretch), norm(to.stretch));
  const double stretching = norm(to.stretch - from.stretch);
  return turn * turn * stretch * reach + 2.0 * turn * (stretching * reach + stretch * way) + 2.0 * stretching * way;
}

} // namespace lancer
