#include "integrator/classic.h"

#include "integrator/first_surface.h"
#include "integrator/flat_shading.h"
#include "sampling/color.h"

#include <algorithm>

namespace lancer {

namespace {

// Every lamp at every depth has numbers of its own, behind those of a path.
constexpr uint32_t kDimensionLamp = 1u << 24;

// Glass doubles the rays of every depth. Where more than so many are under way, the batch begins anew in parts that are small
// enough for the deepest recursion.
constexpr size_t kCrowd = 8192, kSmallPart = 64;

} // namespace

void ClassicIntegrator::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                            std::vector<PathVertex> *trace) {
  for (size_t begin = 0; begin < addresses.size() && !settings_.cancelled();) {
    const size_t size = std::min(crowded_ ? kSmallPart : addresses.size(), addresses.size() - begin);
    if (run_part(addresses.subspan(begin, size), results.subspan(begin, size), trace))
      begin += size;
    else
      // It is likely so for the batches that follow, too.
      crowded_ = true;
  }
}

// False where the rays became too many: nothing is done then.
bool ClassicIntegrator::run_part(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                                 std::vector<PathVertex> *trace) {
  const RayCounts before = counts_;
  const VertexCounts vertices_before = vertices_;
  generate(addresses, results);
  // Trace the recursion depth by depth: a pixel's sum has the same order in any batch.
  while (!rays_.empty() && !settings_.cancelled()) {
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    next_branches_.clear();
    next_rays_.clear();
    if (lanes_ && !trace)
      shade_lanes(results);
    for (size_t i = 0; i < rays_.size() && (trace || !lanes_); ++i)
      shade(branches_[i], rays_[i], hits_[i], results[branches_[i].slot], trace);
    counts_.shadow +=
        shadows_.trace([&](const WaitingLight &waiting, const glm::vec3 &light) { results[waiting.slot].radiance += light; });
    counts_.bounce += next_rays_.size();
    branches_.swap(next_branches_);
    rays_.swap(next_rays_);
    if (rays_.size() > kCrowd && addresses.size() > kSmallPart) {
      counts_ = before;
      vertices_ = vertices_before;
      return false;
    }
  }
  return true;
}

void ClassicIntegrator::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  branches_.clear();
  rays_.clear();
  samplers_.assign(addresses.size(), Sampler(0, 0));
  generator_.start(addresses, passes_.wanted(), results, [&](uint32_t slot, const Sampler &sampler) -> Ray & {
    samplers_[slot] = sampler;
    Branch &branch = branches_.emplace_back();
    branch.slot = slot;
    branch.features = begin_features(settings_, passes_.features());
    return rays_.emplace_back();
  });
  counts_.camera += rays_.size();
}

void ClassicIntegrator::miss(const Branch &branch, const glm::dvec3 &eye, const glm::vec3 &direction, SampleResult &result) {
  if (branch.depth == 0)
    add_sky_features(branch.features, result);
  // A transparent film does not show the environment itself.
  if (branch.depth == 0 && settings_.film_transparent) {
    result.alpha -= mean(branch.weight);
    return;
  }
  if (!(branch.kinds & ~scene_.world.hidden_from))
    return;
  const glm::vec3 sky = scene_.lights.environment().radiance(glm::dvec3(direction), shader_.values(), &camera_,
                                                             branch.depth == 0 ? &eye : nullptr, {.kinds = branch.kinds});
  add(branch, branch.weight * sky, true, result);
}

