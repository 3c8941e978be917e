// How much a light or a cluster of them may matter at a point: the weights by which the light tree chooses.
// Bounds of what arrives, from above and from below, as in Cycles: where only one technique can meet a light, the picture
// depends on these densities. Where Cycles' rounding would lose a light that contributes, its chance stays positive here.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace lancer {

// Who asks for light: a point of a surface and its shading normal, and whether light may also come through from behind.
struct LightQuery {
  glm::dvec3 p{0.0};
  glm::vec3 n{0, 0, 1};
  bool transmits = false;
  glm::vec3 p_float{0.0f};
  float slack = 0.0f; // what float may have moved p by

  LightQuery(const glm::dvec3 &p_, const glm::vec3 &n_, bool transmits_)
      : p(p_), n(n_), transmits(transmits_), p_float(p_),
        slack(0x1p-22f * (std::abs(p_float.x) + std::abs(p_float.y) + std::abs(p_float.z))) {}
};

// Bounds of what arrives; most > 0 wherever anything may arrive.
struct Importance {
  float most = 0.0f, least = 0.0f;
};

// What stands between is not known: beside a blinding light that is hidden, a dim one may be all there is. Of n to choose from,
// none that may contribute counts for less than 1 / n of this part of the strongest: so much of the choices is the most that
// raised ones take from the others.
inline constexpr float kRaised = 0x1p-8f;

// Where the light leaves: LightCone, in cosines.
struct ShineCone {
  glm::vec3 axis{0, 0, 1};
  float cos_o = 1.0f, sin_o = 0.0f;
  float cos_all = 0.0f;  // of theta_o + theta_e; -2 where that is beyond pi
  float cos_full = 0.0f; // of theta_e - theta_o; 2 where that is negative
};

// A light as the point sees it.
struct LightView {
  glm::vec3 to{0, 0, 1};            // unit, towards its centre
  float cos_u = 1.0f, sin_u = 0.0f; // the half angle that it fills
  float near2 = 1.0f, far2 = 1.0f;  // its squared distance, at least and at most
};

// Cosines that rounding may have pushed below zero, and what they count for then.
inline constexpr float kCosineSlack = 0x1p-20f;
// Scenes and trees are about 1024 wide: nothing is nearer than the rounding of a float position, or less important than this.
inline constexpr float kNearest2 = 0x1p-40f, kLeastImportance = 0x1p-60f;

inline float sine_of(float cosine) { return std::sqrt(std::max(0.0f, (1.0f - cosine) * (1.0f + cosine))); }

// cos_theta: between the cone's axis and the way from the light to the point.
inline Importance importance(const LightQuery &query, const LightView &view, const ShineCone &cone, float cos_theta,
                             float energy) {
  // The smallest and the largest angle at which it may arrive.
  const float along = glm::dot(view.to, query.n), cos_i = query.transmits ? std::abs(along) : along, sin_i = sine_of(cos_i);
  const float cos_i_least = cos_i >= view.cos_u ? 1.0f : cos_i * view.cos_u + sin_i * view.sin_u;
  const float cos_i_most = std::max(cos_i * view.cos_u - sin_i * view.sin_u, 0.0f);
  // The same where it leaves.
  const float sin_theta = sine_of(cos_theta);
  const float inner = cos_theta * view.cos_u + sin_theta * view.sin_u, outer = cos_theta * view.cos_u - sin_theta * view.sin_u;
  const bool within = cos_theta >= view.cos_u || inner >= cone.cos_o;
  const float cos_out_least = within ? 1.0f : inner * cone.cos_o + sine_of(inner) * cone.sin_o;
  const bool seen = within || inner > cone.cos_all - kCosineSlack;
  if (!seen || cos_i_least < -kCosineSlack)
    return {};
  Importance result;
  const float near2 = std::max(view.near2, kNearest2), far2 = std::max(view.far2, kNearest2);
  const float most = energy * std::max(cos_i_least, kCosineSlack) * std::max(cos_out_least, kCosineSlack) / near2;
  result.most = std::max(most, kLeastImportance);
  if (cos_theta >= 0.0f && view.cos_u >= 0.0f && outer >= cone.cos_full)
    result.least = std::abs(cos_i_most * energy * (outer * cone.cos_o - sine_of(outer) * cone.sin_o)) / far2;
  return result;
}

} // namespace lancer
