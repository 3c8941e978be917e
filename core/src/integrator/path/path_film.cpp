#include "integrator/path/path_film.h"

#include "simd/vectors.h"

#include <algorithm>

namespace lancer {

void PathFilm::begin(std::span<const SampleAddress> addresses, std::span<SampleResult> results, Extras &extras,
                     std::vector<PathVertex> *trace) {
  trace_ = trace;
  extras_ = &extras;
  extras.begin(addresses.size(), layout_);
  if (settings_.clamp_indirect > 0.0f)
    indirect_groups_.begin(addresses.size(), layout_);
  // Passes of places are recorded from the first sample of each pixel alone; a trace records all vertices.
  only_combined_ = !trace && passes.only_places() && (!passes.places() || addresses.front().sample > 0);
  results_ = results;
  energy = {};
  if (settings_.filter_glossy > 0.0f)
    filtered_.assign(results.size(), 0.0f);
  if (settings_.fast_bounces > 0 || settings_.ambient > 0.0f)
    guessed_.assign(results.size(), 0.0f);
  indirect_.assign(results.size() * sums(), glm::vec3(0.0f));
  catchers_.begin(results.size(), sums());
  shares_.resize(indirect_.size());
  if (!only_combined_ || records_.size() != results.size())
    records_.assign(results.size(), Record());
  if (passes.guides())
    guides_.assign(results.size(), begin_guides(settings_, true));
}

void PathFilm::end() {
  for (uint32_t sample = 0; sample < results_.size(); ++sample) {
    if (settings_.clamp_indirect > 0.0f)
      clamp(sample);
    for (const glm::vec3 &light : indirect(sample))
      results_[sample].radiance += light;
    if (catchers_.keeps())
      catchers_.end(sample, results_[sample], *extras_);
  }
  for (const float change : filtered_)
    energy.filtered.add(change);
  for (const float change : guessed_)
    energy.guessed.add(change);
}

namespace {

// Indirect light of the paths of a sample, before and after clamping.
struct Clamped {
  glm::vec3 found{0.0f}, kept{0.0f};
  float factor = 1.0f; // of the last path that was clamped
};

// Clamps the light of each path of a sample as if the path were the only one: its own light times the number of paths, plus the
// shared light, which is the last of several sums. remove(luminance): receives the light of a path that is clamped.
template <class Remove> Clamped clamp_paths(std::span<glm::vec3> sums, float limit, Remove &&remove) {
  const size_t count = sums.size() > 1 ? sums.size() - 1 : 1;
  const auto paths = float(count);
  const glm::vec3 shared = sums.size() > 1 ? sums.back() : glm::vec3(0.0f);
  Clamped clamped;
  for (size_t branch = 0; branch < count; ++branch) {
    const glm::vec3 found = shared + paths * sums[branch];
    float share = 1.0f;
    if (const float top = largest(glm::abs(found)); top > limit) {
      clamped.factor = share = limit / top;
      remove(luminance(found) * (1.0f - share) / paths);
    }
    clamped.found += found;
    clamped.kept += found * share;
  }
  if (clamped.factor != 1.0f) {
    std::fill(sums.begin(), sums.end(), glm::vec3(0.0f));
    sums[0] = clamped.kept / paths;
  }
  return clamped;
}

} // namespace

void PathFilm::clamp(uint32_t sample) {
  if (catchers_.keeps())
    clamp_paths(catchers_.indirect(sample), settings_.clamp_indirect, [](float) {});
  const Clamped clamped =
      clamp_paths(indirect(sample), settings_.clamp_indirect, [&](float removed) { Energy::remove(energy.clipped, removed); });
  if (clamped.factor == 1.0f)
    return add_indirect_groups(sample, glm::vec3(1.0f));
  // Passes store the sum over the paths: scale them by the mean factor.
  glm::vec3 of_passes(clamped.factor);
  for (int channel = 0; channel < 3 && sums() > 1; ++channel)
    of_passes[channel] = clamped.found[channel] != 0.0f ? clamped.kept[channel] / clamped.found[channel] : 1.0f;
  passes.scale_indirect(results_[sample], of_passes);
  add_indirect_groups(sample, of_passes);
}

void PathFilm::add_indirect_groups(uint32_t sample, const glm::vec3 &factor) {
  const size_t first = size_t(sample) * layout_.channels();
  for (uint32_t i = 0; i < 3 * layout_.groups; ++i)
    extras_->channels[first + i] += indirect_groups_.channels[first + i] * factor[int(i % 3)];
}

// Returns direct light, clamped as in Cycles: each contribution by the mean of its channels. parts: number of contributions
// that share its weight; in_picture: the removed light counts.
glm::vec3 PathFilm::clamped_direct(const glm::vec3 &light, float parts, bool in_picture) {
  const float level = parts * mean(glm::abs(light)), limit = settings_.clamp_direct;
  if (!(limit > 0.0f) || !(level > limit))
    return light;
  const glm::vec3 kept = light * (limit / level);
  if (in_picture)
    Energy::remove(energy.clipped_direct, luminance(light - kept));
  return kept;
}

void PathFilm::add_removed(uint32_t sample, Ghost ghost, const glm::vec3 &light) {
  const float found = luminance(light);
  switch (ghost) {
  case Ghost::None:
    break;
  case Ghost::Bounces:
    Energy::remove(energy.cut, found);
    break;
  case Ghost::Caustics:
    Energy::remove(energy.no_caustics, found);
    break;
  case Ghost::Blurred:
  case Ghost::Sharp:
    filtered_[sample] += ghost == Ghost::Sharp ? found : -found;
    break;
  case Ghost::Guessed:
  case Ghost::Followed:
    guessed_[sample] += ghost == Ghost::Followed ? found : -found;
    break;
  }
}

void PathFilm::add(const Path &path, const glm::vec3 &found, bool environment, uint32_t group) {
  if (path.ghost != Ghost::None)
    return add_removed(path.sample, path.ghost, found);
  SampleResult &result = results_[path.sample];
  // Light that was scattered at most once is direct.
  const bool indirect = path.scatterings > 1;
  const glm::vec3 radiance = indirect ? found : clamped_direct(found, float(path.sharers), !path.of_catchers);
  if (path.of_catchers) {
    // As in Cycles, the world that is seen through clear catchers is in its pass once more.
    if (environment && path.in_view)
      passes.add_seen(result, radiance, true);
    return catchers_.add(path.sample, sum(path), radiance, indirect, *extras_);
  }
  // A transparent film leaves the environment behind it to the environment's pass: picture and guides have none of it.
  const bool hidden = environment && settings_.film_transparent && path.in_view;
  if (wants_guides(path) && !hidden)
    // The leader stands for all paths that share its weight.
    result.albedo += float(path.sharers) * guides_[path.sample].beta * radiance;
  // Light seen through clear glass is in no pass of indirect light: clamp it separately.
  if (path.in_view) {
    const float top = largest(glm::abs(radiance)), limit = settings_.clamp_indirect / float(path.sharers);
    const glm::vec3 seen = indirect && limit > 0.0f && top > limit ? radiance * (limit / top) : radiance;
    if (!hidden) {
      Energy::remove(energy.clipped, luminance(radiance - seen));
      result.radiance += seen;
    }
    passes.add_seen(result, seen, environment);
    if (!path.caught)
      add_to_group(path.sample, group, seen, false);
    return;
  }
  if (!path.caught)
    add_to_group(path.sample, group, radiance, indirect);
  if (indirect)
    indirect_[sum(path)] += radiance;
  else
    result.radiance += radiance;
  if (!path.caught)
    passes.add(result, radiance, shares_[sum(path)].of, indirect);
}

void PathFilm::add_lit(const WaitingLight &waiting, const glm::vec3 &light) {
  SampleResult &result = results_[waiting.target];
  if (waiting.occlusion) {
    result.light[kLightOcclusion] += light;
    return;
  }
  if (waiting.ghost != Ghost::None)
    return add_removed(waiting.target, waiting.ghost, light);
  const glm::vec3 kept = waiting.indirect ? light : clamped_direct(light, waiting.parts, !waiting.of_catchers);
  if (waiting.guessed)
    guessed_[waiting.target] -= luminance(kept);
  if (waiting.of_catchers)
    return catchers_.add(waiting.target, waiting.target * sums() + waiting.sum, kept, waiting.indirect, *extras_);
  add_to_group(waiting.target, waiting.group, kept, waiting.indirect);
  if (waiting.indirect)
    indirect_[waiting.target * sums() + waiting.sum] += kept;
  else
    result.radiance += kept;
  if (waiting.has_passes)
    passes.add(result, kept, waiting.share, waiting.indirect);
}

uint32_t PathFilm::record(SurfaceStage &surfaces, std::span<const Path> paths, const size_t (&number)[kBlockLanes],
                          uint32_t ends, uint32_t nothing) {
  for (uint32_t lane = 0; trace_ && lane < surfaces.count(); ++lane)
    if (paths[number[lane]].ghost == Ghost::None && !paths[number[lane]].of_catchers)
      trace(paths[number[lane]], surfaces.surface(lane), surfaces.hit(lane).t);
  if (only_combined_)
    return 0;
  // As in Cycles, a surface that ends the path gives only its emission; the guides count its distance, unless it lies behind
  // too many crossings.
  uint32_t seen = 0, guiding = 0, asked = 0;
  for (uint32_t lane = 0; lane < surfaces.count(); ++lane) {
    const Path &path = paths[number[lane]];
    seen |= uint32_t{path.in_view && !path.of_catchers} << lane;
    guiding |= uint32_t(wants_guides(path) && !path.last) << lane;
  }
  seen &= ~(ends | nothing);
  if (!(seen | (guiding & ~nothing)))
    return 0;
  surfaces.describe();
  each_lane(seen, [&](uint32_t lane) {
    const Path &path = paths[number[lane]];
    record(path, surfaces, lane);
    asked |= uint32_t(passes.occlusion() && path.scatterings == 0) << lane;
  });
  return asked;
}

void PathFilm::record(const Path &path, const SurfaceStage &surfaces, uint32_t lane) {
  // In most cases, the position suffices.
  Surface surface;
  if (path.is_first(settings_.splits.paths) || passes.uv())
    surface = surfaces.surface(lane);
  else
    surface.p = get(surfaces.surfaces().p, lane);
  const Hit &hit = surfaces.hit(lane);
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.bary = {hit.u, hit.v};
  record(path, surface, surfaces.material(lane), get(surfaces.means().normal, lane), recorded_opacity(surfaces, lane),
         surfaces.hit(lane).t);
  // Add the colours of the surface by component.
  for (uint32_t component = 0; component < 3 && passes.components(); ++component)
    results_[path.sample].light[kLightComponents + 3 * component + 2] +=
        path.beta * get(surfaces.means().shown[component], lane);
}

// t: of the ray, from the last surface that it passed.
void PathFilm::record(const Path &path, const Surface &surface, const MaterialView &material, const glm::vec3 &normal,
                      const glm::vec3 &opacity, double t) {
  SampleResult &result = results_[path.sample];
  // The first surface with enough opacity is recorded.
  Record &record = records_[path.sample];
  const bool here = path.leads && !record.seen && mean(opacity) >= settings_.alpha_threshold;
  // Place passes use the first sample of a pixel.
  if (path.leads && !record.seen && path.is_first(settings_.splits.paths))
    record_place(scene_, surface, material, record.depth + t, result);
  if (here) {
    record_first_surface(scene_, settings_, surface, normal, result);
    vectors_.record(surface, result);
  }
  record.seen |= here;
  if (passes.mist())
    result.mist += (1.0f - mist_at(scene_, camera_, settings_, surface)) * mean(path.beta * opacity);
  add_mattes(scene_, layout_, path.sample, surface.instance, material, mean(path.beta) * mean(opacity), *extras_);
}

void PathFilm::pass_absent(Path &path, const Ray &ray, HitStage &stage, size_t number, Hit &hit) {
  const uint32_t limit = settings_.transparent_bounces;
  const Hit end = hit;
  // In most cases, the number of surfaces suffices.
  const uint32_t count = stage.passed(number, end);
  if (only_combined_ && !trace_ && count <= path.crossings_left(limit))
    return path.count_crossings(count, limit);
  double passed = 0.0;
  for (const Crossing &crossing : stage.absent(number)) {
    const Hit &met = crossing.hit;
    if (!closer(met.t, met.instance, met.primitive, end))
      break;
    // A path that has reached its limit ends here.
    if (path.crossings_left(limit) == 0) {
      hit = met;
      break;
    }
    // Passes may also record a surface of low opacity.
    if (trace_ || awaits_surface(path)) {
      const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, met);
      if (trace_ && path.ghost == Ghost::None && !path.of_catchers)
        trace(path, surface, met.t);
      if (awaits_surface(path)) {
        const double unit = glm::length(ray.d);
        const View view{.wo = glm::vec3(-glm::normalize(ray.d)),
                        .footprint = float(cone_.base + (path.length + met.t * unit) * cone_.spread),
                        .path = path.light_path((met.t - ray.tmin) * unit / scene_.normalisation.scale, met.t * unit)};
        shader_.shade(surface, view, absent_);
        if (layout_.has_outputs() && !absent_.material->outputs.empty()) {
          const std::span<const glm::vec4> values = shader_.outputs(*absent_.material, surface, view);
          for (const Output &output : absent_.material->outputs)
            add_output(layout_, path.sample, output, value_of(output.value, values), *extras_);
        }
        record(path, surface, *absent_.material, absent_.bsdf.ns, absent_.opacity(), met.t);
      }
    }
    path.count_crossings(1, limit);
    passed = met.t;
  }
  // A surface that the guides do not count may follow.
  if (passed > 0.0 && wants_guides(path)) {
    DenoisingGuides &guides = guides_[path.sample];
    const double distance = passed * glm::length(ray.d);
    add_guide_distance(scene_, camera_, glm::vec3(-glm::normalize(ray.d)), distance, guides, results_[path.sample]);
    guides.counted = distance;
  }
}

