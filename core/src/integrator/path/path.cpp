#include "integrator/path/path.h"

#include "integrator/stages/lane_access.h"
#include "sampling/color.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Roulette starts after the bounces that carry most of the light.
constexpr uint32_t kRouletteAfter = 2;

} // namespace

void PathIntegrator::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                         std::vector<PathVertex> *trace) {
  trace_ = trace;
  // Start one path per sample.
  generate(addresses, results);
  const auto gathered = [&](uint32_t slot) { return film_.gathered(slot); };
  for (uint32_t turn = 0; !paths_.empty() && !settings_.cancelled(); ++turn) {
    // Find the next hit of every path.
    find_hits();
    // Add emission, sample a light, sample the next direction of each path.
    shade();
    if (last_bounces_.due(turn))
      last_bounces_.note(
          turn, paths_.size(), settings_.splits.paths > 1, [&](size_t i) { return paths_[i].slot; }, gathered);
    // Add the light of the samples that are not occluded.
    counts_.shadow +=
        shadows_.trace([&](const WaitingLight &waiting, const glm::vec3 &light) { film_.add_lit(waiting, light); });
    counts_.bounce += next_rays_.size();
    paths_.swap(next_paths_);
    rays_.swap(next_rays_);
  }
  last_bounces_.end(gathered, film_.energy);
  film_.end();
  energy_ = film_.energy;
}

void PathIntegrator::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  paths_.clear();
  rays_.clear();
  film_.begin(addresses, results);
  last_bounces_.begin();
  generator_.start(addresses, passes_.wanted(), results, [&](uint32_t slot, const Sampler &sampler) -> Ray & {
    paths_.emplace_back(sampler, slot);
    return rays_.emplace_back();
  });
  for (size_t i = 0; i < paths_.size(); ++i)
    paths_[i].from = rays_[i].o;
  counts_.camera += paths_.size();
}

void PathIntegrator::shade() {
  next_paths_.clear();
  next_rays_.clear();
  add_lights_met();
  if (passes_.occlusion())
    count_occluded();
  queues_.begin();
  for (size_t i = 0; i < paths_.size(); ++i)
    if (hits_[i].valid())
      queues_.add(i, hits_[i]);
    else
      miss(i);
  add_missed();
  vertices_.wide += queues_.size();
  queues_.each([&](std::span<const ShadingQueues::Met> met) {
    for (size_t i = 0; i < met.size(); ++i) {
      if (i + 1 < met.size())
        textures_.ahead(hits_[met[i + 1].number]);
      put_in_lane(met[i].number, *met[i].material);
      if (surfaces_.full())
        shade_block();
    }
    shade_block();
  });
}

// Returns the view of a path's hit at t.
View PathIntegrator::view_of(const Path &path, const Ray &ray, double t) const {
  const double unit = glm::length(ray.d), way = path.length + t * unit;
  return {.wo = glm::vec3(-glm::normalize(ray.d)),
          .footprint = float(cone_.base + way * cone_.spread),
          .path = path.light_path((t - ray.tmin) * unit / scene_.normalisation.scale)};
}

void PathIntegrator::keep_vertex(const Path &path, const Surface &surface, double t) {
  trace_->push_back({scene_.normalisation.to_world(surface.p), t / scene_.normalisation.scale, surface.ns, path.beta,
                     film_.gathered(path), surface.instance, surface.primitive, surface.material, path.scatterings});
}

// Continues a path straight through a surface, unless the path has reached its limit of passed surfaces.
void PathIntegrator::pass_straight_on(Path &path, const Surface &surface, const Ray &ray, double t, const glm::vec3 &weight) {
  if (path.crossings_left(settings_.transparent_bounces) == 0)
    return;
  const double length = t * glm::length(ray.d);
  path.beta *= weight;
  path.passed += length;
  path.length += length;
  film_.pass_on(path, t);
  path.count_crossings(1, settings_.transparent_bounces);
  next_rays_.push_back(leave(surface, ray.d, ray.tmax - t));
  next_rays_.back().kinds = path.kinds;
  next_paths_.push_back(path);
}

bool PathIntegrator::survives(uint32_t scatterings, float u, float sharers, glm::vec3 &beta) {
  if (scatterings <= kRouletteAfter)
    return true;
  // Russian roulette: end dim paths early and divide the survivors' throughput by their probability of survival. With the
  // square root of beta instead of beta, paths survive longer: variance times rays falls by a twentieth on average over five
  // scenes.
  const float q = std::min(1.0f, std::sqrt(sharers * largest(beta)));
  if (u >= q)
    return false;
  beta /= q;
  return true;
}

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  return std::make_unique<PathIntegrator>(scene, camera, settings);
}

} // namespace lancer
