#include "integrator/path/path.h"

#include "scene/enums.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>

namespace lancer {

void PathIntegrator::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                         std::vector<PathVertex> *trace) {
  // Start one path per sample.
  film_.begin(addresses, results, extras_, trace);
  start(addresses, results);
  const auto gathered = [&](uint32_t sample) { return film_.gathered(sample); };
  for (uint32_t turn = 0; !(queue_.paths.empty() && below_.empty()) && !settings_.cancelled(); ++turn) {
    // Find the next hit of every path; a bake begins at hits.
    if (!at_texels_)
      find_hits();
    // Add the light that rays run into, light the hits, and sample the next direction of each path.
    shade();
    at_texels_ = false;
    // Keep the light before the last bounces, from which the light beyond them is estimated.
    if (last_bounces_.due(turn))
      last_bounces_.note(
          turn, queue_.paths.size(), settings_.splits.paths > 1 || walk_ || haunted_ || guesses_ || catches_,
          [&](size_t i) { return queue_.paths[i].sample; }, gathered);
    // Add the light samples that no surface occludes.
    counts_.shadow +=
        shadow_.trace([&](const WaitingLight &waiting, const glm::vec3 &light) { film_.add_lit(waiting, light); });
    counts_.bounce += next_.rays.size();
    std::swap(queue_, next_);
  }
  last_bounces_.end(gathered, film_.energy);
  film_.end();
  energy_ = film_.energy;
}

void PathIntegrator::start(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  queue_.clear();
  // A batch that was cancelled may have left walks.
  below_.clear();
  walks_.clear();
  last_bounces_.begin();
  const auto begin = [&](uint32_t sample, const Sampler &sampler) -> Ray & {
    queue_.paths.emplace_back(sampler, sample);
    return queue_.rays.emplace_back();
  };
  at_texels_ = texels_.has_value();
  if (at_texels_)
    texels_->start(addresses, film_.passes.wanted(), results, hits_, begin);
  else
    camera_.start(addresses, film_.passes.wanted(), results, begin);
  queue_.from.resize(queue_.rays.size());
  for (size_t i = 0; i < queue_.rays.size(); ++i)
    queue_.from[i].p = queue_.rays[i].o;
  for (size_t i = 0; i < queue_.rays.size() && scene_.features & kFeatureMipmaps; ++i) {
    queue_.paths[i].width = at_texels_ ? texels_->width(queue_.paths[i].sample) : float(width_at_eye_);
    queue_.paths[i].spread = at_texels_ ? 0.0f : float(spread_at_eye_(queue_.rays[i].d));
  }
  counts_.camera += queue_.paths.size();
}

void PathIntegrator::find_hits() {
  // Let rays pass absent surfaces, up to the limit of each path.
  left_.clear();
  for (size_t i = 0; i < queue_.paths.size() && hit_.crosses(); ++i)
    left_.push_back(queue_.paths[i].crossings_left(settings_.transparent_bounces));
  hit_.find(queue_.rays, left_, hits_);
  for (size_t i = 0; i < left_.size(); ++i)
    if (hit_.passed(i, hits_[i]) > 0)
      film_.pass_absent(queue_.paths[i], queue_.rays[i], hit_, i, hits_[i]);
}

void PathIntegrator::shade() {
  next_.clear();
  // Add lamps; sort the hits into queues; add the environment.
  if (!at_texels_)
    add_lamps();
  if (linked_)
    add_linked_lights();
  if (haunted_)
    send_ghosts();
  if (catches_)
    send_among_catchers();
  film_.count_occluded(queue_.paths, queue_.rays, hits_, occlusion_);
  missed_.clear();
  queues_.begin();
  for (size_t i = 0; i < queue_.paths.size(); ++i)
    if (hits_[i].valid()) {
      queues_.add(i, hits_[i]);
    } else {
      if (film_.wants_outputs(queue_.paths[i]))
        film_.add_sky_outputs(queue_.paths[i], queue_.rays[i], queue_.from[i].p);
      const bool shown = queue_.paths[i].shows_light(hidden_of_catcher(scene_.world.hidden_from));
      if (film_.miss(queue_.paths[i], queue_.rays[i]) && shown)
        missed_.push_back(i);
    }
  add_environment();
  shade_queued();
  leave();
}

