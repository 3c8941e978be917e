// Vertices of paths that are shaded side by side: into the lanes of a block, through the kernels, and out again.
#include "integrator/lane_access.h"
#include "integrator/path.h"
#include "lancer.h"
#include "sampling/color.h"

#include <bit>
#include <cmath>

namespace lancer {

static_assert(kBlockLanes == kNodeLanes);

void PathIntegrator::put_in_lane(size_t number, const Material &material) {
  const Path &path = paths_[number];
  const Hit &hit = hits_[number];
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const bool ends = path.last || path.scatterings > settings_.max_bounces;
  if (ends && picture_alone_ && !material.emits() && !material.transmits() && !instance.holdout)
    return;
  const uint32_t lane = waiting_count_++, bit = 1u << lane;
  // Part by part: a copy of the whole would wait until they have left the processor's stores.
  Waiting &waiting = waiting_[lane];
  waiting.number = number;
  waiting.ends = ends;
  waiting.nothing = false;
  waiting.far = false;
  waiting.emission = material.emission.value;
  waiting.transmittance = glm::max(material.transmittance.value, 0.0f);
  block_.through[lane] = material.transmits() ? mean(waiting.transmittance) : 0.0f;
  block_.used |= bit;
  if (ends)
    block_.ends |= bit;
  block_.placement[lane] = &instance.to_world.linear[0][0];
  if (instance.kind == ShapeKind::Mesh) {
    const Mesh &mesh = scene_.geometry.meshes[instance.mesh];
    const glm::uvec3 &triangle = mesh.triangles[hit.primitive];
    for (int corner = 0; corner < 3; ++corner)
      put(mesh.positions[triangle[corner]], block_.corner[corner], lane);
    glm::vec3 n[3];
    if (corner_normals(mesh, instance.shading, hit.primitive, n)) {
      for (int corner = 0; corner < 3; ++corner)
        put(n[corner], block_.normals[corner], lane);
      block_.smooth |= bit;
    }
    block_.on_mesh |= bit;
    block_.bary[0][lane] = hit.u;
    block_.bary[1][lane] = hit.v;
  } else if (instance.kind == ShapeKind::Sphere || instance.kind == ShapeKind::Plane) {
    (instance.kind == ShapeKind::Sphere ? block_.on_sphere : block_.on_plane) |= bit;
    put(rays_[number].o, block_.o, lane);
    block_.t[lane] = hit.t;
  }
  put(rays_[number].d, block_.d, lane);
  put(path.beta, block_.beta, lane);
  block_.terminator[lane] = instance.kind == ShapeKind::Mesh ? instance.terminator : 0.0f;
  block_.material[lane] = &material;
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
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    const VertexNumbers u = path.sampler.get8(kDimensionVertex + path.scatterings * kVertexStride);
    for (uint32_t i = 0; i < 8; ++i)
      block_.u[i][lane] = u[i];
  }
}

// As find_surfaces() has found it.
Surface PathIntegrator::surface_of(uint32_t lane) const {
  const Hit &hit = hits_[waiting_[lane].number];
  if (!(block_.on_mesh >> lane & 1))
    return surface_at(scene_.geometry, scene_.slots, rays_[waiting_[lane].number], hit);
  Surface surface;
  surface.p = get(block_.p, lane);
  surface.offset = block_.offset[lane];
  surface.ng = get(block_.ng, lane);
  surface.ns = get(block_.ns, lane);
  surface.bary = {hit.u, hit.v};
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  return surface;
}

// Where each lane's hit is, and what the surface is like there.
void PathIntegrator::find_surfaces() {
  lanes_.surfaces(block_);
  const uint32_t known = (block_.on_mesh | block_.on_sphere | block_.on_plane) & ~block_.odd;
  for (uint32_t lane = 0; lane < waiting_count_; ++lane)
    if (!(known >> lane & 1)) {
      const size_t number = waiting_[lane].number;
      const Surface surface = surface_at(scene_.geometry, scene_.slots, rays_[number], hits_[number]);
      put(surface.p, block_.p, lane);
      put(surface.ng, block_.ng, lane);
      put(surface.ns, block_.ns, lane);
      block_.offset[lane] = surface.offset;
    }
}

// What nodes say in every lane.
void PathIntegrator::ask_nodes() {
  const Material &material = *block_.material[0];
  if (material.fixed())
    return;
  if (!material.surface_nodes.empty()) {
    place_nodes(material);
    node_lanes_.run(material.program, material.surface_nodes, nodes_, values_.data());
  }
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    const Material &of = *block_.material[lane];
    Waiting &waiting = waiting_[lane];
    waiting.emission = value_in_lane(of.emission, lane);
    waiting.transmittance = of.transmits() ? glm::max(value_in_lane(of.transmittance, lane), 0.0f) : glm::vec3(0.0f);
    block_.through[lane] = mean(waiting.transmittance);
  }
}

