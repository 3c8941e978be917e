// The course's usual surfaces, shaded side by side.
#include "integrator/classic.h"

#include "integrator/first_surface.h"
#include "integrator/flat_shading.h"
#include "integrator/lane_access.h"
#include "sampling/color.h"
#include "scene/polygon_centers.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

void copy(const float (&from)[3], CourseBlock::Floats (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = from[i];
}

CourseLamp make_lamp(const LightSet &lights, uint32_t number) {
  static const CourseLight plain;
  CourseLamp lamp;
  const bool described = number < lights.lights().size();
  const CourseLight &course = described ? lights.lights()[number].course : plain;
  const uint32_t hidden = lights.hidden_from(number);
  for (int i = 0; i < 3; ++i) {
    lamp.diffuse[i] = hidden & LANCER_RAY_DIFFUSE ? 0.0f : course.diffuse_color[i];
    lamp.specular[i] = hidden & LANCER_RAY_GLOSSY ? 0.0f : course.specular_color[i];
  }
  // Ka of a surface takes light of lamps that are hidden, too.
  lamp.unseen = !described && !LightSet::lit_by(hidden);
  if (!described)
    return lamp;
  const Light &light = lights.lights()[number];
  lamp.point = light.kind == LightKind::Point && light.radius == 0.0 && course.falloff == Falloff::Physical;
  for (int i = 0; i < 3; ++i) {
    lamp.position[i] = light.position[i];
    lamp.emission[i] = light.emission[i];
  }
  return lamp;
}

} // namespace

ClassicLanes::ClassicLanes(const Scene &scene) : kernel(course_kernel()), materials(make_course_materials(scene.materials)) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    lamps.push_back(make_lamp(scene.lights, i));
  lit.resize(lamps.size());
}

const WideCourse *ClassicIntegrator::for_lanes(const Hit &hit) const {
  if (!hit.valid())
    return nullptr;
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  const bool corners = instance.kind == ShapeKind::Mesh && instance.shading == Shading::Gouraud;
  // Passes tell the place that is met, not the one that is lit.
  const bool elsewhere = is_flat(instance) && settings_.passes != 1u << LANCER_PASS_COMBINED;
  if (material == kNone || instance.holdout || corners || elsewhere || !lanes_->materials[material].known)
    return nullptr;
  return &lanes_->materials[material];
}

void ClassicIntegrator::put_in_lane(size_t number, const WideCourse &material) {
  CourseBlock &block = lanes_->block;
  const uint32_t lane = block.count++;
  const Ray &ray = rays_[number];
  Hit &hit = hits_[number];
  const Instance &instance = scene_.geometry.instances[hit.instance];
  glm::dvec3 view = ray.d;
  block.placement[lane] = &instance.to_world.linear[0][0];
  put(ray.o, block.o, lane);
  block.t[lane] = hit.t;
  block.sphere |= uint32_t(instance.kind == ShapeKind::Sphere) << lane;
  block.plane |= uint32_t(instance.kind == ShapeKind::Plane) << lane;
  if (!((block.sphere | block.plane) >> lane & 1)) {
    Surface surface;
    if (is_flat(instance)) {
      surface = surface_at_center(scene_, hit);
      view = view_of(branches_[number], ray, surface.p);
      // Rays that leave the surface start on the centre's triangle.
      hit = center_hit(scene_.geometry.meshes[instance.mesh], hit);
    } else {
      surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
    }
    put(surface.p, block.p, lane);
    block.offset[lane] = surface.offset;
    put(surface.ng, block.ng, lane);
    put(surface.ns, block.ns, lane);
  }
  put(view, block.d, lane);
  copy(material.kd, block.kd, lane);
  copy(material.ks, block.ks, lane);
  block.alpha[lane] = material.alpha;
  block.ior[lane] = material.ior;
  put(branches_[number].weight, block.weight, lane);
  block.matte |= uint32_t(material.matte) << lane;
  block.coated |= uint32_t(material.coated) << lane;
  lanes_->material_of[lane] = uint32_t(&material - lanes_->materials.data());
}

