// The light that paths find: lights hit by rays, and lights sampled at vertices.
#include "integrator/path/path.h"
#include "integrator/stages/lane_access.h"
#include "integrator/stages/terminator.h"
#include "sampling/color.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lancer {

// Lights occlude nothing: adds all lights that the rays pass before they end.
void PathIntegrator::add_lights_met() {
  const LightSet &lights = scene_.lights;
  if (!lights.any_on_the_way())
    return;
  for (size_t first = 0; first < paths_.size(); first += kLightLanes) {
    // Evaluate from the last scattering, as sampling does.
    const uint32_t count = uint32_t(std::min<size_t>(kLightLanes, paths_.size() - first));
    for (uint32_t lane = 0; lane < count; ++lane) {
      const Ray &ray = rays_[first + lane];
      put(paths_[first + lane].from, segments_.from, lane);
      put(ray.d, segments_.d, lane);
      segments_.end[lane] = way_end(first + lane) + lights.most_before();
      put(paths_[first + lane].normal, segments_.normal, lane);
      segments_.transmits = (segments_.transmits & ~(1u << lane)) | uint32_t{paths_[first + lane].transmits} << lane;
    }
    for (const uint32_t number : lights.always_on_the_way()) {
      const uint32_t met = lanes_.meets(segments_, lights.lights()[number]) & ((1u << count) - 1u);
      if (met != 0)
        add_met(first, met, number);
    }
    if (lights.finds())
      lights.wide_tree().along(segments_, count, [&](uint32_t lane, uint32_t number) { add_light_met(first + lane, number); });
  }
}

double PathIntegrator::way_end(size_t i) const {
  return paths_[i].passed + std::min(hits_[i].t, rays_[i].tmax) * glm::length(rays_[i].d);
}

// Adds one light for the lanes that hit it.
void PathIntegrator::add_met(size_t first, uint32_t met, uint32_t number) {
  const BinaryLightTree &few = scene_.lights.binary_tree();
  const uint32_t place = few.place_of(number);
  if (place != kNone)
    lanes_.meet(segments_, scene_.lights.lights()[number], few.nodes(), place, met_light_);
  for (uint32_t rest = met; rest != 0; rest &= rest - 1) {
    const auto lane = uint32_t(std::countr_zero(rest));
    if (place == kNone)
      // A light that is not in the binary tree is in the tree of many lights.
      add_light_met(first + lane, number);
    else
      add_light_met(first + lane, number, {get(met_light_.radiance, lane), met_light_.pdf[lane], met_light_.distance[lane]},
                    [&] { return met_light_.chosen[lane]; });
  }
}

void PathIntegrator::add_light_met(size_t i, uint32_t number) {
  const Path &path = paths_[i];
  const Ray &ray = rays_[i];
  add_light_met(i, number, meet(scene_.lights.lights()[number], path.from, ray.d / glm::length(ray.d)),
                [&] { return scene_.lights.probability(path.light_query(), number); });
}

// Adds one light if the ray hits it on this segment. chosen(): returns the probability with which sampling chooses the light.
template <class Chosen>
void PathIntegrator::add_light_met(size_t i, uint32_t number, const LightHit &met, const Chosen &chosen) {
  const Path &path = paths_[i];
  const Ray &ray = rays_[i];
  if (!(met.pdf > 0.0) || !path.shows_light(scene_.lights.hidden_from(number)))
    return;
  // A sun lies behind all surfaces, beyond the clip end.
  const double begin = path.passed + ray.tmin * glm::length(ray.d);
  const bool far = std::isinf(met.distance);
  if (far ? !std::isinf(hits_[i].t) : !(met.distance >= begin && met.distance < way_end(i)))
    return;
  const float weight = path.pdf > 0.0 ? mis_weight(path.pdf, met.pdf * chosen()) : 1.0f;
  film_.add(path, path.beta * met.radiance * weight, false);
}

void PathIntegrator::add_emission(const Path &path, const Surface &surface, const glm::vec3 &emission) {
  if (emission == glm::vec3(0.0f))
    return;
  float weight = 1.0f;
  const Emitter *emitter = path.pdf > 0.0 ? scene_.lights.emitter_of(surface.instance) : nullptr;
  if (emitter) {
    const double pdf = emitter->face_pdf(scene_.geometry, path.from, surface);
    weight =
        mis_weight(path.pdf, pdf * scene_.lights.probability(scene_.geometry, path.light_query(), *emitter, surface.primitive));
  }
  film_.add(path, path.beta * emission * weight, false);
}

void PathIntegrator::miss(size_t number) {
  Path &path = paths_[number];
  film_.miss(path);
  // A transparent film does not show the environment itself, only the light that it gives. The environment's pass shows both.
  if (path.in_view && settings_.film_transparent) {
    film_.cut(path, mean(path.beta));
    if (!(settings_.passes & 1u << LANCER_PASS_ENVIRONMENT))
      return;
  }
  if (!path.shows_light(scene_.world.hidden_from))
    return;
  const Environment &environment = scene_.lights.environment();
  if (!environment.varies())
    return film_.add(path, path.beta * environment.constant(), true);
  lights_.add_miss(missed_count_, rays_[number].d, path.light_path(0.0),
                   path.kinds == LANCER_RAY_CAMERA ? &path.from : nullptr);
  missed_[missed_count_++] = number;
  if (missed_count_ == kBlockLanes)
    add_missed();
}