// Shades the hits of the queues in blocks, one class of materials after the other.
void PathIntegrator::shade_queued() {
  vertices_ += queues_.size();
  queues_.each([&](std::span<const ShadingQueues::Queued> met) {
    for (size_t i = 0; i < met.size(); ++i) {
      if (i + 1 < met.size())
        textures_.ahead(hits_[met[i + 1].number]);
      put_in_lane(met[i].number, *met[i].material);
      if (surface_.full())
        shade_block();
    }
    shade_block();
  });
}

// Adds the lamps on the way of each ray, with the weight of multiple importance sampling.
void PathIntegrator::add_lamps() {
  for (const MetLight &met :
       met_.find(queue_.rays, hits_, queue_.from, [&](size_t ray) { return queue_.paths[ray].asking_path(); })) {
    const Path &path = queue_.paths[met.ray];
    if (path.shows_light(scene_.lights.hidden_from(met.light)))
      film_.add(path, path.beta * met.radiance * met.weight, false, scene_.lights.lamps()[met.light].light_group);
  }
}

// Queues the lights that pass blockers, on the way of each ray that leaves a scattering, with their shadow rays.
void PathIntegrator::add_linked_lights() {
  const auto path_at = [&](size_t ray, double distance) {
    return queue_.paths[ray].light_path(distance / scene_.normalisation.scale, distance);
  };
  for (const LinkedLight &met : linked_->find(
           queue_.rays, queue_.from, [&](size_t ray) { return queue_.paths[ray].asking_path(); }, path_at)) {
    const Path &path = queue_.paths[met.ray];
    const glm::vec3 contribution = path.beta * met.radiance * met.weight;
    if (!path.shows_light(met.hidden_from) || contribution == glm::vec3(0.0f))
      continue;
    Ray ray = queue_.rays[met.ray];
    if (const bool far = std::isinf(met.target.x); !far) {
      ray.d = met.target - ray.o;
      ray.tmax = 1.0;
    }
    ray.kinds = path.of_catchers ? among_catchers(RayKind::Shadow) : uint32_t(RayKind::Shadow);
    shadow_.push(ray, film_.waiting(path, met.group), contribution, path.passed_through, met.links);
  }
}

// Adds the environment that paths see behind all surfaces, and that behind shadow catchers to its pass.
void PathIntegrator::add_environment() {
  add_environment(missed_, [&](const Path &path, const glm::vec3 &radiance, float weight) {
    film_.add(path, seen_beta(path) * radiance * weight, true, scene_.lights.environment().light_group());
  });
  add_environment(behind_, [&](const Path &path, const glm::vec3 &radiance, float) { film_.add_behind(path, radiance); });
}

// Calls arrive(path, radiance, weight) for paths that see the environment. A constant one that is no light that is sampled has
// the weight 1.
template <class Arrive> void PathIntegrator::add_environment(std::span<const size_t> paths, Arrive &&arrive) {
  const Environment &environment = scene_.lights.environment();
  const bool is_looked_at = environment.varies() || environment.is_light();
  for (size_t i = 0; i < paths.size() && !is_looked_at; ++i)
    arrive(queue_.paths[paths[i]], environment.constant(), 1.0f);
  for (size_t first = 0; first < paths.size() && is_looked_at; first += kBlockLanes) {
    const auto now = paths.subspan(first, std::min<size_t>(kBlockLanes, paths.size() - first));
    for (uint32_t lane = 0; lane < now.size(); ++lane) {
      const Path &path = queue_.paths[now[lane]];
      const Scattering &from = queue_.from[now[lane]];
      met_.add_miss(lane, from, queue_.rays[now[lane]].d, path.light_path(0.0, 0.0),
                    path.kinds & kCameraKinds ? &from.p : nullptr);
    }
    met_.look_at_sky(uint32_t(now.size()));
    for (uint32_t lane = 0; lane < now.size(); ++lane)
      arrive(queue_.paths[now[lane]], met_.sky_radiance(lane), met_.sky_weight(lane, queue_.from[now[lane]]));
  }
}

