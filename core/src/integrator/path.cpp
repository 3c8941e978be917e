#include "integrator/path.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// The power heuristic in ratio form: infinite densities give 0 or 1, never NaN.
float mis_weight(double pdf, double other) {
  const double ratio = other / pdf;
  return float(1.0 / (1.0 + ratio * ratio));
}

float largest(const glm::vec3 &v) { return std::max({v.x, v.y, v.z}); }

// Roulette starts where most of the light has been gathered.
constexpr uint32_t kRouletteAfter = 3;

} // namespace

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                                         std::vector<PathVertex> *trace) {
  // Start one path per sample.
  generate(addresses, results);
  while (!paths_.empty() && !settings_.cancelled()) {
    // Find where every path goes next.
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    // Gather emission, ask a light, choose how each path goes on.
    shade(results, trace);
    // Add the light that was not in shadow.
    counts_.shadow += shadows_.trace([&](uint32_t owner, const glm::vec3 &light) {
      const uint32_t slot = owner >> 1;
      if (owner & 1)
        indirect_[slot] += light;
      else
        results[slot].radiance += light;
    });
    counts_.bounce += next_rays_.size();
    paths_.swap(next_paths_);
    rays_.swap(next_rays_);
  }
  // Join the indirect light, clamped if that was asked for.
  for (size_t slot = 0; slot < results.size(); ++slot) {
    glm::vec3 indirect = indirect_[slot];
    const float top = largest(indirect);
    if (settings_.clamp_indirect > 0.0f && top > settings_.clamp_indirect)
      indirect *= settings_.clamp_indirect / top;
    results[slot].radiance += indirect;
  }
}

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  paths_.clear();
  rays_.clear();
  indirect_.assign(addresses.size(), glm::vec3(0.0f));
  for (uint32_t slot = 0; slot < addresses.size(); ++slot) {
    results[slot] = SampleResult{};
    Path path{.sampler = generator_.sampler(addresses[slot]), .slot = slot};
    rays_.push_back(generator_.ray(addresses[slot], path.sampler));
    path.from = rays_.back().o;
    paths_.push_back(path);
  }
  counts_.camera += addresses.size();
}

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::shade(std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  next_paths_.clear();
  next_rays_.clear();
  Bsdf scratch;
  for (size_t i = 0; i < paths_.size(); ++i) {
    Path path = paths_[i];
    const Ray &ray = rays_[i];
    SampleResult &result = results[path.slot];
    // Lights stand in no one's way: add all that the ray passes before it ends.
    add_lights_met(path, ray, hits_[i].t, result);
    if (!hits_[i].valid()) {
      miss(path, result);
      continue;
    }
    const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hits_[i]);
    const glm::vec3 wo(-glm::normalize(ray.d));
    const ShadingPoint point = shading_point(scene_, surface, wo, scratch);
    if (trace) {
      const glm::vec3 so_far = result.radiance + indirect_[path.slot];
      trace->push_back({scene_.normalisation.to_world(surface.p), hits_[i].t / scene_.normalisation.scale, surface.ns,
                        path.beta, so_far, surface.instance, surface.primitive, surface.material, path.scatterings});
    }

    Ray next;
    const float opacity = Opacity && point.material ? evaluate(point.material->opacity, surface).x : 1.0f;
    if (!path.seen && path.scatterings == 0 && opacity >= kSeenOpacity) {
      record_first_surface(scene_, surface, point.bsdf->albedo_color(), path.depth + hits_[i].t, result);
      path.seen = true;
    }
    if constexpr (Opacity) {
      // Meet the surface, or pass straight on, by its opacity.
      const uint32_t dimension = kDimensionOpacity + 2 * (path.scatterings * kMaxLayers + path.layers);
      if (opacity < 1.0f && path.sampler.get1(dimension) >= opacity) {
        if (++path.layers < kMaxLayers) {
          next = leave(surface, ray.d, ray.tmax - hits_[i].t);
          path.passed += hits_[i].t * glm::length(ray.d);
          path.depth += hits_[i].t;
          next_paths_.push_back(path);
          next_rays_.push_back(next);
        }
        continue;
      }
    }
    result.alpha = 1.0f;
    if (point.material && point.material->emits())
      add_emission(path, surface, *point.material, result);
    if (path.scatterings > settings_.max_bounces)
      continue;
    sample_light(path, surface, point);
    if (scatter(path, surface, point, next) && survives(path)) {
      next_paths_.push_back(path);
      next_rays_.push_back(next);
    }
  }
}

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::add(const Path &path, SampleResult &result, const glm::vec3 &radiance,
                                         uint32_t scatterings) {
  // Light that was scattered at most once is direct; clamping never touches it.
  if (scatterings <= 1)
    result.radiance += radiance;
  else
    indirect_[path.slot] += radiance;
}

