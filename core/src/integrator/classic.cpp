#include "integrator/classic.h"

#include <algorithm>

namespace lancer {

namespace {

float largest(const glm::vec3 &v) { return std::max({v.x, v.y, v.z}); }

// Every lamp at every depth has numbers of its own, behind those of a path.
constexpr uint32_t kDimensionLamp = 1u << 24;

constexpr size_t kGlassBatch = 64;

// The corners of a triangle under Gouraud shading, with their weights; otherwise the hit point itself.
struct LitPoints {
  LitPoint points[3];
  float weights[3] = {1.0f, 0.0f, 0.0f};
  int count = 1;
};

LitPoints lit_points(const Scene &scene, const Surface &surface, const ShadingPoint &point, const Hit &hit,
                     const glm::dvec3 &eye) {
  LitPoints lit;
  lit.points[0] = {surface.p, point.frame, point.wo};
  const Instance &instance = scene.geometry.instances[surface.instance];
  if (instance.kind != ShapeKind::Mesh || instance.shading != Shading::Gouraud)
    return lit;
  // A vertex is a hit of its own with all weight on one corner.
  lit.count = 3;
  for (int corner = 0; corner < 3; ++corner) {
    Hit at = hit;
    at.u = corner == 1 ? 1.0 : 0.0;
    at.v = corner == 2 ? 1.0 : 0.0;
    const Surface vertex = surface_at(scene.geometry, scene.slots, Ray{}, at);
    const glm::vec3 wo(glm::normalize(eye - vertex.p));
    lit.points[corner].p = vertex.p;
    lit.points[corner].frame = Frame(visible_normal(vertex.ns, vertex.ng, wo));
    lit.points[corner].wo = lit.points[corner].frame.to_local(wo);
    lit.weights[corner] = float(corner == 0 ? 1.0 - hit.u - hit.v : corner == 1 ? hit.u : hit.v);
  }
  return lit;
}

} // namespace

void ClassicIntegrator::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                            std::vector<PathVertex> *trace) {
  // Glass doubles the rays of every depth: fewer samples at a time keep the queues within memory.
  const bool doubles = (scene_.features & kFeatureDielectric) != 0;
  const size_t part = doubles ? kGlassBatch : addresses.size();
  for (size_t begin = 0; begin < addresses.size() && !settings_.cancelled(); begin += part) {
    const size_t size = std::min(part, addresses.size() - begin);
    run_part(addresses.subspan(begin, size), results.subspan(begin, size), trace);
  }
}

void ClassicIntegrator::run_part(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                                 std::vector<PathVertex> *trace) {
  generate(addresses, results);
  // Trace the recursion depth by depth: a pixel's sum has the same order in any batch.
  while (!rays_.empty() && !settings_.cancelled()) {
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    next_branches_.clear();
    next_rays_.clear();
    for (size_t i = 0; i < rays_.size(); ++i)
      shade(branches_[i], rays_[i], hits_[i], results[branches_[i].slot], trace);
    counts_.shadow += shadows_.trace([&](uint32_t slot, const glm::vec3 &light) { results[slot].radiance += light; });
    counts_.bounce += next_rays_.size();
    branches_.swap(next_branches_);
    rays_.swap(next_rays_);
  }
}

void ClassicIntegrator::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  branches_.clear();
  rays_.clear();
  samplers_.clear();
  for (uint32_t slot = 0; slot < addresses.size(); ++slot) {
    results[slot] = SampleResult{};
    samplers_.push_back(generator_.sampler(addresses[slot]));
    rays_.push_back(generator_.ray(addresses[slot], samplers_.back()));
    branches_.push_back({.slot = slot});
  }
  counts_.camera += addresses.size();
}

void ClassicIntegrator::shade(const Branch &branch, const Ray &ray, const Hit &hit, SampleResult &result,
                              std::vector<PathVertex> *trace) {
  const bool from_camera = branch.depth == 0;
  // The sky on a miss.
  if (!hit.valid()) {
    if (from_camera && settings_.film_transparent)
      return;
    if (from_camera)
      result.alpha += largest(branch.weight);
    result.radiance += branch.weight * scene_.lights.world();
    return;
  }
  Bsdf scratch;
  const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
  const ShadingPoint point = shading_point(scene_, surface, glm::vec3(-glm::normalize(ray.d)), scratch);
  if (trace)
    trace->push_back({scene_.normalisation.to_world(surface.p), hit.t / scene_.normalisation.scale, surface.ns, branch.weight,
                      result.radiance, surface.instance, surface.primitive, surface.material, branch.depth});

  // Split by opacity: what is there, and what lies behind.
  Branch solid = branch;
  const float opacity = point.material ? evaluate(point.material->opacity, surface).x : 1.0f;
  solid.weight *= opacity;
  if (from_camera && !branch.seen && opacity >= kSeenOpacity) {
    record_first_surface(scene_, surface, point.bsdf->albedo_color(), branch.passed + hit.t, result);
    solid.seen = true;
  }
  if (opacity < 1.0f && branch.layers + 1 < kMaxLayers) {
    Branch behind = branch;
    behind.seen = solid.seen;
    behind.passed += hit.t;
    behind.weight *= 1.0f - opacity;
    ++behind.layers;
    next_branches_.push_back(behind);
    next_rays_.push_back(leave(surface, ray.d, ray.tmax - hit.t));
  }
  if (from_camera)
    result.alpha += largest(solid.weight);
  if (!point.material || opacity == 0.0f)
    return;
  result.radiance += solid.weight * evaluate(point.material->emission, surface);
  result.radiance += solid.weight * evaluate(point.material->ambient, surface) * scene_.lights.world();
  add_direct_light(solid, surface, point, ray.o, hit, result);
  add_reflection_and_refraction(solid, surface, point);
}

