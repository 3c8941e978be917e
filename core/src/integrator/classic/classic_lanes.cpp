// Vertices of the recursion in lanes: their surfaces, their passes, and the light of every lamp.
#include "integrator/classic/classic.h"

#include "compile/steps.h"
#include "integrator/aov/first_surface.h"
#include "integrator/aov/surface_extras.h"
#include "simd/vectors.h"

namespace lancer {

namespace {

// Each lamp at each depth has its own dimensions, after those of a path.
constexpr uint32_t kDimensionLamp = 1u << 24;

} // namespace

const ClassicKernel &classic_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(classic_kernel); }

void ClassicIntegrator::shade(std::span<SampleResult> results) {
  queues_.begin();
  own_light_.begin(rays_.size());
  shadow_light_.begin(rays_.size());
  lit_.resize(rays_.size());
  if (passes_.guides())
    guides_.resize(rays_.size());
  for (size_t i = 0; i < rays_.size(); ++i)
    if (hits_[i].valid())
      queues_.add(i, hits_[i]);
  vertices_ += queues_.size();
  queues_.each([&](std::span<const ShadingQueues::Queued> met) {
    for (const ShadingQueues::Queued &one : met)
      put_in_lane(one.number, *one.material, results);
    shade_block(results);
  });
  own_light_.sort();
}

void ClassicIntegrator::put_in_lane(size_t number, const MaterialView &material, std::span<SampleResult> results) {
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
    const Surface surface = surface_at_center(scene_, hit, ray.time);
    surfaces_.replace(lane, surface, view_of(branches_[number], ray, surface.p));
    put_number(lane, number, material);
    return;
  }
  put_number(surfaces_.add(ray, hit, material), number, material);
}

void ClassicIntegrator::put_number(uint32_t lane, size_t number, const MaterialView &material) {
  number_[lane] = uint32_t(number);
  if (!material.estimates)
    return;
  const Branch &branch = branches_[number];
  const Sampler &sampler = samplers_[branch.sample];
  surfaces_.set_key(lane, hash_combine(hash_combine(sampler.pixel(), sampler.sample()), branch.depth));
}

void ClassicIntegrator::shade_block(std::span<SampleResult> results) {
  if (surfaces_.count() == 0)
    return;
  surfaces_.find();
  surfaces_.ask_nodes(
      [&](uint32_t lane) {
        const Branch &branch = branch_of(lane);
        const double unit = glm::length(surfaces_.ray(lane).d);
        double way = (branch.passed + surfaces_.hit(lane).t) * unit;
        if (is_flat(surfaces_.instance(lane)))
          way = surfaces_.surfaces().length[lane] + (branch.depth == 0 ? 0.0 : branch.passed * unit);
        return surfaces_.view(lane, way, {.kinds = branch.kinds, .depth = float(branch.depth)});
      },
      layout_.has_outputs());
  for (uint32_t lane = 0; lane < surfaces_.count() && layout_.has_outputs(); ++lane)
    if (const Branch &branch = branch_of(lane); branch.depth == 0 && !branch.seen)
      add_outputs(layout_, first_ + branch.sample, surfaces_, lane, extras_);
  cut_holdouts(results);
  surfaces_.build_lobes();
  if (!only_combined_)
    record(results);
  kernel_.branch(surfaces_.lobes(), branched_);
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    store_vertex(lane);
  if (corners_)
    light_corners();
  else
    light_block();
  surfaces_.clear();
}

// Cuts holdouts out of the camera's view.
void ClassicIntegrator::cut_holdouts(std::span<SampleResult> results) {
  uint32_t seen = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    seen |= uint32_t(branch_of(lane).depth == 0) << lane;
  const SurfaceStage::Holes holes = surfaces_.cut_holdouts(seen);
  each_lane(holes.cut,
            [&](uint32_t lane) { results[branch_of(lane).sample].alpha -= surfaces_.cut_alpha(lane, branch_of(lane).weight); });
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    lit_[number_[lane]].nothing = holes.nothing >> lane & 1;
}

