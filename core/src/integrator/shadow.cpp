#include "integrator/shadow.h"

#include <cmath>
#include <numeric>

namespace lancer {

uint64_t ShadowQueue::trace_solid() {
  occluded_.assign(rays_.size(), 0);
  scene_.accelerator->any_hit(rays_, occluded_);
  for (size_t i = 0; i < rays_.size(); ++i)
    if (occluded_[i])
      waiting_[i].contribution = glm::vec3(0.0f);
  return rays_.size();
}

uint64_t ShadowQueue::trace_layers() {
  uint64_t count = 0;
  under_way_.resize(rays_.size());
  std::iota(under_way_.begin(), under_way_.end(), 0u);
  under_way_rays_ = rays_;
  while (!under_way_.empty()) {
    // Find the next surface of every ray that is still under way.
    hits_.assign(under_way_.size(), Hit{});
    scene_.accelerator->closest_hit(under_way_rays_, hits_);
    count += under_way_.size();
    size_t kept = 0;
    for (size_t i = 0; i < under_way_.size(); ++i) {
      if (!hits_[i].valid())
        continue;
      // Keep what the surface lets pass; beyond the last one nothing does.
      const uint32_t number = under_way_[i];
      const Ray &ray = under_way_rays_[i];
      const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hits_[i]);
      glm::vec3 &contribution = waiting_[number].contribution;
      if (waiting_[number].passed++ >= deepest_)
        contribution = glm::vec3(0.0f);
      else
        contribution *= shader_.transmittance(surface, glm::vec3(-glm::normalize(ray.d)));
      if (contribution == glm::vec3(0.0f))
        continue;
      // Go on to the same end from behind it.
      Ray next = leave(surface, ray.d, ray.tmax);
      if (std::isfinite(next.tmax)) {
        next.d = ray.o + ray.d * ray.tmax - next.o;
        next.tmax = 1.0;
      }
      next.kinds = ray.kinds;
      under_way_[kept] = number;
      under_way_rays_[kept++] = next;
    }
    under_way_.resize(kept);
    under_way_rays_.resize(kept);
  }
  return count;
}

} // namespace lancer
