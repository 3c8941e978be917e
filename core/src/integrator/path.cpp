#include "integrator/path_kinds.h"
#include "sampling/color.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Roulette starts where most of the light has been gathered.
constexpr uint32_t kRouletteAfter = 2;

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
  energy_ = {};
  late_.begin();
  const auto gathered = [&](uint32_t slot) { return results[slot].radiance + indirect_[slot]; };
  for (uint32_t turn = 0; !paths_.empty() && !settings_.cancelled(); ++turn) {
    // Find where every path goes next.
    find_hits(results, trace);
    // Gather emission, ask a light, choose how each path goes on.
    shade(results, trace);
    if (late_.due(turn))
      late_.note(
          turn, paths_.size(), [&](size_t i) { return paths_[i].slot; }, gathered);
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
  late_.end(gathered, energy_);
  // Join the indirect light, clamped if that was asked for.
  for (size_t slot = 0; slot < results.size(); ++slot) {
    glm::vec3 indirect = indirect_[slot];
    const float top = largest(indirect);
    if (settings_.clamp_indirect > 0.0f && top > settings_.clamp_indirect) {
      energy_.clip(double(luminance(indirect)) * (1.0 - double(settings_.clamp_indirect / top)));
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
  Record record;
  record.features = begin_features(settings_, passes_.features());
  if (!picture_alone_ || records_.size() != addresses.size())
    records_.assign(addresses.size(), record);
  generator_.start(addresses, passes_.wanted(), results, [&](uint32_t slot, const Sampler &sampler) -> Ray & {
    paths_.emplace_back(sampler, slot);
    return rays_.emplace_back();
  });
  for (size_t i = 0; i < paths_.size(); ++i)
    paths_[i].from = rays_[i].o;
  counts_.camera += paths_.size();
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::shade(std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  next_paths_.clear();
  next_rays_.clear();
  add_lights_met(results);
  size_t met = 0;
  const uint64_t narrow_before = vertices_.narrow;
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (i + 1 < paths_.size())
      textures_.ahead(hits_[i + 1]);
    if (!hits_[i].valid()) {
      miss(i, results);
      continue;
    }
    ++met;
    const uint32_t material = material_of(scene_.geometry, scene_.slots, hits_[i].instance, hits_[i].primitive);
    if (const WideMaterial *wide = trace ? nullptr : for_lanes(material, hits_[i].instance))
      put_in_lane(i, material, *wide, results);
    else
      shade_surface(paths_[i], rays_[i], hits_[i].t, surface_at(scene_.geometry, scene_.slots, rays_[i], hits_[i]), results,
                    trace);
  }
  add_missed(results);
  shade_lanes(results);
  // What lanes gave back has been shaded by the general code.
  vertices_.wide += met - (vertices_.narrow - narrow_before);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::shade_surface(Path &path, const Ray &ray, double t, const Surface &surface,
                                                   std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  // Ask the material what it does to light that goes back along the ray.
  ++vertices_.narrow;
  SampleResult &result = results[path.slot];
  shader_.shade(surface, view_of(path, ray, t), point_);
  if (trace)
    keep_vertex(path, surface, t, result, *trace);
  // Holes end what the camera sees.
  if (path.in_view && !cut_hole(scene_, surface, path.beta, point_, result))
    return;
  if (path.in_view && !picture_alone_)
    record(path, surface, t, result);
  add_emission(path, surface, point_.emission, result);
  if (DenoisingFeatures &features = records_[path.slot].features; features.open)
    add_denoising_features(scene_, camera_, point_, t * glm::length(ray.d), features, result);
  if (path.last)
    return;

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
  if constexpr (Layers)
    if (path.chooses_to_pass(pass))
      return pass_straight_on(path, surface, ray, t, point_.transmittance / pass);
  if (ends)
    return;
  Ray next;
  path.length += t * glm::length(ray.d);
  if (scatter(path, surface, double(pass), u, next) && survives(path.scatterings, u[kVertexRoulette], path.beta)) {
    next_paths_.push_back(path);
    next_rays_.push_back(next);
  }
}

// How a path looks at what it meets at t.
template <uint32_t Shapes, bool Layers>
View PathIntegrator<Shapes, Layers>::view_of(const Path &path, const Ray &ray, double t) const {
  const double unit = glm::length(ray.d), way = path.length + t * unit;
  return {.wo = glm::vec3(-glm::normalize(ray.d)),
          .footprint = float(cone_.base + way * cone_.spread),
          .path = light_path(path, (t - ray.tmin) * unit)};
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::keep_vertex(const Path &path, const Surface &surface, double t, const SampleResult &result,
                                                 std::vector<PathVertex> &trace) const {
  const glm::vec3 so_far = result.radiance + indirect_[path.slot];
  trace.push_back({scene_.normalisation.to_world(surface.p), t / scene_.normalisation.scale, surface.ns, path.beta, so_far,
                   surface.instance, surface.primitive, surface.material, path.scatterings});
}

// Fills the passes that describe what the camera sees.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::record(const Path &path, const Surface &surface, double t, SampleResult &result) {
  // A surface that is hardly there gives way to the next one, unless the path ends on it.
  Record &record = records_[path.slot];
  if (!record.seen && mean(point_.opacity()) >= settings_.alpha_threshold) {
    record_first_surface(scene_, settings_, surface, point_, record.depth + t, result);
    record.seen = true;
  } else if (!record.seen) {
    record_place(scene_, surface, point_.material, record.depth + t, result);
  }
  record_seen(scene_, camera_, settings_, passes_, surface, point_, path.beta, result);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::sample_occlusion(const Path &path, const Surface &surface, const VertexNumbers &u) {
  // Look around the normal of what is diffuse, with the weight of a cosine.
  const glm::vec3 n = mean_normal(point_.bsdf, true);
  const glm::vec3 local = warp_cosine_hemisphere({u[kVertexBsdf], u[kVertexBsdf + 1]});
  const double distance = settings_.occlusion_distance * scene_.normalisation.scale;
  Ray ray =
      leave(surface, glm::dvec3(Frame(n).to_world(local)), distance > 0.0 ? distance : std::numeric_limits<double>::infinity());
  ray.kinds = LANCER_RAY_SHADOW;
  shadows_.push(ray, {.slot = path.slot, .occlusion = true}, path.beta * point_.opacity(), path.passed_through);
}

// Unless the path has passed all that it may.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::pass_straight_on(Path &path, const Surface &surface, const Ray &ray, double t,
                                                      const glm::vec3 &weight) {
  if (path.layers_left(settings_.transparent_bounces) == 0)
    return;
  const double length = t * glm::length(ray.d);
  path.beta *= weight;
  path.passed += length;
  path.length += length;
  if (!picture_alone_)
    records_[path.slot].depth += t;
  path.pass_layers(1, settings_.transparent_bounces);
  next_rays_.push_back(leave(surface, ray.d, ray.tmax - t));
  next_rays_.back().kinds = path.kinds;
  next_paths_.push_back(path);
}

template <uint32_t Shapes, bool Layers>
bool PathIntegrator<Shapes, Layers>::scatter(Path &path, const Surface &surface, double pass, const VertexNumbers &u,
                                             Ray &next) {
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
      records_[path.slot].share[component] = sample.share[component];
  }
  // Go on from here.
  path.beta *= sample.weight / float(1.0 - pass);
  path.pdf = sample.delta ? 0.0 : double(sample.pdf) * (1.0 - pass);
  path.from = surface.p;
  path.normal = point_.bsdf.ns;
  path.transmits = point_.bsdf.transmits;
  path.kinds = ray_kind(sample);
  path.story.scatter(sample.component == Component::Diffuse, sample.transmitted, sample.delta);
  path.layers = 0;
  path.passed = 0.0;
  ++path.scatterings;
  next = leave(surface, glm::dvec3(sample.wi), std::numeric_limits<double>::infinity());
  next.kinds = path.kinds;
  return true;
}

template <uint32_t Shapes, bool Layers>
bool PathIntegrator<Shapes, Layers>::survives(uint32_t scatterings, float u, glm::vec3 &beta) {
  if (scatterings <= kRouletteAfter)
    return true;
  // End dark paths early; what survives is brightened by exactly that. By the root, instead of beta itself, they go on longer:
  // variance times rays falls by a twentieth in the mean of five scenes.
  const float q = std::min(1.0f, std::sqrt(largest(beta)));
  if (u >= q)
    return false;
  beta /= q;
  return true;
}

#define LANCER_PATH(shapes, layers) template class PathIntegrator<shapes, layers>;
LANCER_PATH_KINDS(LANCER_PATH)
#undef LANCER_PATH

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  const uint32_t shapes = settings.all_features ? kAllShapes : scene.shapes;
  const bool layers = settings.all_features || (scene.features & kFeatureTransparency);
  if (layers)
    return std::make_unique<PathIntegrator<kAllShapes, true>>(scene, camera, settings, "path all");
  if ((shapes & ~kMatteShapes) == 0)
    return std::make_unique<PathIntegrator<kMatteShapes, false>>(scene, camera, settings, "path lambert");
  if ((shapes & ~kPlasticShapes) == 0)
    return std::make_unique<PathIntegrator<kPlasticShapes, false>>(scene, camera, settings, "path lambert+microfacet");
  return std::make_unique<PathIntegrator<kAllShapes, false>>(scene, camera, settings, "path all lobes, solid");
}

} // namespace lancer
