// The meeting of a ray with a material: frame, side and BSDF at a surface point.
#pragma once

#include "bsdf/frame.h"
#include "scene/scene.h"

namespace lancer {

// The shading point: directions are turned into the local frame of the shading normal (n = +z, outward).
struct ShadingPoint {
  const Material *material = nullptr; // null: an instance without slots, black
  const Bsdf *bsdf = nullptr;
  Frame frame{glm::vec3(0.0f, 0.0f, 1.0f)};
  glm::vec3 wo{0.0f}; // local
  glm::vec3 ng{0.0f};
  bool outside = true; // wo is on the side of the outward geometric normal

  // Whether the world direction wi, local as given, leaves on the side that the shading normal promises. Where an interpolated
  // normal and the surface disagree the light would have to pass through the surface.
  bool consistent(const glm::vec3 &wi_world, const glm::vec3 &wi_local) const {
    return (glm::dot(wi_world, ng) > 0.0f) == (wi_local.z > 0.0f);
  }
};

// Tilts an interpolated normal that looks away from the viewer just so far that it sees him at a grazing angle, as the
// smooth surface that it stands for would.
inline glm::vec3 visible_normal(const glm::vec3 &ns, const glm::vec3 &ng, const glm::vec3 &wo) {
  const float side = glm::dot(wo, ng) < 0.0f ? -1.0f : 1.0f, cosine = side * glm::dot(wo, ns);
  constexpr float grazing = 1.0f / 1024.0f;
  if (cosine >= grazing || side * glm::dot(wo, ng) < grazing)
    return cosine > 0.0f ? ns : ng;
  return glm::normalize(ns + side * (grazing - cosine) * wo);
}

// wo: unit, world, away from the surface. scratch keeps the BSDF of textured materials.
inline ShadingPoint shading_point(const Scene &scene, const Surface &surface, const glm::vec3 &wo, Bsdf &scratch) {
  ShadingPoint point;
  point.ng = surface.ng;
  point.outside = glm::dot(wo, surface.ng) >= 0.0f;
  point.frame = Frame(visible_normal(surface.ns, surface.ng, wo));
  point.wo = point.frame.to_local(wo);
  if (surface.material == kNone) {
    scratch = Bsdf{};
    point.bsdf = &scratch;
    return point;
  }
  point.material = &scene.materials[surface.material];
  point.bsdf = &evaluate(*point.material, surface, scratch);
  return point;
}

// A shadow ray to a light's sample.
inline Ray shadow_ray(const Surface &surface, const LightSample &sample) {
  if (std::isinf(sample.distance))
    return leave(surface, sample.wi, std::numeric_limits<double>::infinity());
  Ray ray = leave(surface, sample.wi, 1.0);
  ray.d = sample.target - ray.o;
  return ray;
}

} // namespace lancer