template <uint32_t Lobes, bool Opacity> void PathIntegrator<Lobes, Opacity>::miss(const Path &path, SampleResult &result) {
  // A transparent film does not show the environment itself, only what it lights.
  if (path.scatterings == 0 && settings_.film_transparent)
    return;
  if (path.scatterings == 0)
    result.alpha = 1.0f;
  add(path, result, path.beta * scene_.lights.world(), path.scatterings);
}

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::add_lights_met(const Path &path, const Ray &ray, double t, SampleResult &result) {
  // The camera does not see lights themselves, as in Cycles; mirrors and glass do.
  if (path.scatterings == 0 || scene_.lights.with_extent().empty())
    return;
  // Look from the last scattering, as sampling does, at what lies on this stretch of the way.
  const double length = glm::length(ray.d), end = path.passed + t * length;
  const glm::dvec3 wi = ray.d / length;
  for (uint32_t light : scene_.lights.with_extent()) {
    const LightHit met = meet(scene_.lights.lights()[light], path.from, wi);
    const bool here = met.distance >= path.passed && (met.distance < end || std::isinf(end));
    if (!(met.pdf > 0.0) || !here)
      continue;
    const float weight = path.pdf > 0.0 ? mis_weight(path.pdf, met.pdf * scene_.lights.probability(light)) : 1.0f;
    add(path, result, path.beta * met.radiance * weight, path.scatterings);
  }
}

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::add_emission(const Path &path, const Surface &surface, const Material &material,
                                                  SampleResult &result) {
  const glm::vec3 Le = evaluate(material.emission, surface);
  float weight = 1.0f;
  const uint32_t light = scene_.lights.emitter_light(surface.instance);
  if (path.pdf > 0.0 && light != kNone) {
    const Emitter &emitter = scene_.lights.emitters()[light - scene_.lights.lights().size()];
    const double pdf = emitter.pdf(scene_.geometry, scene_.materials, path.from, surface);
    weight = mis_weight(path.pdf, pdf * scene_.lights.probability(light));
  }
  add(path, result, path.beta * Le * weight, path.scatterings);
}

template <uint32_t Lobes, bool Opacity>
void PathIntegrator<Lobes, Opacity>::sample_light(const Path &path, const Surface &surface, const ShadingPoint &point) {
  if (scene_.lights.empty() || !point.bsdf->has_smooth())
    return;
  // Choose a light and a point of it.
  const uint32_t dimension = kDimensionVertex + path.scatterings * kVertexStride;
  const LightSet::Choice choice = scene_.lights.choose(path.sampler.get1(dimension + kVertexLightChoice));
  if (!(choice.probability > 0.0))
    return;
  const glm::vec2 u = path.sampler.get2(dimension + kVertexLight);
  const size_t described = scene_.lights.lights().size();
  const LightSample light = choice.light < described ? sample(scene_.lights.lights()[choice.light], surface.p, u)
                                                     : scene_.lights.emitters()[choice.light - described].sample(
                                                           scene_.geometry, scene_.slots, scene_.materials, surface.p, u);
  if (!(light.pdf > 0.0))
    return;
  // Ask the surface how much of it goes towards the viewer.
  const glm::vec3 wi_world(light.wi), wi = point.frame.to_local(wi_world);
  if (!point.consistent(wi_world, wi))
    return;
  const auto value = point.bsdf->template eval_pdf<Lobes>(point.wo, wi);
  if (value.f == glm::vec3(0.0f))
    return;
  const double pdf = light.pdf * choice.probability;
  const float weight = light.delta ? 1.0f : mis_weight(pdf, double(value.pdf));
  const glm::vec3 contribution = path.beta * value.f * light.radiance * float(std::abs(double(wi.z)) * double(weight) / pdf);
  shadows_.push(shadow_ray(surface, light), path.slot << 1 | (path.scatterings > 0 ? 1u : 0u), contribution);
}

template <uint32_t Lobes, bool Opacity>
bool PathIntegrator<Lobes, Opacity>::scatter(Path &path, const Surface &surface, const ShadingPoint &point, Ray &next) const {
  // Draw a direction from the BSDF.
  const uint32_t dimension = kDimensionVertex + path.scatterings * kVertexStride;
  const BsdfSample sample = point.bsdf->template sample<Lobes>(point.wo, path.sampler.get1(dimension + kVertexLobe),
                                                               path.sampler.get2(dimension + kVertexBsdf));
  if (sample.weight == glm::vec3(0.0f) || !(sample.pdf > 0.0f))
    return false;
  const glm::vec3 wi = point.frame.to_world(sample.wi);
  if (!point.consistent(wi, sample.wi))
    return false;
  // Go on from here.
  path.beta *= sample.weight;
  path.pdf = sample.delta ? 0.0 : double(sample.pdf);
  path.from = surface.p;
  path.layers = 0;
  path.passed = 0.0;
  ++path.scatterings;
  next = leave(surface, glm::dvec3(wi), std::numeric_limits<double>::infinity());
  return true;
}

template <uint32_t Lobes, bool Opacity> bool PathIntegrator<Lobes, Opacity>::survives(Path &path) const {
  if (path.scatterings <= kRouletteAfter)
    return true;
  // End dark paths early; what survives is brightened by exactly that.
  const float q = std::min(1.0f, largest(path.beta));
  const uint32_t dimension = kDimensionVertex + (path.scatterings - 1) * kVertexStride;
  if (path.sampler.get1(dimension + kVertexRoulette) >= q)
    return false;
  path.beta /= q;
  return true;
}

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  constexpr uint32_t matte = kFeatureLambert, plastic = kFeatureLambert | kFeatureBeckmann;
  const uint32_t lobes = settings.all_features ? uint32_t(kFeatureAllLobes) : scene.features & kFeatureAllLobes;
  const bool opacity = settings.all_features || (scene.features & kFeatureOpacity);
  if (opacity)
    return std::make_unique<PathIntegrator<kFeatureAllLobes, true>>(scene, camera, settings, "path all");
  if ((lobes & ~matte) == 0)
    return std::make_unique<PathIntegrator<matte, false>>(scene, camera, settings, "path lambert");
  if ((lobes & ~plastic) == 0)
    return std::make_unique<PathIntegrator<plastic, false>>(scene, camera, settings, "path lambert+beckmann");
  return std::make_unique<PathIntegrator<kFeatureAllLobes, false>>(scene, camera, settings, "path all lobes, solid");
}

} // namespace lancer
