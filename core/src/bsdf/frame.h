// The local frame of a surface point: n becomes +z.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace lancer {

struct Frame {
  glm::vec3 t, b, n; // orthonormal, right-handed

  Frame() = default;

  // n must be unit. Duff et al. 2017: no direction is near a singularity.
  explicit Frame(const glm::vec3 &normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float c = n.x * n.y * a;
    t = {1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x};
    b = {c, sign + n.y * n.y * a, -n.y};
  }

  // t lies in the plane of n and tangent; any t where those are parallel.
  Frame(const glm::vec3 &normal, const glm::vec3 &tangent) : Frame(normal) {
    const glm::vec3 across = glm::cross(normal, tangent);
    const float length2 = glm::dot(across, across);
    if (!(length2 > 0.0f))
      return;
    b = across / std::sqrt(length2);
    t = glm::cross(b, normal);
  }

  glm::vec3 to_local(const glm::vec3 &w) const { return {glm::dot(w, t), glm::dot(w, b), glm::dot(w, n)}; }
  glm::vec3 to_world(const glm::vec3 &w) const { return w.x * t + w.y * b + w.z * n; }
};

// The mirrored direction in the local frame.
inline glm::vec3 reflect_local(const glm::vec3 &w) { return {-w.x, -w.y, w.z}; }

} // namespace lancer
