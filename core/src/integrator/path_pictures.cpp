// The environment, where paths end or ask for its light.
#include "integrator/lane_access.h"
#include "integrator/path.h"
#include "lights/sample_light.h"
#include "sampling/color.h"

#include <bit>

namespace lancer {

void PathIntegrator::miss(size_t number, std::span<SampleResult> results) {
  Path &path = paths_[number];
  SampleResult &result = results[path.slot];
  if (path.in_view && !picture_alone_ && !records_[path.slot].seen)
    forget_place(result);
  if (path.scatterings == 0)
    add_sky_features(records_[path.slot].features, result);
  // A transparent film does not show the environment itself, only what it lights.
  if (path.in_view && settings_.film_transparent) {
    result.alpha -= mean(path.beta);
    return;
  }
  if (!(path.kinds & ~scene_.world.hidden_from))
    return;
  const Environment &environment = scene_.lights.environment();
  if (!environment.varies()) {
    add(path, result, path.beta * environment.constant(), true);
    return;
  }
  put(glm::normalize(rays_[number].d), misses_.wi, missed_count_);
  missed_[missed_count_++] = number;
  if (missed_count_ == kBlockLanes)
    add_missed(results);
}

glm::vec3 PathIntegrator::environment_towards(const Path &path, const glm::dvec3 &wi) {
  const glm::dvec3 *eye = path.kinds == LANCER_RAY_CAMERA ? &path.from : nullptr;
  LightPath<float> seen_by = light_path(path, 0.0);
  seen_by.length = std::numeric_limits<float>::max();
  // What lies beyond everything counts as one scattering more, as in Cycles.
  seen_by.depth += 1.0f;
  return scene_.lights.environment().radiance(wi, shader_.values(), &camera_, eye, seen_by);
}

// The environment is sampled as a light, too. pdf: of its sample.
void PathIntegrator::add_environment(const Path &path, double pdf, const glm::vec3 &radiance, SampleResult &result) {
  float weight = 1.0f;
  if (path.pdf > 0.0)
    weight = mis_weight(path.pdf, pdf * scene_.lights.probability(query(path), scene_.lights.environment_light()));
  add(path, result, path.beta * radiance * weight, true);
}

// What waits beside others that have met nothing.
void PathIntegrator::add_missed(std::span<SampleResult> results) {
  if (missed_count_ == 0)
    return;
  picture_lanes_.look_at_sky(misses_, sky_);
  for (uint32_t lane = 0; lane < missed_count_; ++lane) {
    const Path &path = paths_[missed_[lane]];
    const glm::vec3 radiance =
        sky_.image.texels ? get(misses_.radiance, lane) : environment_towards(path, get(misses_.wi, lane));
    add_environment(path, misses_.pdf[lane], radiance, results[path.slot]);
  }
  missed_count_ = 0;
}

// Samples of the environment, for lanes that have chosen it.
void PathIntegrator::ask_sky(uint32_t lanes) {
  if (lanes == 0)
    return;
  picture_lanes_.sample_sky(block_, sky_, lanes);
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    waiting_[lane].far = true;
    if (sky_.image.texels)
      continue;
    const glm::vec3 radiance =
        scene_.lights.environment().radiance(get(block_.light_wi, lane), shader_.values(), &camera_, nullptr);
    put(radiance, block_.light_radiance, lane);
    if (radiance == glm::vec3(0.0f))
      block_.light_pdf[lane] = 0.0;
  }
}

} // namespace lancer