bool PathFilm::miss(const Path &path, const Ray &ray) {
  if (path.of_catchers)
    return !path.in_view || !settings_.film_transparent;
  SampleResult &result = results_[path.sample];
  if (awaits_surface(path)) {
    forget_place(result);
    vectors_.record_sky(ray.d, result);
  }
  if (path.scatterings == 0 && passes.guides())
    add_sky_guides(guides_[path.sample], result);
  // A transparent film does not show the environment itself, only the light that it gives. The environment's pass shows both.
  if (!path.in_view || !settings_.film_transparent)
    return true;
  cut(path, mean(path.beta));
  return (settings_.passes & bit(Pass::Environment)) != 0;
}

void PathFilm::fill(WaitingLight &light, const Path &path, const Floats (&share)[2][3], uint32_t lane, uint32_t chosen) const {
  light.target = path.sample;
  light.group = layout_.groups > 0 && !path.caught ? scene_.lights.group_of(scene_.geometry, chosen) : 0;
  light.has_passes = !path.caught;
  light.of_catchers = path.of_catchers;
  light.sum = sum_of(path);
  light.indirect = path.scatterings > 0;
  light.ghost = path.ghost;
  for (int component = 0; component < 2 && passes.components(); ++component)
    light.share[component] = path.in_view ? get(share[component], lane) : shares_[sum(path)].of[component];
}