void ClassicIntegrator::shade(const Branch &branch, const Ray &ray, const Hit &hit, SampleResult &result,
                              std::vector<PathVertex> *trace) {
  const glm::vec3 direction(glm::normalize(ray.d));
  // The sky on a miss.
  if (!hit.valid()) {
    miss(branch, ray.o, direction, result);
    return;
  }
  ++vertices_.narrow;
  const bool from_camera = branch.depth == 0;
  // What is met says where it is; what is lit says its colour.
  const Surface met = surface_at(scene_.geometry, scene_.slots, ray, hit);
  Surface surface = met;
  glm::vec3 wo = -direction;
  double way = (branch.passed + hit.t) * glm::length(ray.d);
  if (is_flat(scene_.geometry.instances[hit.instance])) {
    surface = surface_at_center(scene_, hit);
    const glm::dvec3 view = view_of(branch, ray, surface.p);
    wo = -glm::vec3(glm::normalize(view));
    way = glm::length(view) + (from_camera ? 0.0 : branch.passed * glm::length(ray.d));
  }
  shader_.shade(surface,
                {.wo = wo,
                 .footprint = float(cone_.base + way * cone_.spread),
                 .path = {.kinds = branch.kinds, .depth = float(branch.depth)}},
                point_);
  if (trace)
    trace->push_back({scene_.normalisation.to_world(met.p), hit.t / scene_.normalisation.scale, surface.ns, branch.weight,
                      result.radiance, met.instance, met.primitive, met.material, branch.depth});
  if (from_camera && !cut_hole(scene_, surface, branch.weight, point_, result))
    return;
  Branch here = branch;
  if (from_camera)
    record(here, met, hit.t, result);
  add(here, here.weight * point_.emission, false, result);
  if (here.features.open)
    add_denoising_features(scene_, camera_, mix(point_.bsdf, point_.transmittance, here.features.blended), point_.bsdf.wo,
                           point_.transmittance, hit.t * glm::length(ray.d), here.features, result);
  // A hole has no light of its own.
  const bool hole = from_camera && scene_.geometry.instances[surface.instance].holdout;
  if (point_.material && !hole) {
    result.radiance += here.weight * value_of(point_.material->ambient, shader_.values()) * ambient_;
    add_direct_light(here, surface, ray, hit, result);
  }
  branch_out(here, surface, met, ray, hit, result);
}

// Fills the passes that describe what the camera sees.
void ClassicIntegrator::record(Branch &branch, const Surface &surface, double t, SampleResult &result) {
  if (!branch.seen && mean(point_.opacity()) >= settings_.alpha_threshold) {
    record_first_surface(scene_, settings_, surface, point_, branch.passed + t, result);
    branch.seen = true;
  }
  record_seen(scene_, camera_, settings_, passes_, surface, point_, branch.weight, result);
}

void ClassicIntegrator::add(const Branch &branch, const glm::vec3 &light, bool environment, SampleResult &result) {
  result.radiance += light;
  if (branch.features.open)
    result.albedo += branch.features.beta * light;
  if (branch.depth == 0)
    passes_.add_seen(result, light, environment);
}

// The way from the eye to another place than the ray goes to, of any length. Layers that it has passed are no eye.
glm::dvec3 ClassicIntegrator::view_of(const Branch &branch, const Ray &ray, const glm::dvec3 &p) const {
  if (branch.depth > 0)
    return p - ray.o;
  return camera_.kind == CameraKind::Orthographic ? ray.d : p - (ray.o - branch.passed * ray.d);
}

// Which point of the lamp to take: its middle when there is one sample only.
glm::vec2 ClassicIntegrator::lamp_numbers(const Branch &branch, uint32_t light) const {
  if (generator_.middle())
    return glm::vec2(0.5f);
  return samplers_[branch.slot].get2(kDimensionLamp + 2 * (branch.depth * uint32_t(scene_.lights.size()) + light));
}

