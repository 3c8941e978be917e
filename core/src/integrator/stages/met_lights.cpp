#include "integrator/stages/met_lights.h"

#include "lights/sample_light.h"

#include <algorithm>
#include <cmath>

namespace lancer {

void MetLights::find(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const Scattering> from) {
  const LightSet &lights = scene_.lights;
  met_.clear();
  if (!lights.any_on_the_way())
    return;
  rays_ = rays;
  hits_ = hits;
  from_ = from;
  for (first_ = 0; first_ < rays.size(); first_ += kBlockLanes) {
    // Evaluate from the last scattering, as sampling does.
    const uint32_t count = uint32_t(std::min<size_t>(kBlockLanes, rays.size() - first_));
    segments_.transmits = 0;
    for (uint32_t lane = 0; lane < count; ++lane) {
      const Scattering &last = from[first_ + lane];
      put(last.p, segments_.from, lane);
      put(rays[first_ + lane].d, segments_.d, lane);
      segments_.end[lane] = end_of(first_ + lane) + lights.most_before();
      put(last.n, segments_.normal, lane);
      segments_.transmits |= uint32_t{last.transmits} << lane;
    }
    for (const uint32_t light : lights.always_on_the_way()) {
      const uint32_t met = kernel_.meets(segments_, lights.lamps()[light]) & ((1u << count) - 1u);
      if (met != 0)
        meet_lamp(met, light);
    }
    if (lights.finds())
      lights.wide_tree().along(segments_, count, *this);
  }
}

// Meets one lamp in the lanes that may hit it.
void MetLights::meet_lamp(uint32_t lanes, uint32_t light) {
  const BinaryLightTree &few = scene_.lights.binary_tree();
  const uint32_t place = few.place_of(light);
  // A light that is not in the binary tree is in the tree of many lights. Linked lights are in trees by the set of receivers.
  if (place == kNone || scene_.lights.linked())
    return each_lane(lanes, [&](uint32_t lane) { meet_alone(first_ + lane, light); });
  kernel_.meet(segments_, scene_.lights.lamps()[light], few.nodes(), place, block_);
  each_lane(lanes, [&](uint32_t lane) {
    const LightHit hit{get(block_.radiance, lane), block_.pdf[lane], block_.distance[lane]};
    if (is_on_segment(first_ + lane, hit))
      add(first_ + lane, light, hit, block_.chosen[lane]);
  });
}

void MetLights::meet_alone(size_t ray, uint32_t light) {
  const glm::dvec3 &d = rays_[ray].d;
  const LightHit hit = meet(scene_.lights.lamps()[light], from_[ray].p, d / glm::length(d));
  if (is_on_segment(ray, hit))
    add(ray, light, hit, from_[ray].pdf > 0.0 ? scene_.lights.probability(from_[ray].query(), light) : 1.0);
}

// Whether a ray hits a light before the ray ends.
bool MetLights::is_on_segment(size_t ray, const LightHit &hit) const {
  if (!(hit.pdf > 0.0))
    return false;
  // A sun lies behind all surfaces, beyond the clip end.
  if (std::isinf(hit.distance))
    return std::isinf(hits_[ray].t);
  return hit.distance >= from_[ray].passed + rays_[ray].tmin * glm::length(rays_[ray].d) && hit.distance < end_of(ray);
}

// chosen: the probability with which sampling chooses the light.
void MetLights::add(size_t ray, uint32_t light, const LightHit &hit, double chosen) {
  if (!from_[ray].meets(scene_.lights.links(light)))
    return;
  const double pdf = from_[ray].pdf;
  met_.push_back({ray, light, hit.radiance, pdf > 0.0 ? mis_weight(pdf, hit.pdf * chosen) : 1.0f, hit.distance});
}

float emitter_weight(const Scene &scene, const Scattering &from, const Emitter &emitter, const Surface &surface) {
  if (!(from.pdf > 0.0))
    return 1.0f;
  const double pdf = emitter.face_pdf(scene.geometry, from.p, surface);
  return mis_weight(from.pdf,
                    pdf * scene.lights.probability(scene.geometry, from.query(), emitter, surface.time, surface.primitive));
}

float MetLights::emission_weight(const Scattering &from, const Surface &surface) const {
  const Emitter *emitter = scene_.lights.emitter_of(surface.instance);
  // An object that is not sampled as a light has links, too; its light passes no blockers.
  if (!from.meets(emitter ? emitter->links() : LightLinks{scene_.geometry.instances[surface.instance].links.unlit_sets}))
    return 0.0f;
  return emitter ? emitter_weight(scene_, from, *emitter, surface) : 1.0f;
}

void MetLights::add_miss(uint32_t lane, const Scattering &from, const glm::dvec3 &d, LightPath<float> path,
                         const glm::dvec3 *eye) {
  put(glm::normalize(d), misses_.wi, lane);
  if (sky_.asks_places())
    put(from.p, misses_.p, lane);
  // A ray that hits nothing has one scattering more in its depth, as in Cycles, and no end.
  path.depth += 1.0f;
  path.length = std::numeric_limits<float>::max();
  path.width = path.spread = eye ? path.spread : std::min(path.spread, scene_.lights.environment().finest());
  sky_.set_path(lane, path, eye);
}

void MetLights::look_at_sky(uint32_t count) {
  const Environment &environment = scene_.lights.environment();
  for (const bool transmits : {false, true}) {
    // Most scenes have one map.
    if (environment.is_light() && (!transmits || environment.has_map_of_glass()))
      sky_.find_density(misses_, transmits);
    std::copy_n(misses_.pdf, kBlockLanes, density_[transmits]);
  }
  sky_.look(misses_.wi, (1u << count) - 1u);
}

float MetLights::sky_weight(uint32_t lane, const Scattering &from) const {
  const LightSet &lights = scene_.lights;
  // The environment is sampled as a light, too.
  if (!lights.environment().is_light() || !(from.pdf > 0.0))
    return 1.0f;
  return mis_weight(from.pdf, density_[from.transmits][lane] * lights.probability(from.query(), lights.environment_light()));
}

} // namespace lancer