// Adds a hit to the block. Skips a hit that neither scatters, emits, passes light nor cuts a hole, and that no pass reads.
// max_bounces counts the scatterings after the first.
void PathIntegrator::put_in_lane(size_t number, const MaterialView &material) {
  const Path &path = queue_.paths[number];
  const Hit &hit = hits_[number];
  const bool ends = path.is_spent(settings_) || path.is_over_limit(settings_);
  if (ends && !film_.reads_end(path) && !material.emits() && !material.is_transparent() &&
      !scene_.geometry.instances[hit.instance].holdout)
    return;
  const uint32_t lane = surface_.add(queue_.rays[number], hit, material, ends);
  if (walk_) {
    const double way = path.length + hit.t * glm::length(queue_.rays[number].d);
    surface_.place_path(lane, path.after_diffuse, path.leaving, path.dimmed, surface_.pixel_width(way));
  }
  if (surface_.limits())
    surface_.limit(lane, path.lacks_caustics(), path.fresh && path.ghost == Ghost::Caustics,
                   path.least_alpha(settings_.filter_glossy));
  if (settings_.even_choices && path.scatterings + path.passed_through == 0)
    surface_.even_choices(lane);
  if (material.estimates)
    surface_.set_key(lane, path.estimates_key());
  path_[lane] = number;
  leader_[lane] = 0;
  ends_ |= uint32_t{ends} << lane;
  put(path.beta, beta_, lane);
  numbers_.set(lane, path.sampler, path.vertex_dimension());
}

void PathIntegrator::shade_block() {
  const uint32_t count = surface_.count();
  if (count == 0)
    return;
  uint32_t outputs_wanted = 0;
  for (uint32_t lane = 0; lane < count; ++lane)
    outputs_wanted |= uint32_t{film_.wants_outputs(path_of(lane))} << lane;
  // Find the surfaces and what their nodes say there, cut holes, and build the lobes.
  surface_.find();
  surface_.ask_nodes(
      [&](uint32_t lane) {
        const Path &path = path_of(lane);
        const double unit = surface_.surfaces().length[lane], t = surface_.hit(lane).t;
        View view = surface_.view(lane, path.length + t * unit,
                                  path.light_path((t - surface_.ray(lane).tmin) * unit / scene_.normalisation.scale, t * unit));
        if (at_texels_ && !path.leaving)
          view.footprint = texels_->width(path.sample);
        view.pixel = path.sampler.pixel();
        view.sample = path.sampler.sample();
        view.dimension = path.nodes_dimension();
        view.sharp = path.sharp;
        return view;
      },
      outputs_wanted != 0);
  each_lane(outputs_wanted, [&](uint32_t lane) { film_.add_outputs(path_of(lane), surface_, lane); });
  cut_holdouts();
  surface_.lack(at_texels_ ? settings_.bake->lacks : 0);
  surface_.build_lobes();
  if (at_texels_)
    cut_transparency();
  // Fill the passes, and add the light that the surfaces emit.
  occlusion_asked_ = film_.record(surface_, queue_.paths, path_, ends_, nothing_);
  for (uint32_t lane = 0; lane < count; ++lane)
    if (!(nothing_ >> lane & 1))
      add_emission(lane);
  // Sample lights and next rays.
  split();
  if (!splitting_)
    numbers_.draw(kLightNumbers | kPathNumbers, count);
  light();
  go_on();
  ends_ = 0;
  surface_.clear();
}

// Cuts holdouts out of the camera's view.
void PathIntegrator::cut_holdouts() {
  uint32_t seen = 0;
  for (uint32_t lane = 0; lane < surface_.count(); ++lane)
    seen |= uint32_t{path_of(lane).in_view} << lane;
  const SurfaceStage::Holes holes = surface_.cut_holdouts(seen);
  each_lane(holes.cut, [&](uint32_t lane) { film_.cut(path_of(lane), surface_.cut_alpha(lane, path_of(lane).beta)); });
  nothing_ = holes.nothing;
}

// Makes holes of what passes straight through the surface of a bake, as Cycles does.
void PathIntegrator::cut_transparency() {
  for (uint32_t lane = 0; lane < surface_.count(); ++lane)
    film_.cut(path_of(lane), mean(surface_.transmittance(lane)));
  surface_.stop_straight();
}

