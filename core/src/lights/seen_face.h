// A face of a glowing mesh as a point sees it: near ones are sampled by the solid angle that they fill, far ones by area.
#pragma once

#include "sampling/spherical_triangle.h"
#include "sampling/warp.h"
#include "scene/geometry.h"

namespace lancer {

// A face of a mesh as a point sees it, relative to the point.
struct SeenFace {
  // Below this share of the squared distance of its middle a face is taken as a light far away, which its area describes as
  // well; beyond these solid angles it is seen edge on, or the point lies on it.
  static constexpr double kFar = 0.01, kLeastAngle = 1e-6, kMostAngle = 6.28;

  glm::dvec3 v0, e1, e2;
  double area = 0.0;

  SeenFace(const Geometry &geometry, const Instance &instance, uint32_t face, const glm::dvec3 &p) {
    const Mesh &mesh = geometry.meshes[instance.mesh];
    const glm::dvec3 a(mesh.vertex(face, 0)), b(mesh.vertex(face, 1)), c(mesh.vertex(face, 2));
    v0 = instance.to_world.point(a) - p;
    e1 = instance.to_world.vector(b - a);
    e2 = instance.to_world.vector(c - a);
    area = 0.5 * glm::length(glm::cross(e1, e2));
  }

  bool is_near() const {
    const glm::dvec3 middle = v0 + (e1 + e2) / 3.0;
    return area > kFar * glm::dot(middle, middle);
  }

  // Whether directions to it are sampled evenly, of which there are so many.
  static bool is_even(double solid_angle) { return solid_angle > kLeastAngle && solid_angle < kMostAngle; }

  SphericalTriangle directions() const { return {v0, v0 + e1, v0 + e2}; }

  // The weights of corners 1 and 2 where a direction meets its plane; of its middle where rounding has it run along the plane.
  glm::dvec2 weights(const glm::dvec3 &wi) const {
    const glm::dvec3 across = glm::cross(wi, e2);
    const double cosine = glm::dot(across, e1);
    if (cosine == 0.0)
      return glm::dvec2(1.0 / 3.0);
    const double scale = 1.0 / cosine;
    const double u = std::clamp(-glm::dot(v0, across) * scale, 0.0, 1.0);
    return {u, std::clamp(-glm::dot(wi, glm::cross(v0, e1)) * scale, 0.0, 1.0 - u)};
  }
};

// The weights of corners 1 and 2 of the point of a face that u stands for.
inline glm::dvec2 sample_seen(const SeenFace &seen, const glm::vec2 &u) {
  if (seen.is_near()) {
    const SphericalTriangle directions = seen.directions();
    if (SeenFace::is_even(directions.solid_angle))
      return seen.weights(directions.sample(glm::dvec2(u)));
  }
  return glm::dvec2(warp_triangle(u));
}

} // namespace lancer
