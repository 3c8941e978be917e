// The ways on from a vertex: straight through a surface, by a portal, by a scattering.
#include "integrator/path/path.h"

#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lancer {

namespace {

// Density of directions below which a lobe is so wide that Cycles bevels nothing behind it.
constexpr double kSharpDensity = 8.0;

} // namespace

// Samples the next ray of each path, or several rays in lanes that split.
void PathIntegrator::go_on() {
  uint32_t going = 0;
  for (uint32_t lane = 0; lane < surface_.count(); ++lane)
    going |= uint32_t(!(nothing_ >> lane & 1) && !path_of(lane).last) << lane;
  const uint32_t count = splitting_ ? settings_.splits.paths : 1;
  for (uint32_t branch = 0; branch < count; ++branch) {
    if (splitting_)
      numbers_.draw(kPathNumbers, surface_.count(), splitting_, count, branch);
    scatter_.scatter({surface_.surfaces(), surface_.lobes(), numbers_.numbers, beta_, paths_});
    if (branch == 0 && settings_.ambient > 0.0f)
      add_ambient(going & surface_.lobes().scatters & ~ends_);
    occlusion_.look(occlusion_asked_, surface_, scatter_.next(), numbers_.numbers);
    each_lane(going, [&](uint32_t lane) {
      const bool passes = branch == 0 && path_of(lane).chooses_to_pass(surface_.lobes().pass[lane]);
      // A path that passes straight on has no further branches: branch 0 sends the occlusion rays instead of the leader.
      if (occlusion_asked_ >> lane & 1 && (passes || branch == leader_[lane]))
        look_around(lane);
      if (passes)
        pass_straight(lane);
      else
        scatter(lane, branch);
      going &= ~(uint32_t{passes} << lane);
    });
    going &= splitting_;
  }
}

// Sends the rays of a lane for ambient occlusion.
void PathIntegrator::look_around(uint32_t lane) {
  const Path &path = path_of(lane);
  film_.add_open(path,
                 occlusion_.send(lane, surface_, scatter_.next(), path.sample, path.beta * recorded_opacity(surface_, lane),
                                 path.passed_through, path.asking_path(), shadow_));
}

// Adds the ambient light that diffuse lobes of these lanes reflect, with its occlusion rays.
void PathIntegrator::add_ambient(uint32_t lanes) {
  surface_.describe();
  ambient_.look(lanes, surface_, scatter_.next(), numbers_.numbers);
  each_lane(lanes, [&](uint32_t lane) {
    const Path &path = path_of(lane);
    // As in Cycles, shadow catchers alone have no ambient light.
    if (path.of_catchers)
      return;
    const glm::vec3 matt = get(surface_.means().shown[size_t(Component::Diffuse)], lane);
    const glm::vec3 light = path.beta * surface_.opacity(lane) * matt * settings_.ambient;
    if (light == glm::vec3(0.0f))
      return;
    WaitingLight waiting = film_.waiting(path, scene_.lights.environment().light_group());
    waiting.indirect = path.scatterings > 0;
    waiting.has_passes = false;
    waiting.guessed = true;
    shadow_.push(ambient_.ray(lane, surface_), waiting, light, path.passed_through);
    if (shadow_.asks_light_path())
      shadow_.set_light_path(path.asking_path());
  });
}

// Continues a path straight through a surface, unless the path has reached its limit of passed surfaces.
void PathIntegrator::pass_straight(uint32_t lane) {
  Path path = path_of(lane);
  // The path that a fresh ghost belongs to passes itself.
  if (path.fresh || path.crossings_left(settings_.transparent_bounces) == 0)
    return;
  const Hit &hit = surface_.hit(lane);
  const Ray &ray = surface_.ray(lane);
  Scattering from = queue_.from[path_[lane]];
  from.passed += surface_.distance(lane);
  Ray next = ray_from(surface_.surface(lane), ray.d, ray.tmax - hit.t);
  const bool portal_here = has_portal(lane);
  if (portal_here && !(ends_ >> lane & 1)) {
    if (const Portal *portal = choose_portal(lane, path))
      enter_portal(lane, *portal, next);
    // Cycles weighs no light sample against a ray beyond a portal.
    from = {next.o, glm::vec3(0.0f), true, 0.0, 0.0, from.receiver_set};
    path.story.pass_portal();
  } else {
    // A path after its last bounce enters no portal.
    const glm::vec3 weight = portal_here ? straight_weight(lane) : surface_.transmittance(lane);
    if (portal_here && weight == glm::vec3(0.0f))
      return;
    path.beta *= weight / surface_.lobes().pass[lane];
  }
  film_.pass_on(path, hit.t);
  path.go(surface_.distance(lane));
  path.count_crossings(1, settings_.transparent_bounces);
  next_.paths.push_back(path);
  next_.from.push_back(from);
  next_.rays.push_back(next);
  next_.rays.back().kinds = path.kinds;
}

namespace {

// Reads the parameters of a lane.
auto reader_of(const SurfaceStage &surface, uint32_t lane) {
  const auto value = [&surface, lane](const Parameter &parameter) { return surface.value(parameter, lane); };
  return ParameterReader<float, decltype(value)>{value};
}

} // namespace

glm::vec3 PathIntegrator::portal_weight(uint32_t lane, const Portal &portal) const {
  return counted_portal(reader_of(surface_, lane).color(portal.weight));
}

