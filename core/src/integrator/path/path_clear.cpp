// Finding the next hits: one traversal passes all surfaces that an image has cut away.
#include "integrator/path/path.h"

namespace lancer {

void PathIntegrator::find_hits() {
  hits_.resize(rays_.size());
  if (!any_clear_)
    return scene_.accelerator->closest_hit(rays_, hits_);
  clear_.begin(rays_.size());
  const auto ask = [](void *paths, size_t ray, const Hit &hit) {
    return static_cast<PathIntegrator *>(paths)->is_there(ray, hit);
  };
  scene_.accelerator->closest_hit(rays_, hits_, {scene_.perforated_instances.data(), ask, this});
  for (size_t i = 0; i < rays_.size(); ++i)
    if (clear_.count(i) > 0)
      pass_clear(i);
}

// Whether a surface is present at a hit. At an absent surface, shading would continue the path straight through with weight 1
// and sample no light.
bool PathIntegrator::is_there(size_t ray, const Hit &hit) {
  const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (!scene_.cutouts[material].may_end)
    return true;
  Crossing *known = clear_.find(ray, hit);
  if (known && known->hit.primitive == hit.primitive)
    return false;
  // Surfaces behind as many layers as the path may still pass are out of reach.
  const Path &path = paths_[ray];
  if (!known && clear_.count_before(ray, hit) >= path.crossings_left(settings_.transparent_bounces))
    return true;
  if (shader_.is_there(material, hit))
    return true;
  clear_.put(known, ray, hit, glm::vec3(1.0f));
  return false;
}

// Counts the layers before a path's hit, as if the path had passed them one by one.
void PathIntegrator::pass_clear(size_t number) {
  Path &path = paths_[number];
  const Ray &ray = rays_[number];
  const Hit end = hits_[number];
  // In most cases, the number of layers suffices.
  const uint32_t count = clear_.count_before(number, end);
  if (count == 0)
    return;
  const uint32_t limit = settings_.transparent_bounces;
  if (film_.only_combined() && !trace_ && count <= path.crossings_left(limit))
    return path.count_crossings(count, limit);
  for (const Crossing &layer : clear_.in_order(number)) {
    const Hit &hit = layer.hit;
    if (!closer(hit.t, hit.instance, hit.primitive, end))
      return;
    // The path has reached its limit of passed surfaces: it ends here.
    if (path.crossings_left(limit) == 0) {
      hits_[number] = hit;
      return;
    }
    // Passes may also record a surface of low opacity.
    const bool recorded = film_.awaits_surface(path);
    if (recorded || trace_) {
      const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
      if (trace_)
        keep_vertex(path, surface, hit.t);
      if (recorded) {
        shader_.shade(surface, view_of(path, ray, hit.t), clear_point_);
        film_.record(path, surface, queues_.material(hit), clear_point_.bsdf.ns, clear_point_.opacity(), hit.t);
      }
    }
    path.count_crossings(1, limit);
  }
}

} // namespace lancer
