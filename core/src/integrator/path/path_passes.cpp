// What passes beside the picture ask of a path: the surfaces that the camera sees, and ambient occlusion.
#include "integrator/path/path.h"
#include "integrator/stages/lane_access.h"
#include "lancer.h"
#include "sampling/color.h"

#include <bit>

namespace lancer {

// What passes say of the surfaces that the camera sees.
void PathIntegrator::record_surfaces(std::span<SampleResult> results) {
  uint32_t seen = 0, featured = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    if (waiting_[lane].nothing)
      continue;
    seen |= uint32_t(path.in_view) << lane;
    featured |= uint32_t(passes_.features() && guides_[path.slot].open) << lane;
  }
  if (!(seen | featured))
    return;
  surfaces_.describe();
  for (uint32_t rest = seen | featured; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const Waiting &waiting = waiting_[lane];
    const Path &path = paths_[waiting.number];
    const Hit &hit = hits_[waiting.number];
    SampleResult &result = results[path.slot];
    if (seen >> lane & 1) {
      block_.occlusion_asked |= uint32_t(passes_.occlusion() && !waiting.ends && path.scatterings == 0) << lane;
      // Mostly its place is enough.
      Surface surface;
      if (path.sampler.sample() == 0 || passes_.uv())
        surface = surfaces_.surface(lane);
      else
        surface.p = get(block_.p, lane);
      record(path, surface, *block_.material[lane], get(block_.normal, lane), surfaces_.opacity(lane), hit.t, result);
      for (uint32_t component = 0; component < 3 && passes_.components(); ++component)
        result.light[kLightComponents + 3 * component + 2] += path.beta * get(block_.shown[component], lane);
    }
    if (featured >> lane & 1)
      waiting_[lane].mixture = surfaces_.mixture(lane);
  }
}

// Fills the passes that describe what the camera sees.
void PathIntegrator::record(const Path &path, const Surface &surface, const Material &material, const glm::vec3 &normal,
                            const glm::vec3 &opacity, double t, SampleResult &result) {
  // A surface that is hardly there gives way to the next one, unless the path ends on it.
  Record &record = records_[path.slot];
  const bool here = !record.seen && mean(opacity) >= settings_.alpha_threshold;
  // The first sample of a pixel tells the place.
  if (!record.seen && path.sampler.sample() == 0)
    record_place(scene_, surface, &material, record.depth + t, result);
  if (here)
    record_first_surface(scene_, settings_, surface, normal, result);
  record.seen |= here;
  if (passes_.mist())
    result.mist += (1.0f - mist_at(scene_, camera_, settings_, surface)) * mean(path.beta * opacity);
}

// Looks for what is in the way around the normal of what is diffuse, with the weight of a cosine.
void PathIntegrator::look_around(uint32_t lane, SampleResult &result) {
  const Path &path = paths_[waiting_[lane].number];
  const glm::vec3 weight = path.beta * surfaces_.opacity(lane);
  if (block_.looks_itself >> lane & 1)
    send_occlusion_ray(lane, get(block_.occlusion_wi, lane), weight);
  else
    result.light[kLightOcclusion] += weight;
  if (!(block_.looks_by_next >> lane & 1))
    return;
  const float occlusion = block_.occlusion_weight[lane];
  if (block_.sampled >> lane & 1) {
    records_[path.slot].occlusion = occlusion;
  } else {
    // A direction that brings no light gets a ray all the same.
    result.light[kLightOcclusion] -= occlusion;
    send_occlusion_ray(lane, get(block_.wi, lane), glm::vec3(occlusion));
  }
}

void PathIntegrator::send_occlusion_ray(uint32_t lane, const glm::vec3 &wi, const glm::vec3 &weight) {
  const Path &path = paths_[waiting_[lane].number];
  Ray ray = leave(surfaces_.surface(lane), glm::dvec3(wi), occlusion_reach_);
  ray.kinds = LANCER_RAY_SHADOW;
  shadows_.push(ray, {.slot = path.slot, .occlusion = true}, weight, path.passed_through);
  if (shadows_.asks_light_path())
    shadows_.set_light_path(asking_path(path));
}

// What the next rays of the first surfaces have met.
void PathIntegrator::count_occluded(std::span<SampleResult> results) {
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (paths_[i].scatterings != 1)
      continue;
    float &occlusion = records_[paths_[i].slot].occlusion;
    if (occlusion > 0.0f && hits_[i].valid() && hits_[i].t * glm::length(rays_[i].d) < occlusion_reach_)
      results[paths_[i].slot].light[kLightOcclusion] -= occlusion;
    occlusion = 0.0f;
  }
}

} // namespace lancer
