#include "integrator/stages/shadow.h"

namespace lancer {

uint64_t ShadowQueue::trace_solid() {
  occluded_.assign(rays_.size(), 0);
  scene_.accelerator->any_hit(rays_, occluded_);
  for (size_t i = 0; i < rays_.size(); ++i)
    if (occluded_[i])
      waiting_[i].contribution = glm::vec3(0.0f);
  return rays_.size();
}

uint64_t ShadowQueue::trace_clear() {
  crossings_.begin(rays_.size());
  occluded_.assign(rays_.size(), 0);
  const HitFilter filter{
      scene_.transparent_instances.data(),
      [](void *queue, size_t ray, const Hit &hit) { return static_cast<ShadowQueue *>(queue)->stops(ray, hit); }, this};
  scene_.accelerator->any_hit(rays_, occluded_, filter);
  for (size_t i = 0; i < rays_.size(); ++i) {
    glm::vec3 &contribution = waiting_[i].contribution;
    if (occluded_[i])
      contribution = glm::vec3(0.0f);
    else if (crossings_.count(i) > 0)
      // Multiply the transmittances in order of distance, so that the product does not depend on the order of traversal.
      for (const Crossing &layer : crossings_.dimming_in_order(i))
        contribution *= layer.transmittance;
  }
  return rays_.size();
}

bool ShadowQueue::stops(size_t ray, const Hit &hit) {
  Crossing *known = crossings_.find(ray, hit);
  if (known && known->hit.primitive == hit.primitive)
    return false;
  // No light passes beyond the last layer.
  if (!known && waiting_[ray].passed + crossings_.count(ray) >= deepest_)
    return true;
  LightPath<float> path = ray < light_paths_.size() ? light_paths_[ray] : shadow_path();
  path.length = float(hit.t * glm::length(rays_[ray].d) / scene_.normalisation.scale);
  const glm::vec3 transmittance = shader_.transmittance(rays_[ray], hit, path);
  if (transmittance == glm::vec3(0.0f))
    return true;
  crossings_.put(known, ray, hit, transmittance);
  return false;
}

} // namespace lancer
