#include "integrator/classic/classic.h"

#include "compile/steps.h"
#include "integrator/aov/surface_extras.h"
#include "scene/hit_surface.h"
#include "simd/vectors.h"

#include <algorithm>

namespace lancer {

namespace {

// Glass doubles the rays at every depth. If more than kCrowd rays are queued, the batch is restarted in parts of kSmallPart
// samples, small enough for the deepest recursion.
constexpr size_t kCrowd = 8192, kSmallPart = 64;

// Returns the ambient light that Ka reflects: the world's own, else the environment where it is constant, else its mean.
glm::vec3 ambient_light(const Scene &scene, const Camera &camera) {
  if (scene.world.ambient)
    return *scene.world.ambient;
  const Environment &environment = scene.lights.environment();
  if (!environment.varies())
    return environment.constant();
  // Take the mean of the six axis directions, which is precise enough for the rough model of ambient light.
  std::vector<glm::vec4> values(scene.world.program.value_count());
  glm::vec3 sum(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 wi(0.0);
    for (double sign : {-1.0, 1.0}) {
      wi[axis] = sign;
      sum += environment.radiance(wi, values, &camera);
    }
  }
  return sum / 6.0f;
}

} // namespace

ClassicIntegrator::ClassicIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
    : scene_(scene), camera_(camera), settings_(settings), generator_(camera, scene.motion, settings), light_(scene, &camera),
      shadows_(scene, camera, settings), passes_(settings), vectors_(scene, camera, settings), queues_(scene),
      surfaces_(scene, camera, settings), kernel_(classic_kernel()), ambient_(ambient_light(scene, camera)),
      layout_(settings.extras()),
      only_combined_(settings.passes == bit(Pass::Combined) && !layout_.mattes && !layout_.has_outputs()),
      sky_values_(scene.world.program.value_count()) {}

void ClassicIntegrator::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                            std::vector<PathVertex> *trace) {
  extras_.begin(addresses.size(), layout_);
  for (size_t begin = 0; begin < addresses.size() && !settings_.cancelled();) {
    first_ = uint32_t(begin);
    const size_t size = std::min(crowded_ ? kSmallPart : addresses.size(), addresses.size() - begin);
    if (run_part(addresses.subspan(begin, size), results.subspan(begin, size), trace))
      begin += size;
    else
      // The following batches are likely to need small parts, too.
      crowded_ = true;
  }
}

// Returns false if the rays exceed kCrowd; the counts are then restored, and the caller must render the part again in smaller
// parts.
bool ClassicIntegrator::run_part(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                                 std::vector<PathVertex> *trace) {
  const RayCounts before = counts_;
  const uint64_t vertices_before = vertices_;
  const size_t mattes_before = extras_.mattes.size();
  generate(addresses, results);
  // Trace the recursion depth by depth, so that a pixel's sum has the same order in any batch.
  while (!rays_.empty() && !settings_.cancelled()) {
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    next_branches_.clear();
    next_rays_.clear();
    shade(results);
    for (size_t i = 0; i < rays_.size(); ++i)
      gather(i, results[branches_[i].sample], trace);
    counts_.shadow +=
        shadows_.trace([&](const WaitingLight &waiting, const glm::vec3 &light) { shadow_light_.add(waiting.target, light); });
    shadow_light_.sort();
    for (size_t i = 0; i < rays_.size(); ++i)
      for (const glm::vec3 &light : shadow_light_.of(i))
        results[branches_[i].sample].radiance += light;
    counts_.bounce += next_rays_.size();
    branches_.swap(next_branches_);
    rays_.swap(next_rays_);
    if (rays_.size() > kCrowd && addresses.size() > kSmallPart) {
      counts_ = before;
      vertices_ = vertices_before;
      extras_.mattes.resize(mattes_before);
      std::fill_n(extras_.channels.begin() + ptrdiff_t(size_t(first_) * layout_.channels()),
                  addresses.size() * layout_.channels(), 0.0f);
      return false;
    }
  }
  return true;
}