// Fills the passes that describe the camera's view.
void ClassicIntegrator::record(std::span<SampleResult> results) {
  surfaces_.describe();
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
    const uint32_t number = number_[lane];
    if (passes_.guides())
      guides_[number] = {surfaces_.mixture(lane), get(surfaces_.surfaces().wo, lane)};
    Branch &branch = branches_[number];
    if (branch.depth > 0 || lit_[number].nothing)
      continue;
    // Position comes from the hit, colour from the shaded vertex.
    const Surface met = surface_at(scene_.geometry, scene_.slots, rays_[number], hits_[number]);
    SampleResult &result = results[branch.sample];
    if (!branch.seen && mean(surfaces_.opacity(lane)) >= settings_.alpha_threshold) {
      record_place(scene_, met, surfaces_.material(lane), branch.passed + hits_[number].t, result);
      record_first_surface(scene_, settings_, met, get(surfaces_.means().normal, lane), result);
      vectors_.record(met, result);
      branch.seen = true;
    }
    add_mattes(scene_, layout_, first_ + branch.sample, met.instance, surfaces_.material(lane),
               mean(branch.weight) * mean(surfaces_.opacity(lane)), extras_);
    if (passes_.mist() || passes_.components())
      record_seen(scene_, camera_, settings_, passes_, met, surfaces_, lane, branch.weight, result);
  }
}

void ClassicIntegrator::store_vertex(uint32_t lane) {
  Vertex &vertex = lit_[number_[lane]];
  const Hit &hit = surfaces_.hit(lane);
  vertex.mirrors = branched_.mirrors >> lane & 1;
  vertex.refracts = branched_.refracts >> lane & 1;
  vertex.instance = hit.instance;
  vertex.primitive = hit.primitive;
  vertex.p = get(surfaces_.surfaces().p, lane);
  vertex.offset = surfaces_.surfaces().offset[lane];
  vertex.time = surfaces_.surfaces().time[lane];
  vertex.ng = get(surfaces_.surfaces().ng, lane);
  vertex.emission = surfaces_.emission(lane);
  // A hole has no light of its own.
  const bool hole = surfaces_.holes() >> lane & 1;
  vertex.ambient = hole ? glm::vec3(0.0f) : surfaces_.value(surfaces_.material(lane).ambient, lane);
  vertex.transmittance = surfaces_.transmittance(lane);
  vertex.reflected = get(branched_.reflected, lane);
  vertex.refracted = get(branched_.refracted, lane);
  vertex.mirrored = get(branched_.mirrored, lane);
  vertex.through = get(branched_.through, lane);
}

// Returns the random numbers for a point of a light: its middle if the picture has a single sample.
glm::vec2 ClassicIntegrator::light_numbers(const Branch &branch, uint32_t light) const {
  if (generator_.middle())
    return glm::vec2(0.5f);
  return samplers_[branch.sample].get2(kDimensionLamp + 2 * (branch.depth * uint32_t(scene_.lights.size()) + light));
}

// Samples a light in all lanes that it may light. p, ng: the places of the hits, and their normals on the viewer's side.
void ClassicIntegrator::sample(uint32_t number, const Doubles (&p)[3], const Floats (&ng)[3]) {
  const LightSet &lights = scene_.lights;
  uint32_t asking = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    asking |= uint32_t(!lights.behind(number, get(p, lane), get(ng, lane))) << lane;
  if (number >= lights.lamps().size() && !LightSet::lit_by(lights.hidden_from(number)))
    asking = 0;
  // A constant environment is ambient light, also where openings let paths sample it.
  if (number == lights.environment_light() && !lights.environment().varies())
    asking = 0;
  const LightLinks links = lights.links(number);
  for (uint32_t lane = 0; lane < surfaces_.count() && links.unlit_sets != 0; ++lane)
    asking &= ~(uint32_t{!links.reaches(surfaces_.instance(lane).receiver_set)} << lane);
  if (number >= lights.lamps().size() || has_extent(lights.lamps()[number]))
    each_lane(asking, [&](uint32_t lane) {
      const glm::vec2 u = light_numbers(branch_of(lane), number);
      numbers_.of[kVertexLight][lane] = u.x;
      numbers_.of[kVertexLight + 1][lane] = u.y;
    });
  light_.sample(number, asking, surfaces_.surfaces().p, surfaces_.surfaces().time, numbers_);
}

