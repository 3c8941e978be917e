#include "integrator/stages/own_hits.h"

#include <algorithm>

namespace lancer {

OwnHits::OwnHits(const Scene &scene)
    : HitFilter(nullptr), alone_(scene.accelerator->without_order()), asked_(scene.geometry.instances.size(), 1) {
  instances = asked_.data();
}

void OwnHits::closest(std::span<const Ray> rays, std::span<const uint32_t> of, std::span<Hit> hits) {
  instance_of_ = of;
  alone_.closest_hit(rays, hits, *this);
}

void OwnHits::any(std::span<const Ray> rays, std::span<const uint32_t> of, std::span<uint8_t> occluded) {
  instance_of_ = of;
  alone_.any_hit(rays, occluded, *this);
}

void OwnHits::all(std::span<const Ray> rays, std::span<const uint32_t> of) {
  found_.clear();
  occluded_.assign(rays.size(), 0);
  collects_ = true;
  any(rays, of, occluded_);
  collects_ = false;
  // Order the hits: a filter may be asked about a hit twice, and in any order.
  std::ranges::sort(found_, [](const Found &a, const Found &b) {
    return a.ray != b.ray ? a.ray < b.ray : closer(a.hit.t, a.hit.instance, a.hit.primitive, b.hit);
  });
  hits_.clear();
  first_.clear();
  for (size_t ray = 0, next = 0; ray < rays.size(); ++ray) {
    first_.push_back(hits_.size());
    for (; next < found_.size() && found_[next].ray == ray; ++next)
      if (hits_.size() == first_.back() || hits_.back().t != found_[next].hit.t)
        hits_.push_back(found_[next].hit);
  }
  first_.push_back(hits_.size());
}

bool OwnHits::counts(size_t ray, const Hit &hit) {
  if (hit.instance != instance_of_[ray])
    return false;
  if (!collects_)
    return true;
  found_.push_back({ray, hit});
  return false;
}

} // namespace lancer
