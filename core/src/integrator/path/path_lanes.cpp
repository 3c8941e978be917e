// Shading the vertices of paths in lanes: into a block, through the kernels, and out again.
#include "integrator/path/path.h"
#include "integrator/stages/lane_access.h"
#include "lancer.h"
#include "sampling/color.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lancer {

void PathIntegrator::put_in_lane(size_t number, const Material &material) {
  const Path &path = paths_[number];
  const Hit &hit = hits_[number];
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const bool ends = path.last || path.scatterings > settings_.max_bounces;
  if (ends && film_.only_combined() && !material.emits() && !material.transmits() && !instance.holdout)
    return;
  const uint32_t lane = surfaces_.add(rays_[number], hit, material);
  // Member by member: a copy of the whole would stall on the pending stores of its members.
  Waiting &waiting = waiting_[lane];
  waiting.number = number;
  waiting.ends = ends;
  waiting.nothing = false;
  waiting.leader = 0;
  block_.ends |= uint32_t{ends} << lane;
  put(path.beta, block_.beta, lane);
  block_.pixel[lane] = path.sampler.pixel();
  // Lanes of one bounce draw their random numbers together.
  const uint32_t dimension = path.vertex_dimension();
  if (lane == 0) {
    block_.dimension = dimension;
    one_bounce_ = true;
  } else if (dimension != block_.dimension) {
    one_bounce_ = false;
  }
}

// Finds the lanes whose samples split here.
void PathIntegrator::split() {
  splitting_ = 0;
  if (!settings_.splits.any())
    return;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Waiting &waiting = waiting_[lane];
    const bool splits = !waiting.ends && !paths_[waiting.number].split && (block_.scatters >> lane & 1);
    splitting_ |= uint32_t{splits} << lane;
    block_.lights[lane] = splits ? settings_.splits.lights : 1u;
    block_.paths[lane] = splits ? settings_.splits.paths : 1u;
    if (splits)
      waiting_[lane].leader = paths_[waiting.number].leader_of(settings_.splits.paths);
  }
}

// Draws the requested random numbers, bits of u, in all lanes. In a lane that splits, light or path n of count takes the
// numbers of the sample count * s + n, where s is the number of the lane's sample. Together, the branches are then distributed
// as evenly as the samples of an unsplit sequence. A path keeps its new sample number until its end.
void PathIntegrator::draw_numbers(uint32_t wanted, uint32_t count, uint32_t number) {
  const uint32_t joint = std::min(8u, kJointDimensions - std::min(block_.dimension, kJointDimensions));
  uint32_t last = 0, points[8] = {};
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    const uint32_t own = path.sampler.sample(), sample = splitting_ >> lane & 1 ? own * count + number : own;
    if (!one_bounce_) {
      const auto u = Sampler(path.sampler.pixel(), sample).get8(path.vertex_dimension());
      for (uint32_t i = 0; i < 8; ++i)
        if (wanted >> i & 1)
          block_.u[i][lane] = u[i];
      continue;
    }
    // Neighbours mostly have the same sample number, and so the same digits.
    if (lane == 0 || sample != last)
      for (uint32_t i = 0; i < joint; ++i)
        points[i] = sobol::reversed_point(sample, block_.dimension + i);
    last = sample;
    block_.reversed_sample[lane] = sobol::reverse_bits(sample);
    for (uint32_t i = 0; i < joint; ++i)
      block_.reversed_point[i][lane] = points[i];
  }
  if (one_bounce_)
    lanes_.draw(block_, wanted);
}

void PathIntegrator::ask_nodes() {
  if (!surfaces_.has_nodes())
    return;
  View views[kBlockLanes];
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    const double t = surfaces_.hit(lane).t, unit = block_.length[lane];
    const double way = (t - surfaces_.ray(lane).tmin) * unit / scene_.normalisation.scale;
    views[lane] = surfaces_.view(lane, path.length + t * unit, path.light_path(way));
  }
  surfaces_.ask_nodes(views);
}