void ClassicIntegrator::shade_lanes(std::span<SampleResult> results) {
  CourseBlock &block = lanes_->block;
  block.threshold = settings_.contribution_threshold;
  for (size_t begin = 0, end = 0; begin < rays_.size(); begin = end) {
    // Fill the block; what it cannot take waits with the others, so that sums keep their order.
    block.count = block.matte = block.coated = block.sphere = block.plane = 0;
    lanes_->known.clear();
    for (; end < rays_.size() && block.count < uint32_t(kCourseLanes); ++end) {
      const WideCourse *material = for_lanes(hits_[end]);
      lanes_->known.push_back(material != nullptr);
      if (material)
        put_in_lane(end, *material);
    }
    for (uint32_t lane = block.count; lane < uint32_t(kCourseLanes); ++lane)
      block.placement[lane] = block.placement[0];
    lanes_->kernel.look(block);
    light_lanes(begin, end);
    uint32_t lane = 0;
    for (size_t i = begin; i < end; ++i) {
      SampleResult &result = results[branches_[i].slot];
      const bool known = lanes_->known[i - begin];
      if (known && !(block.odd >> lane & 1))
        leave_lane(lane, branches_[i], hits_[i], result);
      else
        shade(branches_[i], rays_[i], hits_[i], result, nullptr);
      lane += known;
    }
  }
}

// Asks every lamp for its light, those without extent in the kernel.
void ClassicIntegrator::light_lanes(size_t begin, size_t end) {
  const CourseBlock &block = lanes_->block;
  for (uint32_t number = 0; number < lanes_->lamps.size(); ++number) {
    const CourseLamp &lamp = lanes_->lamps[number];
    CourseLit &lit = lanes_->lit[number];
    if (lamp.unseen) {
      lit.lit = 0;
      continue;
    }
    if (!lamp.point) {
      lit.lit = lit.there = lit.far = 0;
      for (size_t i = begin, lane = 0; i < end; ++i)
        if (lanes_->known[i - begin])
          sample_lamp(number, branches_[i], uint32_t(lane++), lit);
      if (!lit.there)
        continue;
    }
    lanes_->kernel.light(block, lamp, lit);
  }
}

void ClassicIntegrator::sample_lamp(uint32_t number, const Branch &branch, uint32_t lane, CourseLit &lit) {
  static const CourseLight plain;
  const auto &lights = scene_.lights.lights();
  if (scene_.lights.behind(number, get(lanes_->block.p, lane), get(lanes_->block.viewer_ng, lane)))
    return;
  const LightSample sample =
      sample_scene_light(scene_, number, get(lanes_->block.p, lane), lamp_numbers(branch, number), shader_);
  if (!(sample.pdf > 0.0))
    return;
  lit.there |= 1u << lane;
  lit.far |= uint32_t(std::isinf(sample.distance)) << lane;
  put(sample.wi, lit.wi, lane);
  put(sample.target, lit.target, lane);
  put(course_irradiance(number < lights.size() ? lights[number].course : plain, sample), lit.irradiance, lane);
}

Surface ClassicIntegrator::surface_of(uint32_t lane, const Hit &hit) const {
  const CourseBlock &block = lanes_->block;
  Surface surface;
  surface.p = get(block.p, lane);
  surface.offset = block.offset[lane];
  surface.ng = get(block.ng, lane);
  surface.ns = get(block.ns, lane);
  // Exact surfaces have no weights of corners: their hits say 0.
  surface.bary = {hit.u, hit.v};
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.material = lanes_->material_of[lane];
  return surface;
}

