#include "integrator/shadow.h"

#include <cmath>
#include <numeric>

namespace lancer {

uint64_t ShadowQueue::trace_solid() {
  occluded_.assign(rays_.size(), 0);
  scene_.accelerator->any_hit(rays_, occluded_);
  for (size_t i = 0; i < rays_.size(); ++i)
    if (occluded_[i])
      contributions_[i] = glm::vec3(0.0f);
  return rays_.size();
}

uint64_t ShadowQueue::trace_layers() {
  uint64_t count = 0;
  waiting_.resize(rays_.size());
  std::iota(waiting_.begin(), waiting_.end(), 0u);
  waiting_rays_ = rays_;
  for (uint32_t layer = 0; !waiting_.empty(); ++layer) {
    // Find the next surface of every ray that is still under way.
    hits_.assign(waiting_.size(), Hit{});
    scene_.accelerator->closest_hit(waiting_rays_, hits_);
    count += waiting_.size();
    size_t kept = 0;
    for (size_t i = 0; i < waiting_.size(); ++i) {
      if (!hits_[i].valid())
        continue;
      // Keep what its opacity lets pass; beyond the last layer nothing does.
      const Surface surface = surface_at(scene_.geometry, scene_.slots, waiting_rays_[i], hits_[i]);
      const float opacity = surface.material == kNone ? 1.0f : evaluate(scene_.materials[surface.material].opacity, surface).x;
      glm::vec3 &contribution = contributions_[waiting_[i]];
      contribution *= layer + 1 < kMaxLayers ? 1.0f - opacity : 0.0f;
      if (contribution == glm::vec3(0.0f))
        continue;
      // Go on to the same end from behind it.
      Ray next = leave(surface, waiting_rays_[i].d, waiting_rays_[i].tmax);
      if (std::isfinite(next.tmax)) {
        next.d = waiting_rays_[i].o + waiting_rays_[i].d * waiting_rays_[i].tmax - next.o;
        next.tmax = 1.0;
      }
      waiting_[kept] = waiting_[i];
      waiting_rays_[kept++] = next;
    }
    waiting_.resize(kept);
    waiting_rays_.resize(kept);
  }
  return count;
}

} // namespace lancer