// Cuts holdouts out of the camera's view.
void PathIntegrator::cut_holes() {
  block_.holes = 0;
  if (!(scene_.features & kFeatureHoldout))
    return;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    Waiting &waiting = waiting_[lane];
    const Path &path = paths_[waiting.number];
    if (path.in_view) {
      const float share = surfaces_.holdout(lane);
      if (surfaces_.instance(lane).holdout) {
        // The object's whole share of the pixel becomes a hole.
        film_.cut(path, mean(path.beta * surfaces_.opacity(lane)));
        surfaces_.emission[lane] = glm::vec3(0.0f);
        waiting.nothing = surfaces_.transmittance[lane] == glm::vec3(0.0f);
        block_.holes |= 1u << lane;
      } else if (share > 0.0f) {
        film_.cut(path, share * mean(path.beta));
        waiting.nothing = share >= 1.0f;
      }
    }
  }
}

// Samples a light in every lane whose path continues, or several lights in a lane that splits.
void PathIntegrator::ask_lights() {
  uint32_t asking = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    asking |= uint32_t(!waiting_[lane].ends) << lane;
  const uint32_t count = splitting_ ? settings_.splits.lights : 1;
  for (uint32_t number = 0; number < count; ++number) {
    if (splitting_)
      draw_numbers(kLightNumbers, count, number);
    lights_.ask(asking, [&](uint32_t lane) { return paths_[waiting_[lane].number].asking_path(); });
    lanes_.light(block_);
    for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
      if ((asking & block_.lit) >> lane & 1 && !waiting_[lane].nothing)
        send_shadow_of(lane);
    asking &= splitting_;
  }
}

// Samples the next ray of each path, or several rays in lanes that split.
void PathIntegrator::go_on() {
  uint32_t going = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    going |= uint32_t(!waiting_[lane].nothing && !paths_[waiting_[lane].number].last) << lane;
  const uint32_t count = splitting_ ? settings_.splits.paths : 1;
  for (uint32_t number = 0; number < count; ++number) {
    if (splitting_)
      draw_numbers(kPathNumbers, count, number);
    lanes_.scatter(block_);
    for (uint32_t rest = going; rest != 0; rest &= rest - 1) {
      const uint32_t lane = uint32_t(std::countr_zero(rest));
      // A path that passes straight on has no further branches: its first one looks around in the leader's place.
      const bool looks =
          number == waiting_[lane].leader || (number == 0 && paths_[waiting_[lane].number].chooses_to_pass(block_.pass[lane]));
      if (block_.occlusion_asked >> lane & 1 && looks)
        look_around(lane);
      if (number == 0 && passes_straight(lane))
        going &= ~(1u << lane);
      else
        scatter_lane(lane, number);
    }
    going &= splitting_;
  }
}

void PathIntegrator::shade_block() {
  if (surfaces_.count() == 0)
    return;
  // Find surfaces and lobes.
  surfaces_.find();
  ask_nodes();
  cut_holes();
  surfaces_.find_lobes();
  for (uint32_t lane = 0; trace_ && lane < surfaces_.count(); ++lane)
    keep_vertex(paths_[waiting_[lane].number], surfaces_.surface(lane), surfaces_.hit(lane).t);
  if (!film_.only_combined())
    record_surfaces();
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    if (!waiting_[lane].nothing)
      take_emission(lane);
  // Sample lights and next rays.
  split();
  if (!splitting_)
    draw_numbers(kLightNumbers | kPathNumbers, 1, 0);
  ask_lights();
  go_on();
  block_.ends = block_.occlusion_asked = 0;
  surfaces_.clear();
}

