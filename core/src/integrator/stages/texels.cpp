#include "integrator/stages/texels.h"

#include "scene/surface.h"

#include <algorithm>

namespace lancer {

namespace {

// Places that are tried within the texel until one lies on its triangle, as in Cycles; then the middle is taken.
constexpr int kTries = 10;
// A corner moves by this share of its way to the middle of its triangle: a ray that starts there would run along the faces that
// meet in the corner.
constexpr double kInwards = 1e-4;
// Least cosine between the normal and a view from the camera: as in Cycles, faces that look away from the camera are seen from
// above by as much as they look away.
constexpr double kLeastCosine = 0.2;

// Weights of the corners 0 and 1.
using Weights = glm::dvec2;

Weights off_corners(const Weights &at) {
  if ((at.x == 0.0 || at.x == 1.0) && (at.y == 0.0 || at.y == 1.0))
    return at + kInwards * (Weights(1.0 / 3.0) - at);
  return at;
}

Weights place_on(const Texel &texel, const Sampler &sampler) {
  const Weights middle = off_corners({texel.weights[0], texel.weights[1]});
  // The first sample takes the middle, as in Cycles: passes of the first sample show the middle of the texel.
  if (sampler.sample() == 0)
    return middle;
  const Weights dx(texel.dx[0], texel.dx[1]), dy(texel.dy[0], texel.dy[1]);
  glm::dvec2 u(sampler.get2(kDimensionPixel));
  uint32_t key = hash_combine(sampler.pixel(), sampler.sample());
  for (int tried = 0; tried < kTries; ++tried) {
    const Weights at = middle + (u.x - 0.5) * dx + (u.y - 0.5) * dy;
    if (at.x > 0.0 && at.y > 0.0 && at.x + at.y < 1.0)
      return at;
    key = hash_combine(key, uint32_t(tried));
    u = {double(key) * 0x1p-32, double(hash(key)) * 0x1p-32};
  }
  return middle;
}

} // namespace

// Returns the unit direction from the surface to the viewer.
glm::dvec3 TexelStage::view_direction(const Surface &surface) const {
  const glm::dvec3 n(surface.ns), ng(surface.ng);
  if (bake_.view != BakeView::Camera)
    return n;
  glm::dvec3 wo = camera_.kind == CameraKind::Orthographic ? glm::normalize(camera_.to_world.linear[2])
                                                           : glm::normalize(camera_.to_world.translation - surface.p);
  const double cosine = glm::dot(wo, n);
  if (cosine <= kLeastCosine)
    wo = glm::normalize(wo - (cosine - kLeastCosine) * n);
  if (cosine <= 0.0)
    wo = glm::normalize(glm::mix(wo, n, -cosine));
  if (const double above = glm::dot(wo, ng) - 1e-5; above <= 0.0)
    wo = glm::normalize(wo - above * ng);
  return wo;
}

Hit TexelStage::aim(const Texel &texel, const Sampler &sampler, Ray &ray) {
  const Weights at = place_on(texel, sampler);
  Hit hit{.t = 0.0, .u = at.y, .v = 1.0 - at.x - at.y, .instance = bake_.instance, .primitive = texel.primitive};
  ray = Ray();
  ray.kinds = RayKind::Camera;
  ray.d = glm::dvec3(0.0, 0.0, -1.0);
  const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
  if (bake_.view == BakeView::Sky) {
    ray.o = scene_.normalisation.to_normalised(glm::dvec3(0.0));
    const glm::dvec3 way = surface.p - ray.o;
    ray.d = way == glm::dvec3(0.0) ? glm::dvec3(0.0, 0.0, 1.0) : glm::normalize(way);
    return {};
  }
  // The viewer is at a distance of 1 in the user's units.
  const glm::dvec3 wo = view_direction(surface);
  hit.t = scene_.normalisation.scale;
  ray.o = surface.p + hit.t * wo;
  ray.d = -wo;
  return hit;
}

float TexelStage::width_of(const Texel &texel) const {
  const Instance &instance = scene_.geometry.instances[bake_.instance];
  const MeshView &mesh = scene_.geometry.meshes[instance.mesh];
  glm::dvec3 corner[3];
  for (int i = 0; i < 3; ++i)
    corner[i] = instance.to_world.linear * glm::dvec3(mesh.vertex(texel.primitive, i, kMiddleTime));
  const glm::dvec3 d0 = corner[0] - corner[2], d1 = corner[1] - corner[2];
  const auto length = [&](const std::array<float, 2> &change) {
    return glm::length(double(change[0]) * d0 + double(change[1]) * d1);
  };
  return float(0.25 * (length(texel.dx) + length(texel.dy)));
}

} // namespace lancer