// Adds the light that a surface emits, weighted against light samples, and its denoising guides.
void PathIntegrator::add_emission(uint32_t lane) {
  const Path &path = path_of(lane);
  if (path.leaving || path.fresh)
    return;
  const glm::vec3 emission = surface_.emission(lane);
  if (emission != glm::vec3(0.0f))
    film_.add(path, path.beta * emission * met_.emission_weight(queue_.from[path_[lane]], surface_.surface(lane)), false,
              surface_.instance(lane).light_group);
  if (!path.last && film_.wants_guides(path))
    film_.add_guides(path, surface_.mixture(lane), get(surface_.surfaces().wo, lane), surface_.transmittance(lane),
                     surface_.distance(lane));
}

// Finds the lanes whose samples split here.
void PathIntegrator::split() {
  splitting_ = 0;
  const Splits &splits = settings_.splits;
  for (uint32_t lane = 0; lane < surface_.count() && splits.any(); ++lane) {
    const uint32_t scatters = surface_.lobes().scatters | surface_.lobes().enters;
    const bool here = !(ends_ >> lane & 1) && !path_of(lane).split && (scatters >> lane & 1);
    splitting_ |= uint32_t{here} << lane;
    lights_[lane] = here ? splits.lights : 1u;
    paths_[lane] = here ? splits.paths : 1u;
    leader_[lane] = here ? path_of(lane).leader_of(splits.paths) : 0;
  }
}

// Samples a light in every lane that may scatter light, or several lights in a lane that splits.
void PathIntegrator::light() {
  uint32_t asking = ((1u << surface_.count()) - 1u) & ~ends_;
  if (scene_.lights.linked())
    each_lane(asking, [&](uint32_t lane) { light_.receive(lane, surface_.instance(lane).receiver_set); });
  const uint32_t count = splitting_ ? settings_.splits.lights : 1;
  for (uint32_t number = 0; number < count; ++number) {
    if (splitting_)
      numbers_.draw(kLightNumbers, surface_.count(), splitting_, count, number);
    light_.ask(asking, surface_.surfaces(), surface_.lobes(), numbers_.numbers,
               [&](uint32_t lane) { return asking_path(lane); });
    light_.light({surface_.surfaces(), surface_.lobes(), beta_, lights_});
    each_lane(asking & light_.lit().lit & ~nothing_, [&](uint32_t lane) { send_shadow(lane); });
    asking &= splitting_;
  }
}

// Returns what nodes of a light and of surfaces before it read of a light sample of a lane. The ray spreads like the widest
// lobe: where a narrow one gives most of the light, the path's own rays find it. From the end of a walk it does not spread, as
// in Cycles.
LightPath<float> PathIntegrator::asking_path(uint32_t lane) const {
  const Path &path = path_of(lane);
  LightPath<float> asking = path.asking_path();
  if (!surface_.lobes().spreads)
    return asking;
  asking.width = path.width + float(surface_.distance(lane)) * path.spread;
  asking.spread = path.leaving ? path.spread : std::max(path.spread, std::sqrt(surface_.lobes().widest[lane]));
  return asking;
}

// Queues a lane's light sample with its shadow ray.
void PathIntegrator::send_shadow(uint32_t lane) {
  const Path &path = path_of(lane);
  const uint32_t chosen = light_.chosen(lane);
  const auto fill = [&](WaitingLight &waiting) {
    film_.fill(waiting, path, light_.lit().share, lane, chosen);
    waiting.parts = float(lights_[lane]) * float(path.sharers);
    // A limit of a lamp leaves its light samples out.
    if (scene_.lights.is_spent(chosen, path.scatterings))
      waiting.ghost = Ghost::Bounces;
  };
  // Lights of other objects are hidden from a path among shadow catchers.
  if (path.of_catchers && (scene_.lights.hidden_from(chosen) & kOfCatchers) == kOfCatchers)
    return;
  Ray &ray = shadow_.push(get(light_.lit().contribution, lane), path.passed_through, scene_.lights.links(chosen), fill);
  if (scene_.lights.no_shadow(chosen))
    return ShadowStage::leave_out(ray);
  if (shadow_.asks_light_path())
    shadow_.set_light_path(asking_path(lane));
  write_shadow_ray(scene_, surface_, lane, light_.samples(), light_.lit(), ray);
  if (path.of_catchers)
    ray.kinds = among_catchers(ray.kinds);
}

} // namespace lancer