// Where nodes are asked: at the surfaces of all lanes, with both normals on the viewer's side.
void PathIntegrator::place_nodes(const Material &material) {
  nodes_.used = (1u << waiting_count_) - 1u;
  float side[kBlockLanes];
  nodes_.backfacing = 0;
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    const float facing = block_.ng[0][lane] * block_.wo[0][lane] + block_.ng[1][lane] * block_.wo[1][lane] +
                         block_.ng[2][lane] * block_.wo[2][lane];
    side[lane] = facing < 0.0f ? -1.0f : 1.0f;
    nodes_.backfacing |= uint32_t(facing < 0.0f) << lane;
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      nodes_.p[axis][lane] = block_.p[axis][lane];
      nodes_.wo[axis][lane] = block_.wo[axis][lane];
      nodes_.ns[axis][lane] = side[lane] * block_.ns[axis][lane];
      nodes_.ng[axis][lane] = side[lane] * block_.ng[axis][lane];
    }
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    const size_t number = waiting_[lane].number;
    const Path &path = paths_[number];
    const Hit &hit = hits_[number];
    const double unit = block_.length[lane], way = path.length + hit.t * unit;
    const bool on_mesh = block_.on_mesh >> lane & 1;
    nodes_.instance[lane] = hit.instance;
    nodes_.primitive[lane] = hit.primitive;
    nodes_.bary[0][lane] = on_mesh ? hit.u : 0.0;
    nodes_.bary[1][lane] = on_mesh ? hit.v : 0.0;
    nodes_.footprint[lane] = float(cone_.base + way * cone_.spread);
    if (material.program.asks_light_path)
      put(light_path(path, (hit.t - rays_[number].tmin) * unit), nodes_, lane);
  }
}

// Holes end what the camera sees.
void PathIntegrator::cut_holes(std::span<SampleResult> results) {
  block_.holes = 0;
  if (!(scene_.features & kFeatureHoldout))
    return;
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    Waiting &waiting = waiting_[lane];
    const Path &path = paths_[waiting.number];
    if (path.in_view) {
      const Parameter &holdout = block_.material[lane]->holdout;
      const float share = std::clamp(value_in_lane(holdout, lane).x, 0.0f, 1.0f);
      if (scene_.geometry.instances[hits_[waiting.number].instance].holdout) {
        // All that the object would show becomes the hole.
        results[path.slot].alpha -= mean(path.beta * waiting.opacity());
        waiting.emission = glm::vec3(0.0f);
        waiting.nothing = waiting.transmittance == glm::vec3(0.0f);
        block_.holes |= 1u << lane;
      } else if (share > 0.0f) {
        results[path.slot].alpha -= share * mean(path.beta);
        waiting.nothing = share >= 1.0f;
      }
    }
  }
}