// Fills the passes of the surfaces that the camera sees. As in Cycles, a surface that ends the path gives only its emission;
// the guides count its distance, unless it lies behind too many transparent layers.
void PathIntegrator::record_surfaces() {
  uint32_t seen = 0, guiding = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    if (waiting_[lane].nothing)
      continue;
    seen |= uint32_t(path.in_view && !waiting_[lane].ends) << lane;
    guiding |= uint32_t(film_.wants_guides(path) && !path.last) << lane;
  }
  if (!(seen | guiding))
    return;
  surfaces_.describe();
  for (uint32_t rest = seen; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const Waiting &waiting = waiting_[lane];
    const Path &path = paths_[waiting.number];
    block_.occlusion_asked |= uint32_t(passes_.occlusion() && path.scatterings == 0) << lane;
    // In most cases, the position suffices.
    Surface surface;
    if (path.is_first(settings_.splits.paths) || passes_.uv())
      surface = surfaces_.surface(lane);
    else
      surface.p = get(block_.p, lane);
    film_.record(path, surface, *block_.material[lane], get(block_.normal, lane), recorded_opacity(lane),
                 hits_[waiting.number].t);
    for (uint32_t component = 0; component < 3 && passes_.components(); ++component)
      film_.add_color(path, component, get(block_.shown[component], lane));
  }
  for (uint32_t rest = guiding; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    waiting_[lane].mixture = surfaces_.mixture(lane);
  }
}

// Whether a path stays in the camera's view, which continues through clear glass.
bool PathIntegrator::stays_in_view(uint32_t lane) const {
  return settings_.transparent_glass && (block_.transmitted >> lane & 1) && !(block_.diffuse >> lane & 1) &&
         block_.alpha2[lane] <= settings_.glass_alpha2;
}

// Adds the surface's own emission, and its denoising guides.
void PathIntegrator::take_emission(uint32_t lane) {
  const Waiting &waiting = waiting_[lane];
  const Path &path = paths_[waiting.number];
  const glm::vec3 emission = surfaces_.emission[lane] + get(block_.emission, lane);
  if (emission != glm::vec3(0.0f))
    add_emission(path, surfaces_.surface(lane), emission);
  if (!path.last && film_.wants_guides(path))
    film_.add_guides(path, waiting.mixture, get(block_.wo, lane), surfaces_.transmittance[lane],
                     hits_[waiting.number].t * block_.length[lane]);
}

// Chooses at random whether a lane's path passes straight through the surface. Continues such a path, and returns whether the
// path passes.
bool PathIntegrator::passes_straight(uint32_t lane) {
  Path &path = paths_[waiting_[lane].number];
  const float pass = block_.pass[lane];
  if (!path.chooses_to_pass(pass))
    return false;
  pass_straight_on(path, surfaces_.surface(lane), rays_[waiting_[lane].number], hits_[waiting_[lane].number].t,
                   surfaces_.transmittance[lane] / pass);
  return true;
}

// Adds the next ray of a lane; number: of the branch in a lane that splits.
void PathIntegrator::scatter_lane(uint32_t lane, uint32_t number) {
  const Waiting &waiting = waiting_[lane];
  const Path &path = paths_[waiting.number];
  const Hit &hit = hits_[waiting.number];
  if (waiting.ends || !(block_.sampled >> lane & 1))
    return;
  const bool splits = splitting_ >> lane & 1;
  const uint32_t scatterings = path.scatterings + 1, sharers = splits ? settings_.splits.paths : path.sharers;
  glm::vec3 beta = get(block_.next_beta, lane);
  if (!survives(scatterings, block_.u[kVertexRoulette][lane], float(sharers), beta))
    return;
  Path &next = next_paths_.emplace_back(
      splits ? Sampler(path.sampler.pixel(), path.sampler.sample() * sharers + number) : path.sampler, path.slot);
  next.branch = splits ? number : path.branch;
  next.sharers = sharers;
  next.split = path.split || splits;
  next.leads = path.leads && number == waiting.leader;
  next.in_view = path.in_view && stays_in_view(lane);
  if (!next.in_view && passes_.components())
    for (int component = 0; component < 2; ++component)
      film_.shares(next)[component] = path.in_view ? get(block_.share[component], lane) : film_.shares(path)[component];
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