void ClassicIntegrator::add_direct_light(const Branch &branch, const Surface &surface, const Ray &ray, const Hit &hit,
                                         SampleResult &result) {
  static const CourseLight plain;
  // Under Gouraud shading the triangle's corners are lit, each a hit of its own with all weight on one corner.
  LitPoint lit[3] = {{surface.p, &point_.bsdf, 1.0f}, {}, {}};
  int lit_count = 1;
  const Instance &instance = scene_.geometry.instances[surface.instance];
  const glm::vec3 ambient = branch.weight * value_of(point_.material->ambient, shader_.values());
  if (instance.kind == ShapeKind::Mesh && instance.shading == Shading::Gouraud) {
    lit_count = 3;
    for (int corner = 0; corner < 3; ++corner) {
      Hit at = hit;
      at.u = corner == 1 ? 1.0 : 0.0;
      at.v = corner == 2 ? 1.0 : 0.0;
      const Surface vertex = surface_at(scene_.geometry, scene_.slots, Ray{}, at);
      View view;
      view.wo = -glm::vec3(glm::normalize(view_of(branch, ray, vertex.p)));
      shader_.shade(vertex, view, corners_[corner]);
      lit[corner] = {vertex.p, &corners_[corner].bsdf, float(corner == 0 ? 1.0 - hit.u - hit.v : corner == 1 ? hit.u : hit.v)};
    }
  }
  const auto &lights = scene_.lights.lights();
  for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
    const bool lamp = i < lights.size();
    const uint32_t hidden = scene_.lights.hidden_from(i);
    if (!lamp && (!LightSet::lit_by(hidden) || scene_.lights.behind(i, surface.p, point_.bsdf.ng)))
      continue;
    const glm::vec2 u = lamp_numbers(branch, i);
    const CourseLight &course = lamp ? lights[i].course : plain;
    // Illuminate each lit point as if nothing stood between.
    glm::vec3 light(0.0f);
    LightSample s;
    for (int k = 0; k < lit_count; ++k) {
      s = sample_scene_light(scene_, i, lit[k].p, u, shader_);
      if (!(s.pdf > 0.0))
        continue;
      const glm::vec3 irradiance = course_irradiance(course, s);
      light += lit[k].weight * course_illumination(*lit[k].bsdf, glm::vec3(s.wi), course, irradiance, hidden);
      if (lamp)
        result.radiance += ambient * course.ambient_color * irradiance * (kInvPi * lit[k].weight);
    }
    if (light == glm::vec3(0.0f))
      continue;
    // Ask whether the lamp is seen from the hit point, on the viewer's side of the surface.
    if (lit_count > 1)
      s = sample_scene_light(scene_, i, surface.p, u, shader_);
    const bool same_side = glm::dot(glm::vec3(s.wi), point_.bsdf.ng) > 0.0f;
    if (!(s.pdf > 0.0) || !same_side)
      continue;
    if (scene_.lights.no_shadow(i))
      shadows_.push_lit({.slot = branch.slot}, branch.weight * light);
    else
      shadows_.push(shadow_ray(scene_.geometry, surface, point_.bsdf.ns, point_.bsdf.ng, s), {.slot = branch.slot},
                    branch.weight * light);
  }
}

void ClassicIntegrator::branch_out(const Branch &branch, const Surface &surface, const Surface &met, const Ray &ray,
                                   const Hit &hit, SampleResult &result) {
  const CourseBranches branches = course_branches(point_.bsdf);
  // Features follow every branch by its share of the light.
  const float all = mean(point_.transmittance + branches.reflected + branches.refracted);
  const auto child = [&](const glm::vec3 &part) {
    Branch next = branch;
    next.features.share *= all > 0.0f ? mean(part) / all : 0.0f;
    return next;
  };
  if (point_.passes() && branch.layers < settings_.transparent_bounces) {
    Branch behind = child(point_.transmittance);
    behind.passed += hit.t;
    behind.weight *= point_.transmittance;
    ++behind.layers;
    push(behind, leave(met, ray.d, ray.tmax - hit.t));
  }
  // Beyond the depth limit a ray is black: it need not be traced.
  if (branch.depth >= settings_.max_bounces)
    return;
  // About an interpolated normal a mirrored direction may point into the surface: such a ray is black.
  if (glm::dot(branches.mirrored, point_.bsdf.ng) > 0.0f)
    spawn(child(branches.reflected), surface, branches.mirrored, branches.reflected, LANCER_RAY_GLOSSY, result);
  if (glm::dot(branches.through, point_.bsdf.ng) < 0.0f)
    spawn(child(branches.refracted), surface, branches.through, branches.refracted, LANCER_RAY_TRANSMISSION, result);
}

void ClassicIntegrator::spawn(Branch child, const Surface &surface, const glm::vec3 &direction, const glm::vec3 &weight,
                              uint32_t kind, SampleResult &result) {
  child.weight *= weight;
  child.kinds = kind;
  child.layers = 0;
  ++child.depth;
  // Stop what can no longer matter.
  const float share = largest(child.weight);
  if (!(share > 0.0f) || share <= settings_.contribution_threshold)
    return;
  // The cheap way: the colour that the environment has there, whatever stands between.
  if (settings_.environment_reflections)
    miss(child, surface.p, direction, result);
  else
    push(child, leave(surface, glm::dvec3(direction), std::numeric_limits<double>::infinity()));
}

void ClassicIntegrator::push(const Branch &branch, Ray ray) {
  ray.kinds = branch.kinds;
  next_branches_.push_back(branch);
  next_rays_.push_back(ray);
}

} // namespace lancer
