// Vertices of paths that are shaded side by side: into the lanes of a block, through the kernels, and out again.
#include "integrator/path/path.h"
#include "integrator/stages/lane_access.h"
#include "lancer.h"
#include "sampling/color.h"

#include <bit>
#include <cmath>

namespace lancer {

void PathIntegrator::put_in_lane(size_t number, const Material &material) {
  const Path &path = paths_[number];
  const Hit &hit = hits_[number];
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const bool ends = path.last || path.scatterings > settings_.max_bounces;
  if (ends && only_combined_ && !material.emits() && !material.transmits() && !instance.holdout)
    return;
  const uint32_t lane = surfaces_.add(rays_[number], hit, material);
  // Part by part: a copy of the whole would wait until they have left the processor's stores.
  Waiting &waiting = waiting_[lane];
  waiting.number = number;
  waiting.ends = ends;
  waiting.nothing = false;
  waiting.far = false;
  block_.ends |= uint32_t{ends} << lane;
  put(path.beta, block_.beta, lane);
  block_.pixel[lane] = path.sampler.pixel();
  // Lanes of one sample and one bounce share the digits that their numbers are made of.
  const uint32_t dimension = kDimensionVertex + path.scatterings * kVertexStride;
  if (lane == 0) {
    block_.dimension = dimension;
    first_sample_ = path.sampler.sample();
    block_.numbers_given = 0;
  } else if (dimension != block_.dimension || path.sampler.sample() != first_sample_) {
    block_.numbers_given = 1;
  }
}

void PathIntegrator::draw_numbers() {
  const Sampler &sampler = paths_[waiting_[0].number].sampler;
  if (!block_.numbers_given) {
    block_.reversed_sample = sampler.reversed_sample();
    for (uint32_t i = 0; i < 8 && block_.dimension + i < kJointDimensions; ++i)
      block_.reversed_point[i] = sobol::reversed_point(sampler.sample(), block_.dimension + i);
    return;
  }
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    const VertexNumbers u = path.sampler.get8(kDimensionVertex + path.scatterings * kVertexStride);
    for (uint32_t i = 0; i < 8; ++i)
      block_.u[i][lane] = u[i];
  }
}

void PathIntegrator::ask_nodes() {
  if (!surfaces_.has_nodes())
    return;
  View views[kBlockLanes];
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    const double t = surfaces_.hit(lane).t, unit = block_.length[lane];
    views[lane] = surfaces_.view(lane, path.length + t * unit, light_path(path, (t - surfaces_.ray(lane).tmin) * unit));
  }
  surfaces_.ask_nodes(views);
}

// Holes end what the camera sees.
void PathIntegrator::cut_holes(std::span<SampleResult> results) {
  block_.holes = 0;
  if (!(scene_.features & kFeatureHoldout))
    return;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    Waiting &waiting = waiting_[lane];
    const Path &path = paths_[waiting.number];
    if (path.in_view) {
      const float share = surfaces_.holdout(lane);
      if (surfaces_.instance(lane).holdout) {
        // All that the object would show becomes the hole.
        results[path.slot].alpha -= mean(path.beta * surfaces_.opacity(lane));
        surfaces_.emission[lane] = glm::vec3(0.0f);
        waiting.nothing = surfaces_.transmittance[lane] == glm::vec3(0.0f);
        block_.holes |= 1u << lane;
      } else if (share > 0.0f) {
        results[path.slot].alpha -= share * mean(path.beta);
        waiting.nothing = share >= 1.0f;
      }
    }
  }
}

LightQuery PathIntegrator::query(uint32_t lane) const {
  return LightQuery(get(block_.p, lane), get(block_.viewer_ns, lane), block_.transmits >> lane & 1);
}

LightSet::Choice PathIntegrator::choose_light(uint32_t lane) const {
  const LightChoice few{block_.chosen[lane], block_.chosen_probability[lane], block_.chosen_rest[lane]};
  if (!(few.probability > 0.0) || scene_.lights.decided(few.number))
    return {few.number, 0, few.probability};
  return scene_.lights.choose_within(scene_.geometry, query(lane), few);
}

