#include "integrator/stages/shadow.h"

#include "integrator/stages/scatter.h"
#include "integrator/stages/terminator.h"
#include "scene/enums.h"

#include <limits>

namespace lancer {

void write_shadow_ray(const Scene &scene, const SurfaceStage &surfaces, uint32_t lane, const LightSamples &samples,
                      const LitBlock &lit, Ray &ray) {
  const bool far = samples.far >> lane & 1;
  if (lit.lifted >> lane & 1) {
    LightSample sample;
    sample.wi = get(samples.wi, lane);
    sample.target = get(samples.target, lane);
    sample.distance = far ? std::numeric_limits<double>::infinity() : 1.0;
    const LobeBlock &lobes = surfaces.lobes();
    ray = shadow_ray(scene.geometry, surfaces.surface(lane), get(lobes.ns, lane), get(lobes.ng, lane), sample);
    return;
  }
  const glm::dvec3 o = get(lit.origin, lane);
  const float time = surfaces.surfaces().time[lane];
  if (far)
    write_ray(surfaces.hit(lane), o, get(samples.wi, lane), std::numeric_limits<double>::infinity(), RayKind::Shadow, time,
              ray);
  else
    write_ray(surfaces.hit(lane), o, get(samples.target, lane) - o, 1.0, RayKind::Shadow, time, ray);
}

uint64_t ShadowStage::trace_solid() {
  occluded_.assign(rays_.size(), 0);
  scene_.accelerator->any_hit(rays_, occluded_);
  for (size_t i = 0; i < rays_.size(); ++i)
    if (occluded_[i])
      waiting_[i].contribution = glm::vec3(0.0f);
  return rays_.size();
}

uint64_t ShadowStage::trace_clear() {
  crossings_.begin(rays_.size());
  occluded_.assign(rays_.size(), 0);
  scene_.accelerator->any_hit(rays_, occluded_, *this);
  for (size_t i = 0; i < rays_.size(); ++i) {
    glm::vec3 &contribution = waiting_[i].contribution;
    if (occluded_[i])
      contribution = glm::vec3(0.0f);
    else if (crossings_.count(i) > 0)
      // Multiply the transmittances in order of distance, so that the product does not depend on the order of traversal.
      for (const Crossing &crossing : crossings_.dimming_in_order(i))
        contribution *= crossing.transmittance;
  }
  return rays_.size();
}

bool ShadowStage::counts(size_t ray, const Hit &hit) {
  if (waiting_[ray].links.passes(scene_.geometry.instances[hit.instance].blocker_set))
    return false;
  // Instances that only links let light pass ask, too.
  if (!scene_.transparent_instances[hit.instance])
    return true;
  Crossing *known = crossings_.find(ray, hit);
  if (known && known->hit.primitive == hit.primitive)
    return false;
  // No light passes beyond the last crossing.
  if (!known && waiting_[ray].passed + crossings_.count(ray) >= deepest_)
    return true;
  LightPath<float> path = ray < light_paths_.size() ? light_paths_[ray] : shadow_path();
  const double distance = hit.t * glm::length(rays_[ray].d);
  path.length = float(distance / scene_.normalisation.scale);
  path.width += float(distance) * path.spread;
  const glm::vec3 transmittance = shader_.transmittance(rays_[ray], hit, path);
  if (transmittance == glm::vec3(0.0f))
    return true;
  crossings_.put(known, ray, hit, transmittance);
  return false;
}

} // namespace lancer