void ClassicIntegrator::add_direct_light(const Branch &branch, const Surface &surface, const ShadingPoint &point,
                                         const glm::dvec3 &eye, const Hit &hit, SampleResult &result) {
  static const CourseLight plain;
  const LitPoints lit = lit_points(scene_, surface, point, hit, eye);
  const glm::vec3 ambient = branch.weight * evaluate(point.material->ambient, surface);
  const auto &lights = scene_.lights.lights();
  const auto &emitters = scene_.lights.emitters();
  for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
    // Take a point of the lamp: its middle when there is one sample only.
    const uint32_t dimension = kDimensionLamp + 2 * (branch.depth * uint32_t(scene_.lights.size()) + i);
    const glm::vec2 u = generator_.middle() ? glm::vec2(0.5f) : samplers_[branch.slot].get2(dimension);
    const bool lamp = i < lights.size();
    const CourseLight &course = lamp ? lights[i].course : plain;
    const auto sample_from = [&](const glm::dvec3 &p) {
      return lamp ? sample(lights[i], p, u)
                  : emitters[i - lights.size()].sample(scene_.geometry, scene_.slots, scene_.materials, p, u);
    };
    // Illuminate each lit point as if nothing stood between.
    glm::vec3 light(0.0f);
    for (int k = 0; k < lit.count; ++k) {
      const LightSample s = sample_from(lit.points[k].p);
      if (!(s.pdf > 0.0))
        continue;
      const glm::vec3 irradiance = course_irradiance(course, s);
      light += lit.weights[k] * course_illumination(*point.bsdf, lit.points[k], glm::vec3(s.wi), course, irradiance);
      if (lamp)
        result.radiance += ambient * course.ambient_color * irradiance * (kInvPi * lit.weights[k]);
    }
    if (light == glm::vec3(0.0f))
      continue;
    // Ask whether the lamp is seen from the hit point, on the viewer's side of the surface.
    const LightSample s = sample_from(surface.p);
    const bool same_side = (glm::dot(glm::vec3(s.wi), surface.ng) > 0.0f) == point.outside;
    if (s.pdf > 0.0 && same_side)
      shadows_.push(shadow_ray(surface, s), branch.slot, branch.weight * light);
  }
}

void ClassicIntegrator::add_reflection_and_refraction(const Branch &branch, const Surface &surface, const ShadingPoint &point) {
  // Beyond the depth limit a ray is black: it need not be traced.
  if (branch.depth >= settings_.max_bounces)
    return;
  const glm::vec3 up(point.wo.x, point.wo.y, std::abs(point.wo.z));
  const float side = point.wo.z < 0.0f ? -1.0f : 1.0f;
  const CourseBranches branches = course_branches(*point.bsdf, point.wo, point.wo.z >= 0.0f);
  const auto to_world = [&](const glm::vec3 &w) { return point.frame.to_world({w.x, w.y, side * w.z}); };
  // About an interpolated normal a mirrored direction may point into the surface: such a ray is black.
  const auto spawn_towards = [&](const glm::vec3 &w, const glm::vec3 &weight) {
    const glm::vec3 wi = to_world(w);
    if (point.consistent(wi, {w.x, w.y, side * w.z}))
      spawn(branch, surface, wi, weight);
  };
  spawn_towards(reflect_local(up), branches.reflected);
  if (branches.cos_t > 0.0f)
    spawn_towards(branches.eta == 1.0f ? -up : refract_local(up, branches.eta, branches.cos_t), branches.refracted);
}

void ClassicIntegrator::spawn(const Branch &parent, const Surface &surface, const glm::vec3 &direction,
                              const glm::vec3 &weight) {
  Branch child = parent;
  child.weight *= weight;
  ++child.depth;
  // Stop what can no longer matter.
  const float share = largest(child.weight);
  if (!(share > 0.0f) || share <= settings_.contribution_threshold)
    return;
  next_branches_.push_back(child);
  next_rays_.push_back(leave(surface, glm::dvec3(direction), std::numeric_limits<double>::infinity()));
}

} // namespace lancer