// Light that one lamp sends to a lane, once its shadow ray is through.
void ClassicIntegrator::send_shadow(uint32_t number, uint32_t lane, const Branch &branch, const Hit &hit) {
  const CourseLit &lit = lanes_->lit[number];
  if (!(lit.lit >> lane & 1))
    return;
  const glm::vec3 contribution = get(lit.contribution, lane);
  if (scene_.lights.no_shadow(number))
    return shadows_.push_lit({.slot = branch.slot}, contribution);
  const double end = lit.far >> lane & 1 ? std::numeric_limits<double>::infinity() : 1.0;
  const Instance &instance = scene_.geometry.instances[hit.instance];
  if (instance.kind == ShapeKind::Mesh && instance.terminator > 0.0f) {
    // It may have to start on the curved surface.
    LightSample sample;
    sample.wi = get(lit.wi, lane);
    sample.target = get(lit.target, lane);
    sample.distance = end;
    const CourseBlock &block = lanes_->block;
    const Surface surface = surface_of(lane, hit);
    return shadows_.push(shadow_ray(scene_.geometry, surface, get(block.viewer_ns, lane), get(block.viewer_ng, lane), sample),
                         {.slot = branch.slot}, contribution);
  }
  leave(hit, get(lit.origin, lane), get(lit.d, lane), end, LANCER_RAY_SHADOW, shadows_.push(branch.slot, contribution));
}

// What the material emits, and Ka of what comes from everywhere and from the lamps.
void ClassicIntegrator::add_own_light(uint32_t lane, const Branch &branch, const Material &material, SampleResult &result) {
  const auto &lights = scene_.lights.lights();
  const glm::vec3 ambient = branch.weight * value_of(material.ambient, shader_.values());
  result.radiance += branch.weight * value_of(material.emission, shader_.values());
  result.radiance += ambient * ambient_;
  for (uint32_t number = 0; number < lights.size(); ++number) {
    const CourseLit &lit = lanes_->lit[number];
    if (lit.there >> lane & 1)
      result.radiance += ambient * lights[number].course.ambient_color * get(lit.irradiance, lane) * kInvPi;
  }
}

// What follows from a shaded lane: its light, its shadow rays, its mirrored ray.
void ClassicIntegrator::leave_lane(uint32_t lane, const Branch &branch, const Hit &hit, SampleResult &result) {
  ++vertices_.wide;
  const CourseBlock &block = lanes_->block;
  const Material &material = scene_.materials[lanes_->material_of[lane]];
  const bool first = branch.depth == 0 && !branch.seen && settings_.alpha_threshold <= 1.0f;
  // The picture alone asks for nothing that it says.
  if (first && settings_.passes != 1u << LANCER_PASS_COMBINED) {
    // The lobes' normals, each with its weight.
    const glm::vec3 ns = get(block.viewer_ns, lane);
    const glm::vec3 sum = ns * mean(get(block.kd, lane)) + ns * mean(get(block.ks, lane));
    const Surface surface = surface_of(lane, hit);
    record_place(scene_, surface, &material, branch.passed + hit.t, result);
    record_first_surface(scene_, settings_, surface, sum == glm::vec3(0.0f) ? ns : glm::normalize(sum), result);
  }
  if (lanes_->materials[lanes_->material_of[lane]].shines)
    add_own_light(lane, branch, material, result);
  for (uint32_t number = 0; number < lanes_->lamps.size(); ++number)
    send_shadow(number, lane, branch, hit);
  // Beyond the depth limit a ray is black: it need not be traced.
  if (branch.depth >= settings_.max_bounces || !(block.goes_on >> lane & 1))
    return;
  Branch &next = next_branches_.emplace_back(branch);
  next.weight = get(block.next_weight, lane);
  next.kinds = LANCER_RAY_GLOSSY;
  next.layers = 0;
  next.seen = next.seen || first;
  ++next.depth;
  leave(hit, get(block.next_origin, lane), glm::dvec3(get(block.mirrored, lane)), std::numeric_limits<double>::infinity(),
        next.kinds, next_rays_.emplace_back());
}

} // namespace lancer
