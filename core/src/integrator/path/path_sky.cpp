// The environment, where paths end or ask for its light.
#include "integrator/path/path.h"
#include "integrator/stages/lane_access.h"
#include "lights/sample_light.h"
#include "sampling/color.h"

#include <bit>

namespace lancer {

void PathIntegrator::miss(size_t number, std::span<SampleResult> results) {
  Path &path = paths_[number];
  SampleResult &result = results[path.slot];
  if (path.in_view && !only_combined_ && !records_[path.slot].seen)
    forget_place(result);
  if (path.scatterings == 0 && passes_.features())
    add_sky_guides(guides_[path.slot], result);
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

// What the nodes of the world say in these directions, for those paths that world_nodes_ has already been told of.
void PathIntegrator::ask_world(const VertexBlock::Doubles (&wi)[3], uint32_t lanes) {
  world_nodes_.used = lanes;
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      // The surface of the world looks back at the viewer.
      const float back = float(-wi[axis][lane]);
      world_nodes_.p[axis][lane] = -double(back);
      world_nodes_.wo[axis][lane] = world_nodes_.ns[axis][lane] = world_nodes_.ng[axis][lane] = back;
    }
  node_kernel().run(scene_.world.program, scene_.world.schedule, world_nodes_, world_values_.data());
}

glm::vec3 PathIntegrator::sky_in_lane(uint32_t lane) const {
  const auto &value = world_values_[size_t(scene_.world.radiance.node)].of;
  return {value[0][lane], value[1][lane], value[2][lane]};
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
  const bool is_light = scene_.lights.environment().is_light();
  if (is_light)
    light_kernel().sky_density(sky_, misses_);
  for (uint32_t lane = 0; lane < missed_count_; ++lane) {
    const Path &path = paths_[missed_[lane]];
    world_nodes_.eye[lane] = path.kinds == LANCER_RAY_CAMERA ? &path.from : nullptr;
    LightPath<float> seen_by = light_path(path, 0.0);
    seen_by.length = std::numeric_limits<float>::max();
    // What lies beyond everything counts as one scattering more, as in Cycles.
    seen_by.depth += 1.0f;
    put(seen_by, world_nodes_, lane);
  }
  ask_world(misses_.wi, (1u << missed_count_) - 1u);
  for (uint32_t lane = 0; lane < missed_count_; ++lane) {
    const Path &path = paths_[missed_[lane]];
    const glm::vec3 radiance = sky_in_lane(lane);
    if (is_light)
      add_environment(path, misses_.pdf[lane], radiance, results[path.slot]);
    else
      add(path, results[path.slot], path.beta * radiance, true);
  }
  missed_count_ = 0;
}

// Samples of the environment, for lanes that have chosen it.
void PathIntegrator::ask_sky(uint32_t lanes) {
  if (lanes == 0)
    return;
  for (int i = 0; i < 2; ++i)
    std::copy_n(block_.u[kVertexLight + i], kBlockLanes, sky_samples_.u[i]);
  light_kernel().sample_sky(sky_, sky_samples_);
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const Path &path = paths_[waiting_[lane].number];
    world_nodes_.eye[lane] = nullptr;
    LightPath<float> asked_by = asking_path(path);
    asked_by.length = std::numeric_limits<float>::max();
    put(asked_by, world_nodes_, lane);
  }
  ask_world(sky_samples_.wi, lanes);
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    waiting_[lane].far = true;
    const glm::vec3 radiance = sky_in_lane(lane);
    put(get(sky_samples_.wi, lane), block_.light_wi, lane);
    put(radiance, block_.light_radiance, lane);
    block_.light_pdf[lane] *= radiance == glm::vec3(0.0f) ? 0.0 : sky_samples_.pdf[lane];
  }
}

} // namespace lancer
