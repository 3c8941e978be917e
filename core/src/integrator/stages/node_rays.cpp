#include "integrator/stages/node_rays.h"

#include <algorithm>
#include <utility>

namespace lancer {

SceneNodeRays::SceneNodeRays(const Scene &scene)
    : HitFilter(nullptr), scene_(scene), alone_(scene.accelerator->without_order()),
      asked_(scene.geometry.instances.size(), 1) {
  instances = asked_.data();
}

uint32_t SceneNodeRays::open(std::span<const Ray> rays, uint32_t instance) {
  uint8_t occluded[kMost] = {};
  const std::span<uint8_t> answers(occluded, rays.size());
  instance_ = instance;
  if (instance == kNone)
    scene_.accelerator->any_hit(rays, answers);
  else
    alone_.any_hit(rays, answers, *this);
  return uint32_t(std::ranges::count(answers, 0));
}

Hit SceneNodeRays::closest(const Ray &ray, uint32_t instance) {
  Hit hit;
  if (instance == kNone) {
    scene_.accelerator->closest_hit({&ray, 1}, {&hit, 1});
    return hit;
  }
  instance_ = instance;
  alone_.closest_hit({&ray, 1}, {&hit, 1}, *this);
  return hit;
}

std::span<const Hit> SceneNodeRays::all(const Ray &ray, uint32_t instance) {
  hits_.clear();
  instance_ = instance;
  uint8_t occluded = 0;
  collects_ = true;
  alone_.any_hit({&ray, 1}, {&occluded, 1}, *this);
  collects_ = false;
  // A filter may be asked about a hit twice, and in any order.
  std::ranges::sort(hits_, {}, [](const Hit &hit) { return std::pair(hit.primitive, hit.t); });
  const auto again = std::ranges::unique(hits_, {}, [](const Hit &hit) { return std::pair(hit.primitive, hit.t); });
  hits_.erase(again.begin(), again.end());
  return hits_;
}

Surface SceneNodeRays::surface(const Ray &ray, const Hit &hit) const {
  return surface_at(scene_.geometry, scene_.slots, ray, hit);
}

bool SceneNodeRays::counts(size_t, const Hit &hit) {
  if (hit.instance != instance_)
    return false;
  if (!collects_)
    return true;
  hits_.push_back(hit);
  return false;
}

} // namespace lancer