// What passes say of the surfaces that the camera sees.
void PathIntegrator::record_surfaces(std::span<SampleResult> results) {
  uint32_t seen = 0, featured = 0;
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    const Path &path = paths_[waiting_[lane].number];
    put(waiting_[lane].transmittance, block_.transmittance, lane);
    if (waiting_[lane].nothing)
      continue;
    seen |= uint32_t(path.in_view) << lane;
    featured |= uint32_t(passes_.features() && records_[path.slot].features.open) << lane;
  }
  if (!(seen | featured))
    return;
  if (block_.wants_normal | block_.wants_matt_normal | block_.wants_shown | block_.wants_mixture)
    lanes_.describe(block_);
  for (uint32_t rest = seen | featured; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const Waiting &waiting = waiting_[lane];
    const Path &path = paths_[waiting.number];
    const Hit &hit = hits_[waiting.number];
    SampleResult &result = results[path.slot];
    if (seen >> lane & 1) {
      record(path, surface_of(lane), *block_.material[lane], get(block_.normal, lane), waiting.opacity(), hit.t, result);
      for (uint32_t component = 0; component < 3 && passes_.components(); ++component)
        result.light[kLightComponents + 3 * component + 2] += path.beta * get(block_.shown[component], lane);
    }
    if (featured >> lane & 1)
      waiting_[lane].mixture = {get(block_.mixed_normal, lane), get(block_.mixed_diffuse, lane),
                                get(block_.mixed_specular, lane), block_.mixed_all[lane], block_.mixed_matt[lane]};
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
  if (scene_.lights.many().empty())
    return;
  LightWalk walks[kBlockLanes];
  uint32_t lanes[kBlockLanes], count = 0;
  for (uint32_t lane = 0; lane < waiting_count_; ++lane)
    if (block_.chosen[lane] == scene_.lights.size() && block_.chosen_probability[lane] > 0.0 && !waiting_[lane].ends) {
      walks[count] = LightTree::walk(query(lane), block_.chosen_rest[lane]);
      lanes[count++] = lane;
    }
  scene_.lights.many().choose({walks, count});
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
  const FewLights &few = scene_.lights.few();
  if (!few.empty()) {
    block_.light_nodes = few.nodes();
    lanes_.choose(block_);
    choose_of_many();
  }
  for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
    block_.lamp[lane] = &nothing;
    block_.light_pdf[lane] = 0.0;
    block_.light_delta[lane] = block_.light_hidden[lane] = 0;
    if (lane >= waiting_count_ || waiting_[lane].ends || few.empty() || !(block_.scatters >> lane & 1))
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
  const LightSample light = sample_scene_light(scene_, choice, get(block_.p, lane),
                                               {block_.u[kVertexLight][lane], block_.u[kVertexLight + 1][lane]}, shader_);
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
  if (waiting_count_ == 0)
    return;
  for (uint32_t lane = waiting_count_; lane < kBlockLanes; ++lane) {
    block_.material[lane] = block_.material[0];
    block_.placement[lane] = block_.placement[0];
  }
  // Ask what is there.
  draw_numbers();
  find_surfaces();
  ask_nodes();
  cut_holes(results);
  lanes_.lobes(block_);
  if (trace)
    for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
      const Path &path = paths_[waiting_[lane].number];
      keep_vertex(path, surface_of(lane), hits_[waiting_[lane].number].t, results[path.slot], *trace);
    }
  if (!picture_alone_)
    record_surfaces(results);
  // Ask for light, and where each path goes on.
  ask_lights();
  lanes_.scatter(block_);
  for (uint32_t lane = 0; lane < waiting_count_; ++lane)
    if (!waiting_[lane].nothing)
      leave_lane(lane, results[paths_[waiting_[lane].number].slot]);
  waiting_count_ = 0;
  block_.used = block_.on_mesh = block_.on_sphere = block_.on_plane = block_.smooth = block_.ends = 0;
}

void PathIntegrator::send_shadow_of(uint32_t lane) {
  const Waiting &waiting = waiting_[lane];
  const Path &path = paths_[waiting.number];
  const glm::vec3 contribution = get(block_.contribution, lane);
  WaitingLight shares;
  for (int component = 0; component < 2 && passes_.components(); ++component)
    shares.share[component] = path.in_view ? get(block_.light_share[component], lane) : records_[path.slot].share[component];
  if (scene_.lights.no_shadow(waiting.choice.light)) {
    shares.slot = path.slot;
    shares.indirect = path.scatterings > 0;
    return shadows_.push_lit(shares, contribution);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  Ray &ray = shadows_.push(path.slot, contribution, path.scatterings > 0, path.passed_through);
  if (passes_.components())
    shadows_.set_shares(shares.share);
  if (block_.lifted >> lane & 1) {
    LightSample sample;
    sample.wi = get(block_.light_wi, lane);
    sample.target = get(block_.light_target, lane);
    sample.distance = waiting.far ? infinity : 1.0;
    ray = shadow_ray(scene_.geometry, surface_of(lane), get(block_.viewer_ns, lane), get(block_.viewer_ng, lane), sample);
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
  const glm::vec3 emission = waiting.emission + get(block_.emission, lane);
  if (emission != glm::vec3(0.0f))
    add_emission(path, surface_of(lane), emission, result);
  if (DenoisingFeatures &features = records_[path.slot].features; passes_.features() && features.open)
    add_denoising_features(scene_, camera_, waiting.mixture, get(block_.wo, lane), waiting.transmittance,
                           hit.t * block_.length[lane], features, result);
  if (path.last)
    return;
  if (!waiting.ends && (block_.lit >> lane & 1))
    send_shadow_of(lane);
  if (!waiting.ends && path.scatterings == 0 && passes_.occlusion())
    sample_occlusion(lane);
  if (const float pass = block_.pass[lane]; path.chooses_to_pass(pass))
    return pass_straight_on(path, surface_of(lane), rays_[waiting.number], hit.t, waiting.transmittance / pass);
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
      records_[path.slot].share[component] = get(block_.share[component], lane);
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