// Adds the environment for the waiting paths that hit nothing.
void PathIntegrator::add_missed() {
  if (missed_count_ == 0)
    return;
  const LightSet &lights = scene_.lights;
  lights_.look_at_sky(missed_count_);
  for (uint32_t lane = 0; lane < missed_count_; ++lane) {
    const Path &path = paths_[missed_[lane]];
    // The environment is sampled as a light, too.
    float weight = 1.0f;
    if (lights.environment().is_light() && path.pdf > 0.0) {
      const double chosen = lights.probability(path.light_query(), lights.environment_light());
      weight = mis_weight(path.pdf, lights_.sky_pdf(lane, path.transmits) * chosen);
    }
    film_.add(path, path.beta * lights_.sky_radiance(lane) * weight, true);
  }
  missed_count_ = 0;
}

// Queues a lane's light sample with its shadow ray.
void PathIntegrator::send_shadow_of(uint32_t lane) {
  const Path &path = paths_[waiting_[lane].number];
  const glm::vec3 contribution = get(block_.contribution, lane);
  WaitingLight shares;
  for (int component = 0; component < 2 && passes_.components(); ++component)
    shares.share[component] = path.in_view ? get(block_.light_share[component], lane) : film_.shares(path)[component];
  if (scene_.lights.no_shadow(lights_.light(lane))) {
    shares.slot = path.slot;
    shares.place = film_.place_of(path);
    shares.indirect = path.scatterings > 0;
    return shadows_.push_lit(shares, contribution);
  }
  Ray &ray = shadows_.push(path.slot, film_.place_of(path), contribution, path.scatterings > 0, path.passed_through);
  if (passes_.components())
    shadows_.set_shares(shares.share);
  if (shadows_.asks_light_path())
    shadows_.set_light_path(path.asking_path());
  lights_.write_shadow_ray(lane, ray);
}

// Cycles' passes count the whole surface of a holdout object, whatever its opacity.
glm::vec3 PathIntegrator::recorded_opacity(uint32_t lane) const {
  return block_.holes >> lane & 1 ? glm::vec3(1.0f) : surfaces_.opacity(lane);
}

// Samples ambient occlusion by the cosine around the mean normal of the diffuse lobes.
void PathIntegrator::look_around(uint32_t lane) {
  const Path &path = paths_[waiting_[lane].number];
  const glm::vec3 weight = path.beta * recorded_opacity(lane);
  if (block_.looks_itself >> lane & 1)
    send_occlusion_ray(lane, get(block_.occlusion_wi, lane), weight);
  else
    film_.add_open(path, weight);
  if (!(block_.looks_by_next >> lane & 1))
    return;
  const float occlusion = block_.occlusion_weight[lane];
  const glm::dvec3 lift = terminator_offset(scene_.geometry, surfaces_.surface(lane), get(block_.viewer_ns, lane),
                                            get(block_.viewer_ng, lane), get(block_.wi, lane));
  if (block_.sampled >> lane & 1 && lift == glm::dvec3(0.0)) {
    film_.keep_occlusion(path, occlusion);
  } else {
    // A next ray without weight is not traced, and a next ray near the terminator starts elsewhere. Both need an occlusion ray.
    film_.add_open(path, -glm::vec3(occlusion));
    send_occlusion_ray(lane, get(block_.wi, lane), glm::vec3(occlusion));
  }
}

void PathIntegrator::send_occlusion_ray(uint32_t lane, const glm::vec3 &wi, const glm::vec3 &weight) {
  const Path &path = paths_[waiting_[lane].number];
  LightSample around;
  around.wi = glm::dvec3(wi);
  around.distance = std::numeric_limits<double>::infinity();
  // Like a shadow ray, the occlusion ray starts on the curved surface of a smooth mesh.
  Ray ray =
      shadow_ray(scene_.geometry, surfaces_.surface(lane), get(block_.viewer_ns, lane), get(block_.viewer_ng, lane), around);
  ray.tmax = occlusion_reach_;
  shadows_.push(ray, {.slot = path.slot, .occlusion = true}, weight, path.passed_through);
  if (shadows_.asks_light_path())
    shadows_.set_light_path(path.asking_path());
}

// Subtracts the weight of each occluded next ray from the ambient occlusion of its first surface.
void PathIntegrator::count_occluded() {
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (paths_[i].scatterings != 1 || !paths_[i].leads)
      continue;
    const float occlusion = film_.take_occlusion(paths_[i]);
    if (occlusion > 0.0f && hits_[i].valid() && hits_[i].t * glm::length(rays_[i].d) < occlusion_reach_)
      film_.add_open(paths_[i], -glm::vec3(occlusion));
  }
}

} // namespace lancer
