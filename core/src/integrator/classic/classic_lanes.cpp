// Vertices of the recursion in lanes: their surfaces, their passes, and the light of every lamp.
#include "integrator/classic/classic.h"

#include "compile/mesh_normals.h"
#include "integrator/aov/first_surface.h"
#include "integrator/stages/lane_access.h"
#include "sampling/color.h"

#include <bit>

namespace lancer {

namespace {

// Each lamp at each depth has its own dimensions, after those of a path.
constexpr uint32_t kDimensionLamp = 1u << 24;

template <class Visit> void each_lane(uint32_t lanes, const Visit &visit) {
  for (; lanes != 0; lanes &= lanes - 1)
    visit(uint32_t(std::countr_zero(lanes)));
}

} // namespace

const ClassicKernel &classic_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(classic_kernel); }

void ClassicIntegrator::shade(std::span<SampleResult> results) {
  queues_.begin();
  own_light_.begin(rays_.size());
  shadow_light_.begin(rays_.size());
  lit_.resize(rays_.size());
  if (passes_.features())
    features_.resize(rays_.size());
  for (size_t i = 0; i < rays_.size(); ++i)
    if (hits_[i].valid())
      queues_.add(i, hits_[i]);
  vertices_.wide += queues_.size();
  queues_.each([&](std::span<const ShadingQueues::Met> met) {
    for (const ShadingQueues::Met &one : met)
      put_in_lane(one.number, *one.material, results);
    shade_block(results);
  });
  own_light_.sort();
}

void ClassicIntegrator::put_in_lane(size_t number, const Material &material, std::span<SampleResult> results) {
  const Hit &hit = hits_[number];
  const Ray &ray = rays_[number];
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const bool corners = instance.kind == ShapeKind::Mesh && instance.shading == Shading::Gouraud;
  if (surfaces_.full() || corners != corners_)
    shade_block(results);
  corners_ = corners;
  if (is_flat(instance)) {
    // Rays that leave the surface start on the centre's triangle.
    Hit &center = lit_at_[surfaces_.count()];
    center = center_hit(scene_.geometry.meshes[instance.mesh], hit);
    const uint32_t lane = surfaces_.add(ray, center, material);
    const Surface surface = surface_at_center(scene_, hit);
    surfaces_.give(lane, surface, view_of(branches_[number], ray, surface.p));
    number_[lane] = uint32_t(number);
    return;
  }
  number_[surfaces_.add(ray, hit, material)] = uint32_t(number);
}

void ClassicIntegrator::shade_block(std::span<SampleResult> results) {
  if (surfaces_.count() == 0)
    return;
  surfaces_.find();
  ask_nodes();
  cut_holes(results);
  surfaces_.find_lobes();
  if (!only_combined_)
    record(results);
  kernel_.branch(block_);
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    keep(lane);
  if (corners_)
    light_corners();
  else
    light_block();
  surfaces_.clear();
}

void ClassicIntegrator::ask_nodes() {
  if (!surfaces_.has_nodes())
    return;
  View views[kBlockLanes];
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Branch &branch = branch_of(lane);
    const double unit = glm::length(surfaces_.ray(lane).d);
    double way = (branch.passed + surfaces_.hit(lane).t) * unit;
    if (is_flat(surfaces_.instance(lane)))
      way = block_.length[lane] + (branch.depth == 0 ? 0.0 : branch.passed * unit);
    views[lane] = surfaces_.view(lane, way, {.kinds = branch.kinds, .depth = float(branch.depth)});
  }
  surfaces_.ask_nodes(views);
}

// Cuts holdouts out of the camera's view.
void ClassicIntegrator::cut_holes(std::span<SampleResult> results) {
  block_.holes = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const Branch &branch = branch_of(lane);
    Vertex &vertex = lit_[number_[lane]];
    vertex.nothing = false;
    if (branch.depth > 0 || !(scene_.features & kFeatureHoldout))
      continue;
    float &alpha = results[branch.slot].alpha;
    if (surfaces_.instance(lane).holdout) {
      // The object's whole share of the pixel becomes a hole.
      alpha -= mean(branch.weight * surfaces_.opacity(lane));
      surfaces_.emission[lane] = glm::vec3(0.0f);
      vertex.nothing = surfaces_.transmittance[lane] == glm::vec3(0.0f);
      block_.holes |= 1u << lane;
    } else {
      const float share = surfaces_.holdout(lane);
      alpha -= share * mean(branch.weight);
      vertex.nothing = share >= 1.0f;
      block_.holes |= uint32_t{vertex.nothing} << lane;
    }
  }
}

