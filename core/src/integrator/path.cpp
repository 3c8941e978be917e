#include "integrator/path.h"

#include "sampling/color.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// The power heuristic in ratio form: infinite densities give 0 or 1, never NaN.
float mis_weight(double pdf, double other) {
  const double ratio = other / pdf;
  return float(1.0 / (1.0 + ratio * ratio));
}

// Roulette starts where most of the light has been gathered.
constexpr uint32_t kRouletteAfter = 3;

constexpr glm::vec3 divided(const glm::vec3 &a, const glm::vec3 &b) {
  return {b.x != 0.0f ? a.x / b.x : 0.0f, b.y != 0.0f ? a.y / b.y : 0.0f, b.z != 0.0f ? a.z / b.z : 0.0f};
}

// What sent a ray that a BSDF has sampled.
uint32_t ray_kind(const BsdfSample &sample) {
  if (sample.transmitted)
    return LANCER_RAY_TRANSMISSION;
  return sample.component == Component::Diffuse ? LANCER_RAY_DIFFUSE : LANCER_RAY_GLOSSY;
}

} // namespace

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
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
    counts_.shadow += shadows_.trace([&](const WaitingLight &waiting, const glm::vec3 &light) {
      SampleResult &result = results[waiting.slot];
      if (waiting.occlusion) {
        result.light[kLightOcclusion] += light;
        return;
      }
      if (waiting.indirect)
        indirect_[waiting.slot] += light;
      else
        result.radiance += light;
      passes_.add(result, light, waiting.share, waiting.indirect);
    });
    counts_.bounce += next_rays_.size();
    paths_.swap(next_paths_);
    rays_.swap(next_rays_);
  }
  // Join the indirect light, clamped if that was asked for.
  for (size_t slot = 0; slot < results.size(); ++slot) {
    glm::vec3 indirect = indirect_[slot];
    const float top = largest(indirect);
    if (settings_.clamp_indirect > 0.0f && top > settings_.clamp_indirect) {
      indirect *= settings_.clamp_indirect / top;
      passes_.scale_indirect(results[slot], settings_.clamp_indirect / top);
    }
    results[slot].radiance += indirect;
  }
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  paths_.clear();
  rays_.clear();
  indirect_.assign(addresses.size(), glm::vec3(0.0f));
  for (uint32_t slot = 0; slot < addresses.size(); ++slot) {
    Path path{.sampler = generator_.sampler(addresses[slot]), .slot = slot};
    path.features = begin_features(settings_, passes_.features());
    Ray ray;
    if (!generator_.start(addresses[slot], path.sampler, passes_.wanted(), results[slot], ray))
      continue;
    path.from = ray.o;
    rays_.push_back(ray);
    paths_.push_back(path);
  }
  counts_.camera += paths_.size();
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::shade(std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  next_paths_.clear();
  next_rays_.clear();
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (i + 1 < paths_.size())
      textures_.ahead(hits_[i + 1]);
    Path path = paths_[i];
    const Ray &ray = rays_[i];
    const double t = hits_[i].t;
    SampleResult &result = results[path.slot];
    // Lights stand in no one's way: add all that the ray passes before it ends.
    add_lights_met(path, ray, t, result);
    if (!hits_[i].valid()) {
      miss(path, ray, result);
      continue;
    }
    // Ask the material what it does to light that goes back along the ray.
    const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hits_[i]);
    const double way = path.length + t * glm::length(ray.d);
    shader_.shade(surface, {.wo = glm::vec3(-glm::normalize(ray.d)), .footprint = float(cone_.base + way * cone_.spread)},
                  point_);
    if (trace) {
      const glm::vec3 so_far = result.radiance + indirect_[path.slot];
      trace->push_back({scene_.normalisation.to_world(surface.p), t / scene_.normalisation.scale, surface.ns, path.beta, so_far,
                        surface.instance, surface.primitive, surface.material, path.scatterings});
    }
    // Holes end what the camera sees.
    if (path.in_view && !cut_hole(scene_, surface, path.beta, point_, result))
      continue;
    if (path.in_view)
      record(path, surface, t, result);
    add_emission(path, surface, result);
    if (path.features.open)
      add_denoising_features(scene_, camera_, point_, t * glm::length(ray.d), path.features, result);
    if (path.last)
      continue;

    const bool ends = path.scatterings > settings_.max_bounces;
    // Share the path between what passes straight on and what the surface scatters.
    float pass = 0.0f;
    if constexpr (Layers) {
      const float through = mean(point_.transmittance);
      const float rest = ends ? 0.0f : mean(point_.bsdf.albedo());
      if (through > 0.0f)
        pass = through / (through + rest);
    }
    VertexNumbers u;
    if (!ends) {
      u = path.sampler.get8(kDimensionVertex + path.scatterings * kVertexStride);
      sample_light(path, surface, double(pass), u);
      if (path.scatterings == 0 && passes_.occlusion())
        sample_occlusion(path, surface, u);
    }
    if constexpr (Layers) {
      const uint32_t dimension = kDimensionOpacity + 2 * (path.scatterings * kMaxLayers + path.layers);
      if (pass > 0.0f && (pass >= 1.0f || path.sampler.get1(dimension) < pass)) {
        if (path.layers + 1 < kMaxLayers) {
          next_rays_.push_back(pass_straight_on(path, surface, ray, t, point_.transmittance / pass));
          next_paths_.push_back(path);
        }
        continue;
      }
    }
    if (ends)
      continue;
    Ray next;
    path.length = way;
    if (scatter(path, surface, double(pass), u, next) && survives(path, u[kVertexRoulette])) {
      next_paths_.push_back(path);
      next_rays_.push_back(next);
    }
  }
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add(const Path &path, SampleResult &result, const glm::vec3 &radiance, bool environment) {
  // Light that was scattered at most once is direct; clamping never touches it.
  const bool indirect = path.scatterings > 1;
  if (path.features.open)
    result.albedo += path.features.beta * radiance;
  // What the camera sees through clear glass is in no pass of indirect light: clamp it by itself.
  if (path.in_view) {
    const float top = largest(radiance), limit = settings_.clamp_indirect;
    const glm::vec3 seen = indirect && limit > 0.0f && top > limit ? radiance * (limit / top) : radiance;
    result.radiance += seen;
    passes_.add_seen(result, seen, environment);
    return;
  }
  if (indirect)
    indirect_[path.slot] += radiance;
  else
    result.radiance += radiance;
  passes_.add(result, radiance, path.share, indirect);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::miss(const Path &path, const Ray &ray, SampleResult &result) {
  if (path.in_view && !path.seen)
    forget_place(result);
  if (path.scatterings == 0)
    add_sky_features(path.features, result);
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
  // The environment is sampled as a light, too.
  const glm::dvec3 wi = glm::normalize(ray.d);
  float weight = 1.0f;
  if (path.pdf > 0.0)
    weight =
        mis_weight(path.pdf, environment.pdf(wi) * scene_.lights.probability(query(path), scene_.lights.environment_light()));
  const glm::dvec3 *eye = path.kinds == LANCER_RAY_CAMERA ? &path.from : nullptr;
  add(path, result, path.beta * environment.radiance(wi, shader_.values(), &camera_, eye) * weight, true);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_lights_met(const Path &path, const Ray &ray, double t, SampleResult &result) {
  if (!scene_.lights.any_on_the_way())
    return;
  // Look from the last scattering, as sampling does, at what lies on this stretch of the way.
  const double length = glm::length(ray.d);
  const double begin = path.passed + ray.tmin * length, end = path.passed + std::min(t, ray.tmax) * length;
  const glm::dvec3 wi = ray.d / length;
  scene_.lights.on_the_way(path.from, wi, end, [&](uint32_t number) {
    const Light &light = scene_.lights.lights()[number];
    if (!(path.kinds & ~light.hidden_from))
      return;
    const LightHit met = meet(light, path.from, wi);
    // A sun lies behind all surfaces, wherever the view ends.
    const bool here = std::isinf(met.distance) ? std::isinf(t) : met.distance >= begin && met.distance < end;
    if (!(met.pdf > 0.0) || !here)
      return;
    const float weight = path.pdf > 0.0 ? mis_weight(path.pdf, met.pdf * scene_.lights.probability(query(path), number)) : 1.0f;
    add(path, result, path.beta * met.radiance * weight, false);
  });
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_emission(const Path &path, const Surface &surface, SampleResult &result) {
  if (point_.emission == glm::vec3(0.0f))
    return;
  float weight = 1.0f;
  const Emitter *emitter = path.pdf > 0.0 ? scene_.lights.emitter_of(surface.instance) : nullptr;
  if (emitter) {
    const double pdf = emitter->face_pdf(scene_.geometry, path.from, surface);
    weight = mis_weight(path.pdf, pdf * scene_.lights.probability(scene_.geometry, query(path), *emitter, surface.primitive));
  }
  add(path, result, path.beta * point_.emission * weight, false);
}

// Fills the passes that describe what the camera sees.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::record(Path &path, const Surface &surface, double t, SampleResult &result) {
  // A surface that is hardly there gives way to the next one, unless the path ends on it.
  if (!path.seen && mean(point_.opacity()) >= settings_.alpha_threshold) {
    record_first_surface(scene_, settings_, surface, point_, path.depth + t, result);
    path.seen = true;
  } else if (!path.seen) {
    record_place(scene_, surface, point_, path.depth + t, result);
  }
  record_seen(scene_, camera_, settings_, passes_, surface, point_, path.beta, result);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::sample_light(const Path &path, const Surface &surface, double pass,
                                                  const VertexNumbers &u) {
  if (scene_.lights.empty() || !point_.bsdf.smooth)
    return;
  // Choose a light and a point of it.
  const LightQuery here(surface.p, point_.bsdf.ns, point_.bsdf.transmits);
  const double u_choice = double(u[kVertexLightChoice]) + 0x1p-24 * double(u[kVertexLightDigits]);
  const LightSet::Choice choice = scene_.lights.choose(scene_.geometry, here, u_choice);
  if (!(choice.probability > 0.0))
    return;
  const LightSample light = sample_scene_light(scene_, choice, surface.p, {u[kVertexLight], u[kVertexLight + 1]}, shader_);
  if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
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
  const double pdf = light.pdf * choice.probability;
  const float weight = light.delta ? 1.0f : mis_weight(pdf, double(value.pdf) * (1.0 - pass));
  const glm::vec3 contribution = path.beta * f * light.radiance * float(double(weight) / pdf);
  WaitingLight waiting{.slot = path.slot, .indirect = path.scatterings > 0};
  if (passes_.wanted()) {
    for (size_t component = 0; component < 2; ++component)
      waiting.share[component] = path.in_view ? divided(value.part[component], f) : path.share[component];
  }
  if (scene_.lights.no_shadow(choice.light))
    shadows_.push_lit(waiting, contribution);
  else
    shadows_.push(shadow_ray(scene_.geometry, surface, point_.bsdf, light), waiting, contribution, path.passed_through);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::sample_occlusion(const Path &path, const Surface &surface, const VertexNumbers &u) {
  // Look around the normal of what is diffuse, with the weight of a cosine.
  glm::vec3 n(0.0f);
  for (int i = 0; i < point_.bsdf.count; ++i)
    if (point_.bsdf.lobes[i].component == Component::Diffuse)
      n += point_.bsdf.frames[point_.bsdf.lobes[i].frame].n * mean(point_.bsdf.lobes[i].color);
  n = n == glm::vec3(0.0f) ? point_.bsdf.ns : glm::normalize(n);
  const glm::vec3 local = warp_cosine_hemisphere({u[kVertexBsdf], u[kVertexBsdf + 1]});
  const double distance = settings_.occlusion_distance * scene_.normalisation.scale;
  Ray ray =
      leave(surface, glm::dvec3(Frame(n).to_world(local)), distance > 0.0 ? distance : std::numeric_limits<double>::infinity());
  ray.kinds = LANCER_RAY_SHADOW;
  shadows_.push(ray, {.slot = path.slot, .occlusion = true}, path.beta * point_.opacity(), path.passed_through);
}

template <uint32_t Shapes, bool Layers>
Ray PathIntegrator<Shapes, Layers>::pass_straight_on(Path &path, const Surface &surface, const Ray &ray, double t,
                                                     const glm::vec3 &weight) const {
  const double length = t * glm::length(ray.d);
  path.beta *= weight;
  path.passed += length;
  path.length += length;
  path.depth += t;
  ++path.layers;
  // Beyond the last layer the next surface shows its own light only.
  path.last = ++path.passed_through >= settings_.transparent_bounces;
  Ray next = leave(surface, ray.d, ray.tmax - t);
  next.kinds = path.kinds;
  return next;
}

template <uint32_t Shapes, bool Layers>
bool PathIntegrator<Shapes, Layers>::scatter(Path &path, const Surface &surface, double pass, const VertexNumbers &u,
                                             Ray &next) const {
  // Draw a direction from the BSDF.
  const BsdfSample sample = point_.bsdf.template sample<Shapes>(u[kVertexLobe], {u[kVertexBsdf], u[kVertexBsdf + 1]});
  if (sample.weight == glm::vec3(0.0f) || !(sample.pdf > 0.0f))
    return false;
  // Glass that does not count leaves the picture what it was.
  const bool clear = settings_.transparent_glass && sample.transmitted && sample.component != Component::Diffuse &&
                     sample.alpha2 <= settings_.glass_alpha2;
  if (path.in_view && !clear) {
    path.in_view = false;
    for (int component = 0; component < 2; ++component)
      path.share[component] = sample.share[component];
  }
  // Go on from here.
  path.beta *= sample.weight / float(1.0 - pass);
  path.pdf = sample.delta ? 0.0 : double(sample.pdf) * (1.0 - pass);
  path.from = surface.p;
  path.normal = point_.bsdf.ns;
  path.transmits = point_.bsdf.transmits;
  path.kinds = ray_kind(sample);
  path.layers = 0;
  path.passed = 0.0;
  ++path.scatterings;
  next = leave(surface, glm::dvec3(sample.wi), std::numeric_limits<double>::infinity());
  next.kinds = path.kinds;
  return true;
}

template <uint32_t Shapes, bool Layers> bool PathIntegrator<Shapes, Layers>::survives(Path &path, float u) const {
  if (path.scatterings <= kRouletteAfter)
    return true;
  // End dark paths early; what survives is brightened by exactly that.
  const float q = std::min(1.0f, largest(path.beta));
  if (u >= q)
    return false;
  path.beta /= q;
  return true;
}

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  constexpr uint32_t matte = shape_bit(LobeShape::Lambert);
  constexpr uint32_t plastic = matte | shape_bit(LobeShape::Beckmann) | shape_bit(LobeShape::Microfacet);
  const uint32_t shapes = settings.all_features ? kAllShapes : scene.shapes;
  const bool layers = settings.all_features || (scene.features & kFeatureTransparency);
  if (layers)
    return std::make_unique<PathIntegrator<kAllShapes, true>>(scene, camera, settings, "path all");
  if ((shapes & ~matte) == 0)
    return std::make_unique<PathIntegrator<matte, false>>(scene, camera, settings, "path lambert");
  if ((shapes & ~plastic) == 0)
    return std::make_unique<PathIntegrator<plastic, false>>(scene, camera, settings, "path lambert+microfacet");
  return std::make_unique<PathIntegrator<kAllShapes, false>>(scene, camera, settings, "path all lobes, solid");
}

} // namespace lancer
