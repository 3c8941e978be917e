// The light that paths gather: what they run into, and what they ask for.
#include "integrator/path/path.h"
#include "integrator/stages/lane_access.h"
#include "lights/sample_light.h"
#include "sampling/color.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lancer {

void PathIntegrator::add(const Path &path, SampleResult &result, const glm::vec3 &radiance, bool environment) {
  // Light that was scattered at most once is direct; clamping never touches it.
  const bool indirect = path.scatterings > 1;
  if (passes_.features() && guides_[path.slot].open)
    result.albedo += guides_[path.slot].beta * radiance;
  // What the camera sees through clear glass is in no pass of indirect light: clamp it by itself.
  if (path.in_view) {
    const float top = largest(radiance), limit = settings_.clamp_indirect;
    const glm::vec3 seen = indirect && limit > 0.0f && top > limit ? radiance * (limit / top) : radiance;
    energy_.clip(double(luminance(radiance - seen)));
    result.radiance += seen;
    passes_.add_seen(result, seen, environment);
    return;
  }
  if (indirect)
    indirect_[path.slot] += radiance;
  else
    result.radiance += radiance;
  passes_.add(result, radiance, shares_[path.slot].of, indirect);
}

// Lights stand in no one's way: adds all that the rays pass before they end.
void PathIntegrator::add_lights_met(std::span<SampleResult> results) {
  const LightSet &lights = scene_.lights;
  if (!lights.any_on_the_way())
    return;
  for (size_t first = 0; first < paths_.size(); first += kLightLanes) {
    // Look from the last scattering, as sampling does.
    const uint32_t count = uint32_t(std::min<size_t>(kLightLanes, paths_.size() - first));
    for (uint32_t lane = 0; lane < count; ++lane) {
      const Ray &ray = rays_[first + lane];
      put(paths_[first + lane].from, segments_.from, lane);
      put(ray.d, segments_.d, lane);
      segments_.end[lane] = way_end(first + lane) + lights.most_before();
    }
    for (const uint32_t number : lights.always_on_the_way()) {
      const uint32_t met = lanes_.meets(segments_, lights.lights()[number]) & ((1u << count) - 1u);
      for (uint32_t rest = met; rest != 0; rest &= rest - 1)
        add_light_met(first + size_t(std::countr_zero(rest)), number, results);
    }
    if (lights.finds())
      lights.wide_tree().along(segments_, count,
                               [&](uint32_t lane, uint32_t number) { add_light_met(first + lane, number, results); });
  }
}

double PathIntegrator::way_end(size_t i) const {
  return paths_[i].passed + std::min(hits_[i].t, rays_[i].tmax) * glm::length(rays_[i].d);
}

// One light, if the ray meets it on this stretch of the way.
void PathIntegrator::add_light_met(size_t i, uint32_t number, std::span<SampleResult> results) {
  const Path &path = paths_[i];
  const Ray &ray = rays_[i];
  if (!(path.kinds & ~scene_.lights.hidden_from(number)))
    return;
  const Light &light = scene_.lights.lights()[number];
  const double length = glm::length(ray.d);
  const LightHit met = meet(light, path.from, ray.d / length);
  // A sun lies behind all surfaces, wherever the view ends.
  const double begin = path.passed + ray.tmin * length;
  const bool far = std::isinf(met.distance);
  const bool here = far ? std::isinf(hits_[i].t) : met.distance >= begin && met.distance < way_end(i);
  if (!(met.pdf > 0.0) || !here)
    return;
  const float weight = path.pdf > 0.0 ? mis_weight(path.pdf, met.pdf * scene_.lights.probability(query(path), number)) : 1.0f;
  add(path, results[path.slot], path.beta * met.radiance * weight, false);
}

void PathIntegrator::add_emission(const Path &path, const Surface &surface, const glm::vec3 &emission, SampleResult &result) {
  if (emission == glm::vec3(0.0f))
    return;
  float weight = 1.0f;
  const Emitter *emitter = path.pdf > 0.0 ? scene_.lights.emitter_of(surface.instance) : nullptr;
  if (emitter) {
    const double pdf = emitter->face_pdf(scene_.geometry, path.from, surface);
    weight = mis_weight(path.pdf, pdf * scene_.lights.probability(scene_.geometry, query(path), *emitter, surface.primitive));
  }
  add(path, result, path.beta * emission * weight, false);
}

} // namespace lancer
