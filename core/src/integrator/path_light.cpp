// The light that paths gather: what they run into, and what they ask for.
#include "integrator/lane_access.h"
#include "integrator/mis_weight.h"
#include "integrator/path_kinds.h"
#include "sampling/color.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lancer {

namespace {

constexpr glm::vec3 divided(const glm::vec3 &a, const glm::vec3 &b) {
  return {b.x != 0.0f ? a.x / b.x : 0.0f, b.y != 0.0f ? a.y / b.y : 0.0f, b.z != 0.0f ? a.z / b.z : 0.0f};
}

} // namespace

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add(const Path &path, SampleResult &result, const glm::vec3 &radiance, bool environment) {
  // Light that was scattered at most once is direct; clamping never touches it.
  const bool indirect = path.scatterings > 1;
  if (const DenoisingFeatures &features = records_[path.slot].features; features.open)
    result.albedo += features.beta * radiance;
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
  passes_.add(result, radiance, records_[path.slot].share, indirect);
}

// Lights stand in no one's way: adds all that the rays pass before they end.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::add_lights_met(std::span<SampleResult> results) {
  const LightSet &lights = scene_.lights;
  if (!lights.any_on_the_way())
    return;
  for (size_t first = 0; first < paths_.size(); first += kWays) {
    // Look from the last scattering, as sampling does.
    const uint32_t count = uint32_t(std::min<size_t>(kWays, paths_.size() - first));
    for (uint32_t lane = 0; lane < count; ++lane) {
      const Ray &ray = rays_[first + lane];
      put(paths_[first + lane].from, ways_.from, lane);
      put(ray.d, ways_.d, lane);
      ways_.end[lane] = way_end(first + lane) + lights.most_before();
    }
    for (const uint32_t number : lights.always_on_the_way()) {
      const uint32_t met = lanes_.meets(ways_, lights.lights()[number]) & ((1u << count) - 1u);
      for (uint32_t rest = met; rest != 0; rest &= rest - 1)
        add_light_met(first + size_t(std::countr_zero(rest)), number, results);
    }
    if (lights.finds())
      lights.many().along(ways_, count, [&](uint32_t lane, uint32_t number) { add_light_met(first + lane, number, results); });
  }
}

template <uint32_t Shapes, bool Layers> double PathIntegrator<Shapes, Layers>::way_end(size_t i) const {
  return paths_[i].passed + std::min(hits_[i].t, rays_[i].tmax) * glm::length(rays_[i].d);
}

// One light, if the ray meets it on this stretch of the way.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_light_met(size_t i, uint32_t number, std::span<SampleResult> results) {
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

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_emission(const Path &path, const Surface &surface, const glm::vec3 &emission,
                                                  SampleResult &result) {
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

// A light and a point of it, with the probability of both in pdf.
template <uint32_t Shapes, bool Layers>
LightSample PathIntegrator<Shapes, Layers>::ask_light(const Surface &surface, const VertexNumbers &u,
                                                      LightSet::Choice &choice) {
  const LightQuery here(surface.p, point_.bsdf.ns, point_.bsdf.transmits);
  const double u_choice = double(u[kVertexLightChoice]) + 0x1p-24 * double(u[kVertexLightDigits]);
  choice = scene_.lights.choose(scene_.geometry, here, u_choice);
  if (!(choice.probability > 0.0))
    return {};
  LightSample light = sample_scene_light(scene_, choice, surface.p, {u[kVertexLight], u[kVertexLight + 1]}, shader_);
  if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
    return {};
  light.pdf *= choice.probability;
  return light;
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::send_shadow(const Path &path, const Surface &surface, const glm::vec3 &ns,
                                                 const glm::vec3 &ng, const LightSample &light, uint32_t number,
                                                 const WaitingLight &waiting, const glm::vec3 &contribution) {
  if (scene_.lights.no_shadow(number))
    shadows_.push_lit(waiting, contribution);
  else
    shadows_.push(shadow_ray(scene_.geometry, surface, ns, ng, light), waiting, contribution, path.passed_through);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::sample_light(const Path &path, const Surface &surface, double pass,
                                                  const VertexNumbers &u) {
  if (scene_.lights.empty() || !point_.bsdf.smooth)
    return;
  LightSet::Choice choice;
  const LightSample light = ask_light(surface, u, choice);
  if (!(light.pdf > 0.0))
    return;
  // Ask the surface how much of it goes towards the viewer, without what the light is hidden from.
  BsdfValue value = point_.bsdf.template eval_lit<Shapes>(glm::vec3(light.wi));
  const uint32_t hidden = scene_.lights.hidden_from(choice.light);
  if (hidden & LANCER_RAY_DIFFUSE)
    value.part[size_t(Component::Diffuse)] = glm::vec3(0.0f);
  if (hidden & LANCER_RAY_GLOSSY)
    value.part[size_t(Component::Glossy)] = glm::vec3(0.0f);
  if (hidden & LANCER_RAY_TRANSMISSION)
    value.part[size_t(Component::Transmission)] = glm::vec3(0.0f);
  const glm::vec3 f = value.f();
  if (f == glm::vec3(0.0f))
    return;
  // The BSDF finds the same light by the samples that do not pass straight on.
  const float weight = light.delta ? 1.0f : mis_weight(light.pdf, double(value.pdf) * (1.0 - pass));
  // What is scattered of a density is of the order of 1, however narrow the lobe and however bright the light.
  const glm::vec3 contribution = path.beta * (f * float(double(weight) / light.pdf)) * light.radiance;
  WaitingLight waiting{.slot = path.slot, .indirect = path.scatterings > 0};
  if (passes_.wanted()) {
    for (size_t component = 0; component < 2; ++component)
      waiting.share[component] = path.in_view ? divided(value.part[component], f) : records_[path.slot].share[component];
  }
  send_shadow(path, surface, point_.bsdf.ns, point_.bsdf.ng, light, choice.light, waiting, contribution);
}

#define LANCER_PATH(shapes, layers)                                                                                            \
  template void PathIntegrator<shapes, layers>::add(const Path &, SampleResult &, const glm::vec3 &, bool);                    \
  template void PathIntegrator<shapes, layers>::add_lights_met(std::span<SampleResult>);                                       \
  template void PathIntegrator<shapes, layers>::add_emission(const Path &, const Surface &, const glm::vec3 &,                 \
                                                             SampleResult &);                                                  \
  template void PathIntegrator<shapes, layers>::sample_light(const Path &, const Surface &, double, const VertexNumbers &);
LANCER_PATH_KINDS(LANCER_PATH)
#undef LANCER_PATH

} // namespace lancer