void ClassicIntegrator::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  branches_.clear();
  rays_.clear();
  samplers_.assign(addresses.size(), Sampler(0, 0));
  generator_.start(addresses, passes_.wanted(), results, [&](uint32_t sample, const Sampler &sampler) -> Ray & {
    samplers_[sample] = sampler;
    Branch &branch = branches_.emplace_back();
    branch.sample = sample;
    branch.guides = begin_guides(settings_, passes_.guides());
    return rays_.emplace_back();
  });
  counts_.camera += rays_.size();
}

void ClassicIntegrator::miss(const Branch &branch, const glm::dvec3 &eye, const glm::vec3 &direction, SampleResult &result) {
  if (branch.depth == 0)
    add_sky_guides(branch.guides, result);
  if (branch.depth == 0 && !branch.seen)
    vectors_.record_sky(glm::dvec3(direction), result);
  if (branch.depth == 0 && !branch.seen && layout_.has_outputs())
    add_sky_outputs(scene_, camera_, settings_, first_ + branch.sample, glm::dvec3(direction), eye, {.kinds = branch.kinds},
                    sky_values_, extras_);
  // A transparent film does not show the environment itself, but the environment's pass does.
  if (branch.depth == 0 && settings_.film_transparent) {
    result.alpha -= mean(branch.weight);
    if (!(settings_.passes & bit(Pass::Environment)))
      return;
  }
  if (!(branch.kinds & ~scene_.world.hidden_from))
    return;
  const glm::vec3 sky = scene_.lights.environment().radiance(glm::dvec3(direction), sky_values_, &camera_,
                                                             branch.depth == 0 ? &eye : nullptr, {.kinds = branch.kinds});
  add(branch, branch.weight * sky, true, result);
}

// Adds the light of a ray's vertex and queues the rays that leave it.
void ClassicIntegrator::gather(size_t number, SampleResult &result, std::vector<PathVertex> *trace) {
  Branch &branch = branches_[number];
  const Ray &ray = rays_[number];
  if (!hits_[number].valid())
    return miss(branch, ray.o, glm::vec3(glm::normalize(ray.d)), result);
  if (trace)
    trace_vertex(number, result, *trace);
  const Vertex &vertex = lit_[number];
  if (vertex.nothing)
    return;
  add(branch, branch.weight * vertex.emission, false, result);
  branch.guides.scattered = branch.depth > 0;
  if (branch.guides.open)
    add_denoising_guides(scene_, camera_, guides_[number].mixture, guides_[number].wo, vertex.transmittance,
                         hits_[number].t * glm::length(ray.d), branch.guides, result);
  result.radiance += branch.weight * vertex.ambient * ambient_;
  for (const glm::vec3 &light : own_light_.of(number))
    result.radiance += light;
  branch_out(number, result);
}

// Position comes from the hit, colour from the shaded vertex.
void ClassicIntegrator::trace_vertex(size_t number, const SampleResult &result, std::vector<PathVertex> &trace) const {
  const Hit &hit = hits_[number];
  const Surface met = surface_at(scene_.geometry, scene_.slots, rays_[number], hit);
  const glm::vec3 ns = is_flat(scene_.geometry.instances[hit.instance]) ? surface_at_center(scene_, hit, met.time).ns : met.ns;
  trace.push_back({scene_.normalisation.to_world(met.p), hit.t / scene_.normalisation.scale, ns, branches_[number].weight,
                   result.radiance, met.instance, met.primitive, met.material, branches_[number].depth});
}

void ClassicIntegrator::add(const Branch &branch, const glm::vec3 &light, bool environment, SampleResult &result) {
  // A transparent film leaves the environment behind it to the environment's pass: picture and guides have none of it.
  const bool hidden = environment && settings_.film_transparent && branch.depth == 0;
  if (!hidden)
    result.radiance += light;
  if (branch.guides.open && !hidden)
    result.albedo += branch.guides.beta * light;
  if (branch.depth == 0)
    passes_.add_seen(result, light, environment);
}