WaitingLight PathFilm::waiting(const Path &path, uint32_t group) const {
  WaitingLight light;
  light.target = path.sample;
  light.group = path.caught ? 0 : group;
  light.has_passes = !path.caught;
  light.of_catchers = path.of_catchers;
  light.sum = sum_of(path);
  light.indirect = path.scatterings > 1;
  light.ghost = path.ghost;
  light.parts = float(path.sharers);
  for (int component = 0; component < 2 && passes.components() && !path.in_view; ++component)
    light.share[component] = shares_[sum(path)].of[component];
  return light;
}

void PathFilm::set_shares(const Path &path, const Path &next, const Floats (&share)[2][3], uint32_t lane) {
  if (next.in_view || path.of_catchers || !passes.components())
    return;
  const Shares before = shares_[sum(path)];
  for (int component = 0; component < 2; ++component)
    shares_[sum(next)].of[component] = path.in_view ? get(share[component], lane) : before.of[component];
}

void PathFilm::trace(const Path &path, const Surface &surface, double t) {
  trace_->push_back({scene_.normalisation.to_world(surface.p), t / scene_.normalisation.scale, surface.ns, path.beta,
                     gathered(path), surface.instance, surface.primitive, surface.material, path.scatterings});
}

void PathFilm::add_open(const Path &path, const OcclusionStage::Open &open) {
  for (const glm::vec3 &share : open.share)
    results_[path.sample].light[kLightOcclusion] += share;
  records_[path.sample].occlusion = open.by_next;
}

void PathFilm::count_occluded(std::span<const Path> paths, std::span<const Ray> rays, std::span<const Hit> hits,
                              const OcclusionStage &occlusion) {
  for (size_t i = 0; i < paths.size() && passes.occlusion(); ++i) {
    if (paths[i].scatterings != 1 || !paths[i].leads)
      continue;
    const float weight = std::exchange(records_[paths[i].sample].occlusion, 0.0f);
    if (weight > 0.0f && occlusion.occluded(rays[i], hits[i]))
      results_[paths[i].sample].light[kLightOcclusion] -= glm::vec3(weight);
  }
}

} // namespace lancer