// Computes the light of the samples at the places of the lanes.
void ClassicIntegrator::illuminate(uint32_t number) {
  const auto &lamps = scene_.lights.lamps();
  static constexpr ClassicLight plain;
  kernel_.illuminate(surfaces_.surfaces(), surfaces_.lobes(), light_.samples(),
                     number < lamps.size() ? lamps[number].classic : plain, scene_.lights.hidden_from(number), lit_block_,
                     irradiance_);
}

// Returns the light of a lamp that a lane's Ka reflects without occlusion.
glm::vec3 ClassicIntegrator::own_light(uint32_t number, uint32_t lane, float share) const {
  return branch_of(lane).weight * lit_[number_[lane]].ambient * scene_.lights.lamps()[number].classic.ambient_color *
         get(irradiance_.irradiance, lane) * share;
}

void ClassicIntegrator::light_block() {
  for (uint32_t number = 0; number < scene_.lights.size(); ++number) {
    sample(number, surfaces_.surfaces().p, surfaces_.lobes().ng);
    illuminate(number);
    each_lane(number < scene_.lights.lamps().size() ? irradiance_.there : 0, [&](uint32_t lane) {
      if (lit_[number_[lane]].ambient != glm::vec3(0.0f))
        own_light_.add(number_[lane], own_light(number, lane, kInvPi));
    });
    each_lane(lit_block_.lit, [&](uint32_t lane) { send_shadow(number, lane, get(lit_block_.contribution, lane)); });
  }
}

// Queues the light of a lane with its shadow ray.
void ClassicIntegrator::send_shadow(uint32_t number, uint32_t lane, const glm::vec3 &light) {
  Ray &ray = shadows_.push(branch_of(lane).weight * light, 0, scene_.lights.links(number),
                           [&](WaitingLight &waiting) { waiting.target = number_[lane]; });
  if (scene_.lights.no_shadow(number))
    ShadowStage::leave_out(ray);
  else
    write_shadow_ray(scene_, surfaces_, lane, light_.samples(), lit_block_, ray);
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
    surfaces_.view_along(lane, view_of(branch_of(lane), surfaces_.ray(lane), get(surfaces_.surfaces().p, lane)));
  surfaces_.find();
  surfaces_.ask_nodes([&](uint32_t lane) { return View{.wo = get(surfaces_.surfaces().wo, lane)}; });
  surfaces_.build_lobes();
}

// Gouraud shading: lights the triangles' corners without occlusion, and tests occlusion at the hits.
void ClassicIntegrator::light_corners() {
  const uint32_t light_count = uint32_t(scene_.lights.size());
  const SurfaceStage::Places met = surfaces_.places();
  corner_light_.assign(size_t(light_count) * 3 * kBlockLanes, {});
  for (uint32_t corner = 0; corner < 3; ++corner) {
    move_to_corner(corner);
    for (uint32_t number = 0; number < light_count; ++number) {
      sample(number, met.surfaces.p, met.lobes.ng);
      illuminate(number);
      each_lane(irradiance_.there, [&](uint32_t lane) {
        const Hit &hit = hits_[number_[lane]];
        const float weight = float(corner == 0 ? 1.0 - hit.u - hit.v : corner == 1 ? hit.u : hit.v);
        CornerLight &of = corner_light_[(number * 3 + corner) * kBlockLanes + lane];
        of.light = weight * get(lit_block_.contribution, lane);
        if (number < scene_.lights.lamps().size())
          of.own = own_light(number, lane, kInvPi * weight);
      });
    }
  }
  surfaces_.go_back(met);
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    surfaces_.move(lane, hits_[number_[lane]]);
  // Test whether the lamps are visible from the hits, on the viewer's side of the surface.
  for (uint32_t number = 0; number < light_count; ++number) {
    sample(number, met.surfaces.p, met.lobes.ng);
    kernel_.aim(surfaces_.surfaces(), surfaces_.lobes(), light_.samples(), lit_block_);
    for (uint32_t lane = 0; lane < surfaces_.count(); ++lane) {
      glm::vec3 light(0.0f);
      for (uint32_t corner = 0; corner < 3; ++corner) {
        const CornerLight &of = corner_light_[(number * 3 + corner) * kBlockLanes + lane];
        light += of.light;
        if (of.own != glm::vec3(0.0f))
          own_light_.add(number_[lane], of.own);
      }
      if (light != glm::vec3(0.0f) && (lit_block_.lit >> lane & 1))
        send_shadow(number, lane, light);
    }
  }
}

} // namespace lancer