// Goes on with the lanes that have chosen the cluster of all lights with a place.
void PathIntegrator::choose_of_many() {
  if (scene_.lights.wide_tree().empty())
    return;
  LightWalk walks[kBlockLanes];
  uint32_t lanes[kBlockLanes], count = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    if (block_.chosen[lane] == scene_.lights.size() && block_.chosen_probability[lane] > 0.0 && !waiting_[lane].ends) {
      walks[count] = LightTree::walk(query(lane), block_.chosen_rest[lane]);
      lanes[count++] = lane;
    }
  scene_.lights.wide_tree().choose({walks, count});
  for (uint32_t i = 0; i < count; ++i) {
    block_.chosen[lanes[i]] = walks[i].number;
    block_.chosen_probability[lanes[i]] *= walks[i].probability;
    block_.chosen_rest[lanes[i]] = walks[i].u;
  }
}

// Chooses a light for every lane; samples those that kernels do not know.
void PathIntegrator::ask_lights() {
  static const Light nothing;
  block_.asked = 0;
  uint32_t skies = 0;
  const BinaryLightTree &few = scene_.lights.binary_tree();
  if (!few.empty()) {
    block_.light_nodes = few.nodes();
    lanes_.choose(block_);
    choose_of_many();
  }
  for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
    block_.lamp[lane] = &nothing;
    block_.light_pdf[lane] = 0.0;
    block_.light_delta[lane] = block_.light_hidden[lane] = 0;
    if (lane >= surfaces_.count() || waiting_[lane].ends || few.empty() || !(block_.scatters >> lane & 1))
      continue;
    const LightSet::Choice choice = choose_light(lane);
    if (!(choice.probability > 0.0))
      continue;
    waiting_[lane].choice = choice;
    block_.light_hidden[lane] = scene_.lights.hidden_from(choice.light);
    block_.light_pdf[lane] = choice.probability;
    if (choice.light < scene_.lights.lights().size()) {
      const Light &lamp = scene_.lights.lights()[choice.light];
      block_.lamp[lane] = &lamp;
      waiting_[lane].far = lamp.kind == LightKind::Sun;
      block_.asked |= 1u << lane;
    } else if (choice.light == scene_.lights.environment_light()) {
      skies |= 1u << lane;
    } else {
      ask_by_hand(lane);
    }
  }
  ask_sky(skies);
}

// A sample of the light that a lane has chosen.
void PathIntegrator::ask_by_hand(uint32_t lane) {
  const LightSet::Choice &choice = waiting_[lane].choice;
  block_.light_pdf[lane] = 0.0;
  const LightSample light =
      sample_scene_light(scene_, choice, get(block_.p, lane), {block_.u[kVertexLight][lane], block_.u[kVertexLight + 1][lane]},
                         shader_, asking_path(paths_[waiting_[lane].number]));
  if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
    return;
  waiting_[lane].far = std::isinf(light.distance);
  put(light.wi, block_.light_wi, lane);
  put(light.target, block_.light_target, lane);
  put(light.radiance, block_.light_radiance, lane);
  block_.light_pdf[lane] = light.pdf * choice.probability;
  block_.light_delta[lane] = light.delta;
}

void PathIntegrator::shade_block(std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  if (surfaces_.count() == 0)
    return;
  // Ask what is there.
  draw_numbers();
  surfaces_.find();
  ask_nodes();
  cut_holes(results);
  surfaces_.find_lobes();
  if (trace)
    for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
      const Path &path = paths_[waiting_[lane].number];
      keep_vertex(path, surfaces_.surface(lane), hits_[waiting_[lane].number].t, results[path.slot], *trace);
    }
  if (!only_combined_)
    record_surfaces(results);
  // Ask for light, and where each path goes on.
  ask_lights();
  lanes_.scatter(block_);
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    if (!waiting_[lane].nothing)
      leave_lane(lane, results[paths_[waiting_[lane].number].slot]);
  block_.ends = block_.occlusion_asked = 0;
  surfaces_.clear();
}

