// The frames that lobes stand in.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bsdf/build.h"
#include "sampling/elementary.h"

namespace lancer {

namespace {

glm::vec3 unit_or(const glm::vec3 &v, const glm::vec3 &otherwise) {
  const float length2 = glm::dot(v, v);
  return length2 > 0.0f && std::isfinite(length2) ? v / std::sqrt(length2) : otherwise;
}

} // namespace

uint8_t add_frame(Bsdf &bsdf, const glm::vec3 &n, const glm::vec3 &t) {
  if (n == glm::vec3(0.0f) && t == glm::vec3(0.0f))
    return 0;
  const glm::vec3 normal = normal_or_shading(bsdf, n);
  const bool any_tangent = t == glm::vec3(0.0f);
  const Frame frame = any_tangent ? Frame() : Frame(normal, t);
  // One that is there already will do.
  for (int i = 0; i < bsdf.frame_count; ++i)
    if (bsdf.frames[i].n == normal && (any_tangent || bsdf.frames[i].t == frame.t))
      return static_cast<uint8_t>(i);
  if (bsdf.frame_count == kMaxFrames)
    return 0;
  const int i = bsdf.frame_count++;
  bsdf.frames[i] = any_tangent ? Frame(normal) : frame;
  bsdf.wo_local[i] = bsdf.frames[i].to_local(bsdf.wo);
  return static_cast<uint8_t>(i);
}

glm::vec3 normal_or_shading(const Bsdf &bsdf, const glm::vec3 &n) {
  // To normalise once more might move it by a bit, and make a second frame of the first.
  return n == bsdf.ns ? n : unit_or(n, bsdf.ns);
}

glm::vec3 reflecting_normal(const Bsdf &bsdf, const glm::vec3 &n) {
  const glm::vec3 normal = normal_or_shading(bsdf, n);
  if (!bsdf.bump_correction || normal == bsdf.ng)
    return normal;
  // The mirrored direction shall rise above the surface by this cosine, or nearly as much as wo does.
  const float cos_o = glm::dot(bsdf.wo, bsdf.ng), least = std::min(0.9f * cos_o, 0.01f);
  const glm::vec3 mirrored = 2.0f * glm::dot(normal, bsdf.wo) * normal - bsdf.wo;
  if (glm::dot(bsdf.ng, mirrored) >= least)
    return normal;
  // In the plane of both normals wo is (x, z). The normal at angle t from ng mirrors its z to x sin(2t) + z cos(2t), which is
  // to be least: the sine and cosine of the two angles where it is, taken on the side towards the given normal.
  const glm::vec3 side = unit_or(normal - glm::dot(normal, bsdf.ng) * bsdf.ng, normal);
  const float x = glm::dot(bsdf.wo, side), z = cos_o;
  const float length2 = x * x + z * z;
  const float reach = std::sqrt(std::max(0.0f, length2 - least * least));
  // cos(2t) of the solution; the tilt is the largest that still works.
  const float cos_2t = (z * least - x * reach) / length2;
  const float cos_t = std::sqrt(std::clamp(0.5f * (1.0f + cos_2t), 0.0f, 1.0f));
  const float sin_t = std::sqrt(std::clamp(0.5f * (1.0f - cos_2t), 0.0f, 1.0f));
  return glm::normalize(sin_t * side + cos_t * bsdf.ng);
}

glm::vec3 turn_about(const glm::vec3 &t, const glm::vec3 &axis, float turns) {
  const float angle = 2.0f * std::numbers::pi_v<float> * turns, c = cos(angle), s = sin(angle);
  return c * t + s * glm::cross(axis, t) + (1.0f - c) * glm::dot(axis, t) * axis;
}

} // namespace lancer