// Returns the unnormalised view direction from the eye to a place p other than the hit. A crossing is not the eye.
glm::dvec3 ClassicIntegrator::view_of(const Branch &branch, const Ray &ray, const glm::dvec3 &p) const {
  if (branch.depth > 0)
    return p - ray.o;
  return camera_.kind == CameraKind::Orthographic ? ray.d : p - (ray.o - branch.passed * ray.d);
}

void ClassicIntegrator::branch_out(size_t number, SampleResult &result) {
  const Branch &branch = branches_[number];
  const Vertex &vertex = lit_[number];
  // Guides follow each branch with its share of the light.
  const float all = branch.guides.open ? mean(vertex.transmittance + vertex.reflected + vertex.refracted) : 0.0f;
  const auto child = [&](const glm::vec3 &part) {
    Branch next = branch;
    next.guides.share *= all > 0.0f ? mean(part) / all : 0.0f;
    return next;
  };
  if (vertex.transmittance != glm::vec3(0.0f) && branch.crossings < settings_.transparent_bounces) {
    const Ray &ray = rays_[number];
    const Hit &hit = hits_[number];
    Branch behind = child(vertex.transmittance);
    behind.passed += hit.t;
    behind.weight *= vertex.transmittance;
    ++behind.crossings;
    push(behind, ray_from(surface_at(scene_.geometry, scene_.slots, ray, hit), ray.d, ray.tmax - hit.t));
  }
  // Beyond the depth limit a ray is black and need not be traced.
  if (branch.depth >= settings_.max_bounces)
    return;
  if (vertex.mirrors)
    spawn(child(vertex.reflected), vertex, vertex.mirrored, vertex.reflected, RayKind::Glossy, result);
  if (vertex.refracts)
    spawn(child(vertex.refracted), vertex, vertex.through, vertex.refracted, RayKind::Transmission, result);
}

void ClassicIntegrator::spawn(Branch child, const Vertex &vertex, const glm::vec3 &direction, const glm::vec3 &weight,
                              uint32_t kind, SampleResult &result) {
  child.weight *= weight;
  child.kinds = kind;
  child.crossings = 0;
  ++child.depth;
  // Stop a ray whose contribution cannot matter.
  const float share = largest(child.weight);
  if (!(share > 0.0f) || share <= settings_.contribution_threshold)
    return;
  // The cheap reflection: take the environment in that direction without testing for occluders.
  if (settings_.environment_reflections)
    return miss(child, vertex.p, direction, result);
  next_branches_.push_back(child);
  Ray &ray = next_rays_.emplace_back();
  ray.d = glm::dvec3(direction);
  ray.o = origin_towards<double>(vertex.p, vertex.offset, glm::dvec3(vertex.ng), ray.d);
  ray.tmax = std::numeric_limits<double>::infinity();
  ray.skip_instance = vertex.instance;
  ray.skip_primitive = vertex.primitive;
  ray.kinds = kind;
  ray.time = vertex.time;
}

void ClassicIntegrator::push(const Branch &branch, Ray ray) {
  ray.kinds = branch.kinds;
  next_branches_.push_back(branch);
  next_rays_.push_back(ray);
}

Surface surface_at_center(const Scene &scene, const Hit &hit, float time) {
  Instance moved;
  const Instance &instance = scene.geometry.placed_at(hit.instance, time, moved);
  const MeshView &mesh = scene.geometry.meshes[instance.mesh];
  Ray ray;
  ray.time = time;
  Surface surface = surface_at(scene.geometry, scene.slots, ray, center_hit(mesh, hit));
  if (mesh.centers.empty())
    return surface;
  const glm::vec3 normal = carried_normal(instance.to_object, glm::dvec3(mesh.centers[mesh.polygons[hit.primitive]].normal));
  if (normal != glm::vec3(0.0f))
    surface.ng = surface.ns = normal;
  return surface;
}

} // namespace lancer