void PathIntegrator::send_shadow_of(uint32_t lane) {
  const Waiting &waiting = waiting_[lane];
  const Path &path = paths_[waiting.number];
  const glm::vec3 contribution = get(block_.contribution, lane);
  WaitingLight shares;
  for (int component = 0; component < 2 && passes_.components(); ++component)
    shares.share[component] = path.in_view ? get(block_.light_share[component], lane) : shares_[path.slot].of[component];
  if (scene_.lights.no_shadow(waiting.choice.light)) {
    shares.slot = path.slot;
    shares.indirect = path.scatterings > 0;
    return shadows_.push_lit(shares, contribution);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  Ray &ray = shadows_.push(path.slot, contribution, path.scatterings > 0, path.passed_through);
  if (passes_.components())
    shadows_.set_shares(shares.share);
  if (shadows_.asks_light_path())
    shadows_.set_light_path(asking_path(path));
  if (block_.lifted >> lane & 1) {
    LightSample sample;
    sample.wi = get(block_.light_wi, lane);
    sample.target = get(block_.light_target, lane);
    sample.distance = waiting.far ? infinity : 1.0;
    ray =
        shadow_ray(scene_.geometry, surfaces_.surface(lane), get(block_.viewer_ns, lane), get(block_.viewer_ng, lane), sample);
  } else {
    const glm::dvec3 o = get(block_.shadow_origin, lane);
    const glm::dvec3 d = waiting.far ? get(block_.light_wi, lane) : get(block_.light_target, lane) - o;
    leave(hits_[waiting.number], o, d, waiting.far ? infinity : 1.0, LANCER_RAY_SHADOW, ray);
  }
}

// Glass that does not count leaves the picture what it was.
bool PathIntegrator::stays_in_view(uint32_t lane) const {
  return settings_.transparent_glass && (block_.transmitted >> lane & 1) && !(block_.diffuse >> lane & 1) &&
         block_.alpha2[lane] <= settings_.glass_alpha2;
}

// What follows from a shaded lane: its light, its shadow ray, its next ray.
void PathIntegrator::leave_lane(uint32_t lane, SampleResult &result) {
  const Waiting &waiting = waiting_[lane];
  Path &path = paths_[waiting.number];
  const Hit &hit = hits_[waiting.number];
  const glm::vec3 emission = surfaces_.emission[lane] + get(block_.emission, lane);
  if (emission != glm::vec3(0.0f))
    add_emission(path, surfaces_.surface(lane), emission, result);
  if (passes_.features() && guides_[path.slot].open)
    add_denoising_guides(scene_, camera_, waiting.mixture, get(block_.wo, lane), surfaces_.transmittance[lane],
                         hit.t * block_.length[lane], guides_[path.slot], result);
  if (path.last)
    return;
  if (!waiting.ends && (block_.lit >> lane & 1))
    send_shadow_of(lane);
  if (block_.occlusion_asked >> lane & 1)
    look_around(lane, result);
  if (const float pass = block_.pass[lane]; path.chooses_to_pass(pass))
    return pass_straight_on(path, surfaces_.surface(lane), rays_[waiting.number], hit.t, surfaces_.transmittance[lane] / pass);
  if (waiting.ends || !(block_.sampled >> lane & 1))
    return;
  const uint32_t scatterings = path.scatterings + 1;
  glm::vec3 beta = get(block_.next_beta, lane);
  if (!survives(scatterings, block_.u[kVertexRoulette][lane], beta))
    return;
  Path &next = next_paths_.emplace_back(path.sampler, path.slot);
  next.in_view = path.in_view && stays_in_view(lane);
  if (path.in_view && !next.in_view && passes_.components())
    for (int component = 0; component < 2; ++component)
      shares_[path.slot].of[component] = get(block_.share[component], lane);
  next.beta = beta;
  next.from = get(block_.p, lane);
  next.normal = get(block_.viewer_ns, lane);
  next.transmits = block_.transmits >> lane & 1;
  next.pdf = block_.pdf[lane];
  next.scatterings = scatterings;
  next.kinds = block_.transmitted >> lane & 1 ? LANCER_RAY_TRANSMISSION
               : block_.diffuse >> lane & 1   ? LANCER_RAY_DIFFUSE
                                              : LANCER_RAY_GLOSSY;
  next.passed_through = path.passed_through;
  next.story = path.story;
  next.story.scatter(block_.diffuse >> lane & 1, block_.transmitted >> lane & 1, block_.pdf[lane] == 0.0);
  next.length = path.length + hit.t * block_.length[lane];
  leave(hit, get(block_.next_origin, lane), glm::dvec3(get(block_.wi, lane)), std::numeric_limits<double>::infinity(),
        next.kinds, next_rays_.emplace_back());
}

} // namespace lancer
