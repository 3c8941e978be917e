#include "integrator/stages/node_rays.h"

#include <algorithm>

namespace lancer {

SceneNodeRays::SceneNodeRays(const Scene &scene) : scene_(scene), own_(scene) {
  static constexpr auto of = [](void *tracer) -> SceneNodeRays & { return *static_cast<SceneNodeRays *>(tracer); };
  functions_ = {this,
                [](void *tracer, std::span<const Ray> rays, uint32_t instance) { return of(tracer).open(rays, instance); },
                [](void *tracer, const Ray &ray, uint32_t instance) { return of(tracer).closest(ray, instance); },
                [](void *tracer, const Ray &ray, uint32_t instance) { return of(tracer).all(ray, instance); },
                [](const void *tracer, const Ray &ray, const Hit &hit) {
                  return static_cast<const SceneNodeRays *>(tracer)->surface(ray, hit);
                }};
}

uint32_t SceneNodeRays::open(std::span<const Ray> rays, uint32_t instance) {
  uint8_t occluded[NodeRays::kMost] = {};
  const std::span<uint8_t> answers(occluded, rays.size());
  uint32_t of[NodeRays::kMost];
  std::fill_n(of, rays.size(), instance);
  if (instance == kNone)
    scene_.accelerator->any_hit(rays, answers);
  else
    own_.any(rays, {of, rays.size()}, answers);
  return uint32_t(std::ranges::count(answers, 0));
}

Hit SceneNodeRays::closest(const Ray &ray, uint32_t instance) {
  Hit hit;
  if (instance == kNone)
    scene_.accelerator->closest_hit({&ray, 1}, {&hit, 1});
  else
    own_.closest({&ray, 1}, {&instance, 1}, {&hit, 1});
  return hit;
}

std::span<const Hit> SceneNodeRays::all(const Ray &ray, uint32_t instance) {
  own_.all({&ray, 1}, {&instance, 1});
  return own_.hits_of(0);
}

Surface SceneNodeRays::surface(const Ray &ray, const Hit &hit) const {
  return surface_at(scene_.geometry, scene_.slots, ray, hit);
}

} // namespace lancer