// Returns the share of light that passes a surface beside its portals.
glm::vec3 PathIntegrator::straight_weight(uint32_t lane) const {
  glm::vec3 straight = surface_.transmittance(lane);
  for (const Portal &portal : surface_.material(lane).portals)
    straight -= portal_weight(lane, portal);
  return glm::max(straight, 0.0f);
}

bool PathIntegrator::has_portal(uint32_t lane) const {
  return std::ranges::any_of(surface_.material(lane).portals,
                             [&](const Portal &portal) { return portal_weight(lane, portal) != glm::vec3(0.0f); });
}

// Chooses among the portals of a surface and the way straight on, and weights the path; null is the way straight on.
const Portal *PathIntegrator::choose_portal(uint32_t lane, Path &path) const {
  const std::span<const Portal> portals = surface_.material(lane).portals;
  const glm::vec3 straight = straight_weight(lane);
  float all = mean(straight);
  for (const Portal &portal : portals)
    all += mean(portal_weight(lane, portal));
  const float pass = surface_.lobes().pass[lane];
  float left = path.way_number(pass) * all;
  const Portal *chosen = nullptr;
  glm::vec3 weight = straight;
  for (const Portal &portal : portals) {
    const glm::vec3 its = portal_weight(lane, portal);
    // Rounding may leave a number beyond the last share: the last way that light takes is chosen then.
    if (left < mean(weight) || its == glm::vec3(0.0f))
      continue;
    left -= mean(weight);
    chosen = &portal;
    weight = its;
  }
  path.beta *= weight * (all / (mean(weight) * pass));
  return chosen;
}

// Sends a ray on from where the portal leads to.
void PathIntegrator::enter_portal(uint32_t lane, const Portal &portal, Ray &ray) const {
  constexpr double kPlace2 = 1e-9; // squared distance in the user's units within which Cycles takes places as one
  const auto read = reader_of(surface_, lane);
  const glm::dvec3 d(read.direction(portal.direction));
  const glm::dvec3 way = d != glm::dvec3(0.0) ? d : surface_.ray(lane).d;
  const glm::dvec3 p = get(surface_.surfaces().p, lane);
  const glm::dvec3 to = portal.moves ? scene_.normalisation.to_normalised(glm::dvec3(read.vector(portal.position))) : p;
  const glm::dvec3 moved = (to - p) / scene_.normalisation.scale;
  ray = ray_from(surface_.surface(lane), way, std::numeric_limits<double>::infinity());
  if (glm::dot(moved, moved) <= kPlace2)
    return;
  ray.o = to;
  ray.skip_instance = ray.skip_primitive = kNone;
}

// Adds the next ray of a lane; branch: its number in a lane that splits.
void PathIntegrator::scatter(uint32_t lane, uint32_t branch) {
  const ScatterBlock &block = scatter_.next();
  const Path &path = path_of(lane);
  if (ends_ >> lane & 1 || !(block.sampled >> lane & 1))
    return;
  if (block.entered >> lane & 1)
    return enter(lane, branch);
  const bool splits = splitting_ >> lane & 1;
  const uint32_t sharers = splits ? settings_.splits.paths : path.sharers;
  glm::vec3 beta = get(block.beta, lane);
  // Ghosts end like the paths for which they stand.
  const float unit = float(sharers) / float(paths_of(path.ghost));
  if (!ScatterStage::survives(path.scatterings + 1, numbers_.numbers.of[kVertexRoulette][lane], unit, beta))
    return;
  Path &next = branch_off(next_.paths, lane, branch);
  next.scatter(beta, scatter_.kind(lane), block.diffuse >> lane & 1, block.transmitted >> lane & 1, block.pdf[lane]);
  next.in_view = path.in_view && film_.stays_in_view(block, lane);
  next.sharp = path.sharp && (block.pdf[lane] == 0.0 || block.pdf[lane] >= kSharpDensity);
  next.go(surface_.distance(lane));
  // As in Cycles, rays from the end of a walk do not spread.
  if (surface_.lobes().spreads && !path.leaving)
    next.spread = std::max(next.spread, std::sqrt(block.mean_alpha2[lane]));
  film_.set_shares(path, next, block.share, lane);
  next_.from.push_back({get(surface_.surfaces().p, lane), get(surface_.lobes().ns, lane),
                        (surface_.lobes().transmits >> lane & 1) != 0, block.pdf[lane], 0.0,
                        surface_.instance(lane).receiver_set});
  Ray &ray = next_.rays.emplace_back();
  scatter_.write_ray(lane, surface_.hit(lane), next.kinds, surface_.surfaces().time[lane], ray);
  if (next.is_fast(settings_)) {
    const double own = surface_.instance(lane).fast_distance, whole = ray.tmax;
    ray.tmax = normalised_reach(own > 0.0 ? own : double(settings_.fast_distance), scene_) / glm::length(ray.d);
    follow_guess(next_.paths.size() - 1, whole);
  }
}

// Appends a copy of a lane's path, which is a branch where the lane splits.
Path &PathIntegrator::branch_off(std::vector<Path> &paths, uint32_t lane, uint32_t branch) const {
  Path &next = paths.emplace_back(path_of(lane));
  if (splitting_ >> lane & 1)
    next.split_off(branch, settings_.splits.paths, leader_[lane]);
  return next;
}

} // namespace lancer