// Fills the passes that describe the camera's view.
void ClassicIntegrator::record(std::span<SampleResult> results) {
  surfaces_.describe();
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const uint32_t number = number_[lane];
    if (passes_.features())
      features_[number] = {surfaces_.mixture(lane), get(block_.wo, lane)};
    Branch &branch = branches_[number];
    if (branch.depth > 0 || lit_[number].nothing)
      continue;
    // Position comes from the hit, colour from the shaded vertex.
    const Surface met = surface_at(scene_.geometry, scene_.slots, rays_[number], hits_[number]);
    SampleResult &result = results[branch.slot];
    if (!branch.seen && mean(surfaces_.opacity(lane)) >= settings_.alpha_threshold) {
      record_place(scene_, met, block_.material[lane], branch.passed + hits_[number].t, result);
      record_first_surface(scene_, settings_, met, get(block_.normal, lane), result);
      branch.seen = true;
    }
    if (passes_.mist() || passes_.components())
      record_seen(scene_, camera_, settings_, passes_, met, surfaces_, lane, branch.weight, result);
  }
}

void ClassicIntegrator::keep(uint32_t lane) {
  Vertex &vertex = lit_[number_[lane]];
  const Hit &hit = surfaces_.hit(lane);
  vertex.mirrors = block_.mirrors >> lane & 1;
  vertex.refracts = block_.refracts >> lane & 1;
  vertex.instance = hit.instance;
  vertex.primitive = hit.primitive;
  vertex.p = get(block_.p, lane);
  vertex.offset = block_.offset[lane];
  vertex.ng = get(block_.ng, lane);
  vertex.emission = surfaces_.emission[lane] + get(block_.emission, lane);
  // A hole has no light of its own.
  const bool hole = block_.holes >> lane & 1;
  vertex.ambient = hole ? glm::vec3(0.0f) : surfaces_.value(block_.material[lane]->ambient, lane);
  vertex.transmittance = surfaces_.transmittance[lane];
  vertex.reflected = get(block_.reflected, lane);
  vertex.refracted = get(block_.refracted, lane);
  vertex.mirrored = get(block_.wi, lane);
  vertex.through = get(block_.through_wi, lane);
}

// Returns the random numbers for a point of a light: its middle if the picture has a single sample.
glm::vec2 ClassicIntegrator::light_numbers(const Branch &branch, uint32_t light) const {
  if (generator_.middle())
    return glm::vec2(0.5f);
  return samplers_[branch.slot].get2(kDimensionLamp + 2 * (branch.depth * uint32_t(scene_.lights.size()) + light));
}

// Prepares a light for the kernel: random numbers for a lamp, samples for other lights. Returns false if the light lights no
// surface. met: the block at the places of the hits.
bool ClassicIntegrator::ask(uint32_t number, const VertexBlock &met) {
  const LightSet &lights = scene_.lights;
  if (number < lights.lights().size()) {
    for (uint32_t lane = 0; lane < surfaces_.count() && has_extent(lights.lights()[number]); ++lane) {
      const glm::vec2 u = light_numbers(branch_of(lane), number);
      block_.u[2][lane] = u.x;
      block_.u[3][lane] = u.y;
    }
    return true;
  }
  if (!LightSet::lit_by(lights.hidden_from(number)))
    return false;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    block_.light_pdf[lane] = 0.0;
    if (lights.behind(number, get(met.p, lane), get(met.viewer_ng, lane)))
      continue;
    const LightSample sample =
        sample_scene_light(scene_, number, get(block_.p, lane), light_numbers(branch_of(lane), number), shader_);
    put(sample.wi, block_.light_wi, lane);
    put(sample.target, block_.light_target, lane);
    put(sample.radiance, block_.light_radiance, lane);
    block_.light_pdf[lane] = sample.pdf;
  }
  return true;
}

void ClassicIntegrator::light_block() {
  const auto &lamps = scene_.lights.lights();
  for (uint32_t number = 0; number < scene_.lights.size(); ++number) {
    if (!ask(number, block_))
      continue;
    const Light *lamp = number < lamps.size() ? &lamps[number] : nullptr;
    kernel_.illuminate(block_, lamp, scene_.lights.hidden_from(number));
    each_lane(lamp ? block_.there : 0, [&](uint32_t lane) {
      const glm::vec3 &ambient = lit_[number_[lane]].ambient;
      if (ambient != glm::vec3(0.0f))
        own_light_.add(number_[lane],
                       branch_of(lane).weight * ambient * lamp->classic.ambient_color * get(block_.irradiance, lane) * kInvPi);
    });
    each_lane(block_.lit, [&](uint32_t lane) { send_shadow(number, lane); });
  }
}

// Queues the light of a lane with its shadow ray.
void ClassicIntegrator::send_shadow(uint32_t number, uint32_t lane) {
  const LightSet &lights = scene_.lights;
  const uint32_t ray_number = number_[lane];
  const glm::vec3 contribution = branch_of(lane).weight * get(block_.contribution, lane);
  if (lights.no_shadow(number))
    return shadows_.push_lit({.slot = ray_number}, contribution);
  const bool far =
      number < lights.lights().size() ? lights.lights()[number].kind == LightKind::Sun : number == lights.environment_light();
  surfaces_.write_shadow_ray(lane, far, shadows_.push(ray_number, 0, contribution));
}

// Moves all lanes to a corner of their triangles, as if the rays had hit it.
void ClassicIntegrator::move_to_corner(uint32_t corner) {
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    lit_at_[lane] = hits_[number_[lane]];
    lit_at_[lane].u = corner == 1 ? 1.0 : 0.0;
    lit_at_[lane].v = corner == 2 ? 1.0 : 0.0;
    surfaces_.move(lane, lit_at_[lane]);
  }
  surfaces_.find();
  // View the corner from the eye, which needs the corner's position.
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    put(view_of(branch_of(lane), surfaces_.ray(lane), get(block_.p, lane)), block_.d, lane);
  surfaces_.find();
  if (surfaces_.has_nodes()) {
    View views[kBlockLanes];
    for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
      views[lane].wo = get(block_.wo, lane);
    surfaces_.ask_nodes(views);
  }
  surfaces_.find_lobes();
}

// Gouraud shading: lights the triangles' corners without occlusion, and tests occlusion at the hits.
void ClassicIntegrator::light_corners() {
  const auto &lamps = scene_.lights.lights();
  const uint32_t light_count = uint32_t(scene_.lights.size());
  const VertexBlock met = block_;
  corner_light_.assign(size_t(light_count) * 3 * kBlockLanes, {});
  for (uint32_t corner = 0; corner < 3; ++corner) {
    move_to_corner(corner);
    for (uint32_t number = 0; number < light_count; ++number) {
      if (!ask(number, met))
        continue;
      const Light *lamp = number < lamps.size() ? &lamps[number] : nullptr;
      kernel_.illuminate(block_, lamp, scene_.lights.hidden_from(number));
      each_lane(block_.there, [&](uint32_t lane) {
        const Hit &hit = hits_[number_[lane]];
        const float weight = float(corner == 0 ? 1.0 - hit.u - hit.v : corner == 1 ? hit.u : hit.v);
        CornerLight &of = corner_light_[(number * 3 + corner) * kBlockLanes + lane];
        of.light = weight * get(block_.contribution, lane);
        if (lamp)
          of.own = branch_of(lane).weight * lit_[number_[lane]].ambient * lamp->classic.ambient_color *
                   get(block_.irradiance, lane) * (kInvPi * weight);
      });
    }
  }
  block_ = met;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    surfaces_.move(lane, hits_[number_[lane]]);
  // Test whether the lamps are visible from the hits, on the viewer's side of the surface.
  for (uint32_t number = 0; number < light_count; ++number)
    for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
      glm::vec3 light(0.0f);
      for (uint32_t corner = 0; corner < 3; ++corner) {
        const CornerLight &of = corner_light_[(number * 3 + corner) * kBlockLanes + lane];
        light += of.light;
        if (of.own != glm::vec3(0.0f))
          own_light_.add(number_[lane], of.own);
      }
      if (light == glm::vec3(0.0f))
        continue;
      const LightSample sample =
          sample_scene_light(scene_, number, get(block_.p, lane), light_numbers(branch_of(lane), number), shader_);
      const glm::vec3 ng = get(block_.viewer_ng, lane), contribution = branch_of(lane).weight * light;
      if (!(sample.pdf > 0.0) || !(glm::dot(glm::vec3(sample.wi), ng) > 0.0f))
        continue;
      const WaitingLight waiting{.slot = number_[lane]};
      if (scene_.lights.no_shadow(number))
        shadows_.push_lit(waiting, contribution);
      else
        shadows_.push(shadow_ray(scene_.geometry, surfaces_.surface(lane), get(block_.viewer_ns, lane), ng, sample), waiting,
                      contribution);
    }
}

} // namespace lancer
