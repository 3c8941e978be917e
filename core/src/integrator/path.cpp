#include "integrator/path.h"

#include "sampling/color.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lancer {

namespace {

// The power heuristic in ratio form: infinite densities give 0 or 1, never NaN.
float mis_weight(double pdf, double other) {
  const double ratio = other / pdf;
  return float(1.0 / (1.0 + ratio * ratio));
}

// Roulette starts where most of the light has been gathered.
constexpr uint32_t kRouletteAfter = 3;

constexpr glm::vec3 divided(const glm::vec3 &a, const glm::vec3 &b) {
  return {b.x != 0.0f ? a.x / b.x : 0.0f, b.y != 0.0f ? a.y / b.y : 0.0f, b.z != 0.0f ? a.z / b.z : 0.0f};
}

// What sent a ray that a BSDF has sampled.
uint32_t ray_kind(const BsdfSample &sample) {
  if (sample.transmitted)
    return LANCER_RAY_TRANSMISSION;
  return sample.component == Component::Diffuse ? LANCER_RAY_DIFFUSE : LANCER_RAY_GLOSSY;
}

void put(const glm::vec3 &v, VertexBlock::Floats (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = v[i];
}
void put(const glm::dvec3 &v, VertexBlock::Doubles (&lanes)[3], uint32_t lane) {
  for (int i = 0; i < 3; ++i)
    lanes[i][lane] = v[i];
}
glm::vec3 get(const VertexBlock::Floats (&lanes)[3], uint32_t lane) { return {lanes[0][lane], lanes[1][lane], lanes[2][lane]}; }
glm::dvec3 get(const VertexBlock::Doubles (&lanes)[3], uint32_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

} // namespace

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::run(std::span<const SampleAddress> addresses, std::span<SampleResult> results,
                                         std::vector<PathVertex> *trace) {
  // Start one path per sample.
  generate(addresses, results);
  while (!paths_.empty() && !settings_.cancelled()) {
    // Find where every path goes next.
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    // Gather emission, ask a light, choose how each path goes on.
    shade(results, trace);
    // Add the light that was not in shadow.
    counts_.shadow += shadows_.trace([&](const WaitingLight &waiting, const glm::vec3 &light) {
      SampleResult &result = results[waiting.slot];
      if (waiting.occlusion) {
        result.light[kLightOcclusion] += light;
        return;
      }
      if (waiting.indirect)
        indirect_[waiting.slot] += light;
      else
        result.radiance += light;
      passes_.add(result, light, waiting.share, waiting.indirect);
    });
    counts_.bounce += next_rays_.size();
    paths_.swap(next_paths_);
    rays_.swap(next_rays_);
  }
  // Join the indirect light, clamped if that was asked for.
  for (size_t slot = 0; slot < results.size(); ++slot) {
    glm::vec3 indirect = indirect_[slot];
    const float top = largest(indirect);
    if (settings_.clamp_indirect > 0.0f && top > settings_.clamp_indirect) {
      indirect *= settings_.clamp_indirect / top;
      passes_.scale_indirect(results[slot], settings_.clamp_indirect / top);
    }
    results[slot].radiance += indirect;
  }
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  paths_.clear();
  rays_.clear();
  indirect_.assign(addresses.size(), glm::vec3(0.0f));
  for (uint32_t slot = 0; slot < addresses.size(); ++slot) {
    Path path{.sampler = generator_.sampler(addresses[slot]), .slot = slot};
    path.features = begin_features(settings_, passes_.features());
    Ray ray;
    if (!generator_.start(addresses[slot], path.sampler, passes_.wanted(), results[slot], ray))
      continue;
    path.from = ray.o;
    rays_.push_back(ray);
    paths_.push_back(path);
  }
  counts_.camera += paths_.size();
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::shade(std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  next_paths_.clear();
  next_rays_.clear();
  add_lights_met(results);
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (i + 1 < paths_.size())
      textures_.ahead(hits_[i + 1]);
    Path path = paths_[i];
    const Ray &ray = rays_[i];
    const double t = hits_[i].t;
    SampleResult &result = results[path.slot];
    if (!hits_[i].valid()) {
      miss(path, ray, result);
      continue;
    }
    const uint32_t material = material_of(scene_.geometry, scene_.slots, hits_[i].instance, hits_[i].primitive);
    if (const WideMaterial *wide = trace ? nullptr : for_lanes(material, hits_[i].instance))
      put_in_lane(i, material, *wide, results);
    else
      shade_surface(path, ray, t, surface_at(scene_.geometry, scene_.slots, ray, hits_[i]), results, trace);
  }
  shade_lanes(results);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::shade_surface(Path &path, const Ray &ray, double t, const Surface &surface,
                                                   std::span<SampleResult> results, std::vector<PathVertex> *trace) {
  // Ask the material what it does to light that goes back along the ray.
  SampleResult &result = results[path.slot];
  const double way = path.length + t * glm::length(ray.d);
  shader_.shade(surface, {.wo = glm::vec3(-glm::normalize(ray.d)), .footprint = float(cone_.base + way * cone_.spread)},
                point_);
  if (trace) {
    const glm::vec3 so_far = result.radiance + indirect_[path.slot];
    trace->push_back({scene_.normalisation.to_world(surface.p), t / scene_.normalisation.scale, surface.ns, path.beta, so_far,
                      surface.instance, surface.primitive, surface.material, path.scatterings});
  }
  // Holes end what the camera sees.
  if (path.in_view && !cut_hole(scene_, surface, path.beta, point_, result))
    return;
  if (path.in_view)
    record(path, surface, t, result);
  add_emission(path, surface, point_.emission, result);
  if (path.features.open)
    add_denoising_features(scene_, camera_, point_, t * glm::length(ray.d), path.features, result);
  if (path.last)
    return;

  const bool ends = path.scatterings > settings_.max_bounces;
  // Share the path between what passes straight on and what the surface scatters.
  float pass = 0.0f;
  if constexpr (Layers) {
    const float through = mean(point_.transmittance);
    const float rest = ends ? 0.0f : mean(point_.bsdf.albedo());
    if (through > 0.0f)
      pass = through / (through + rest);
  }
  VertexNumbers u;
  if (!ends) {
    u = path.sampler.get8(kDimensionVertex + path.scatterings * kVertexStride);
    sample_light(path, surface, double(pass), u);
    if (path.scatterings == 0 && passes_.occlusion())
      sample_occlusion(path, surface, u);
  }
  if constexpr (Layers) {
    const uint32_t dimension = kDimensionOpacity + 2 * (path.scatterings * kMaxLayers + path.layers);
    if (pass > 0.0f && (pass >= 1.0f || path.sampler.get1(dimension) < pass)) {
      if (path.layers + 1 < kMaxLayers) {
        next_rays_.push_back(pass_straight_on(path, surface, ray, t, point_.transmittance / pass));
        next_paths_.push_back(path);
      }
      return;
    }
  }
  if (ends)
    return;
  Ray next;
  path.length = way;
  if (scatter(path, surface, double(pass), u, next) && survives(path, u[kVertexRoulette])) {
    next_paths_.push_back(path);
    next_rays_.push_back(next);
  }
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add(const Path &path, SampleResult &result, const glm::vec3 &radiance, bool environment) {
  // Light that was scattered at most once is direct; clamping never touches it.
  const bool indirect = path.scatterings > 1;
  if (path.features.open)
    result.albedo += path.features.beta * radiance;
  // What the camera sees through clear glass is in no pass of indirect light: clamp it by itself.
  if (path.in_view) {
    const float top = largest(radiance), limit = settings_.clamp_indirect;
    const glm::vec3 seen = indirect && limit > 0.0f && top > limit ? radiance * (limit / top) : radiance;
    result.radiance += seen;
    passes_.add_seen(result, seen, environment);
    return;
  }
  if (indirect)
    indirect_[path.slot] += radiance;
  else
    result.radiance += radiance;
  passes_.add(result, radiance, path.share, indirect);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::miss(const Path &path, const Ray &ray, SampleResult &result) {
  if (path.in_view && !path.seen)
    forget_place(result);
  if (path.scatterings == 0)
    add_sky_features(path.features, result);
  // A transparent film does not show the environment itself, only what it lights.
  if (path.in_view && settings_.film_transparent) {
    result.alpha -= mean(path.beta);
    return;
  }
  if (!(path.kinds & ~scene_.world.hidden_from))
    return;
  const Environment &environment = scene_.lights.environment();
  if (!environment.varies()) {
    add(path, result, path.beta * environment.constant(), true);
    return;
  }
  // The environment is sampled as a light, too.
  const glm::dvec3 wi = glm::normalize(ray.d);
  float weight = 1.0f;
  if (path.pdf > 0.0)
    weight =
        mis_weight(path.pdf, environment.pdf(wi) * scene_.lights.probability(query(path), scene_.lights.environment_light()));
  const glm::dvec3 *eye = path.kinds == LANCER_RAY_CAMERA ? &path.from : nullptr;
  add(path, result, path.beta * environment.radiance(wi, shader_.values(), &camera_, eye) * weight, true);
}

// Lights stand in no one's way: adds all that the rays pass before they end.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::add_lights_met(std::span<SampleResult> results) {
  const LightSet &lights = scene_.lights;
  if (!lights.any_on_the_way())
    return;
  for (size_t first = 0; first < paths_.size(); first += kBlockLanes) {
    // Look from the last scattering, as sampling does.
    const uint32_t count = uint32_t(std::min<size_t>(kBlockLanes, paths_.size() - first));
    for (uint32_t lane = 0; lane < count; ++lane) {
      const Ray &ray = rays_[first + lane];
      put(paths_[first + lane].from, ways_.from, lane);
      put(ray.d, ways_.d, lane);
      ways_.end[lane] = way_end(first + lane);
    }
    for (const uint32_t number : lights.always_on_the_way()) {
      const uint32_t met = lanes_.meets(ways_, lights.plain_numbers(number)) & ((1u << count) - 1u);
      for (uint32_t rest = met; rest != 0; rest &= rest - 1)
        add_light_met(first + size_t(std::countr_zero(rest)), number, results);
    }
  }
  if (lights.finder().empty())
    return;
  for (size_t i = 0; i < paths_.size(); ++i)
    lights.finder().along(paths_[i].from, rays_[i].d / glm::length(rays_[i].d), way_end(i),
                          [&](uint32_t number) { add_light_met(i, number, results); });
}

template <uint32_t Shapes, bool Layers> double PathIntegrator<Shapes, Layers>::way_end(size_t i) const {
  return paths_[i].passed + std::min(hits_[i].t, rays_[i].tmax) * glm::length(rays_[i].d);
}

// One light, if the ray meets it on this stretch of the way.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_light_met(size_t i, uint32_t number, std::span<SampleResult> results) {
  const Path &path = paths_[i];
  const Ray &ray = rays_[i];
  const Light &light = scene_.lights.lights()[number];
  if (!(path.kinds & ~light.hidden_from))
    return;
  const double length = glm::length(ray.d);
  const LightHit met = meet(light, path.from, ray.d / length);
  // A sun lies behind all surfaces, wherever the view ends.
  const double begin = path.passed + ray.tmin * length;
  const bool far = std::isinf(met.distance);
  const bool here = far ? std::isinf(hits_[i].t) : met.distance >= begin && met.distance < way_end(i);
  if (!(met.pdf > 0.0) || !here)
    return;
  const float weight = path.pdf > 0.0 ? mis_weight(path.pdf, met.pdf * scene_.lights.probability(query(path), number)) : 1.0f;
  add(path, results[path.slot], path.beta * met.radiance * weight, false);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_emission(const Path &path, const Surface &surface, const glm::vec3 &emission,
                                                  SampleResult &result) {
  if (emission == glm::vec3(0.0f))
    return;
  float weight = 1.0f;
  const Emitter *emitter = path.pdf > 0.0 ? scene_.lights.emitter_of(surface.instance) : nullptr;
  if (emitter) {
    const double pdf = emitter->face_pdf(scene_.geometry, path.from, surface);
    weight = mis_weight(path.pdf, pdf * scene_.lights.probability(scene_.geometry, query(path), *emitter, surface.primitive));
  }
  add(path, result, path.beta * emission * weight, false);
}

// Fills the passes that describe what the camera sees.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::record(Path &path, const Surface &surface, double t, SampleResult &result) {
  // A surface that is hardly there gives way to the next one, unless the path ends on it.
  if (!path.seen && mean(point_.opacity()) >= settings_.alpha_threshold) {
    record_first_surface(scene_, settings_, surface, point_, path.depth + t, result);
    path.seen = true;
  } else if (!path.seen) {
    record_place(scene_, surface, point_, path.depth + t, result);
  }
  record_seen(scene_, camera_, settings_, passes_, surface, point_, path.beta, result);
}

// A light and a point of it, with the probability of both in pdf.
template <uint32_t Shapes, bool Layers>
LightSample PathIntegrator<Shapes, Layers>::ask_light(const Surface &surface, const VertexNumbers &u,
                                                      LightSet::Choice &choice) {
  const LightQuery here(surface.p, point_.bsdf.ns, point_.bsdf.transmits);
  const double u_choice = double(u[kVertexLightChoice]) + 0x1p-24 * double(u[kVertexLightDigits]);
  choice = scene_.lights.choose(scene_.geometry, here, u_choice);
  if (!(choice.probability > 0.0))
    return {};
  LightSample light = sample_scene_light(scene_, choice, surface.p, {u[kVertexLight], u[kVertexLight + 1]}, shader_);
  if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
    return {};
  light.pdf *= choice.probability;
  return light;
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::send_shadow(const Path &path, const Surface &surface, const glm::vec3 &ns,
                                                 const glm::vec3 &ng, const LightSample &light, uint32_t number,
                                                 const WaitingLight &waiting, const glm::vec3 &contribution) {
  if (scene_.lights.no_shadow(number))
    shadows_.push_lit(waiting, contribution);
  else
    shadows_.push(shadow_ray(scene_.geometry, surface, ns, ng, light), waiting, contribution, path.passed_through);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::sample_light(const Path &path, const Surface &surface, double pass,
                                                  const VertexNumbers &u) {
  if (scene_.lights.empty() || !point_.bsdf.smooth)
    return;
  LightSet::Choice choice;
  const LightSample light = ask_light(surface, u, choice);
  if (!(light.pdf > 0.0))
    return;
  // Ask the surface how much of it goes towards the viewer, without what the light is hidden from.
  BsdfValue value = point_.bsdf.template eval_lit<Shapes>(glm::vec3(light.wi));
  const uint32_t hidden = scene_.lights.hidden_from(choice.light);
  if (hidden & LANCER_RAY_DIFFUSE)
    value.part[size_t(Component::Diffuse)] = glm::vec3(0.0f);
  if (hidden & LANCER_RAY_GLOSSY)
    value.part[size_t(Component::Glossy)] = glm::vec3(0.0f);
  if (hidden & LANCER_RAY_TRANSMISSION)
    value.part[size_t(Component::Transmission)] = glm::vec3(0.0f);
  const glm::vec3 f = value.f();
  if (f == glm::vec3(0.0f))
    return;
  // The BSDF finds the same light by the samples that do not pass straight on.
  const float weight = light.delta ? 1.0f : mis_weight(light.pdf, double(value.pdf) * (1.0 - pass));
  const glm::vec3 contribution = path.beta * f * light.radiance * float(double(weight) / light.pdf);
  WaitingLight waiting{.slot = path.slot, .indirect = path.scatterings > 0};
  if (passes_.wanted()) {
    for (size_t component = 0; component < 2; ++component)
      waiting.share[component] = path.in_view ? divided(value.part[component], f) : path.share[component];
  }
  send_shadow(path, surface, point_.bsdf.ns, point_.bsdf.ng, light, choice.light, waiting, contribution);
}

// The record of a surface that kernels of many lanes shade; null for the others.
template <uint32_t Shapes, bool Layers>
const WideMaterial *PathIntegrator<Shapes, Layers>::for_lanes(uint32_t material, uint32_t instance) const {
  if (!wide_ || material == kNone || scene_.wide[material].count == 0 || scene_.geometry.instances[instance].holdout)
    return nullptr;
  // Only the general code knows what stays in view behind glass.
  if (settings_.transparent_glass && scene_.wide[material].transmits)
    return nullptr;
  return &scene_.wide[material];
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::put_in_lane(size_t number, uint32_t material, const WideMaterial &wide,
                                                 std::span<SampleResult> results) {
  const Path &path = paths_[number];
  const bool ends = path.last || path.scatterings > settings_.max_bounces;
  const Material &described = scene_.materials[material];
  if (ends && !described.emits() && !described.transmits())
    return;
  const Hit &hit = hits_[number];
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const uint32_t lane = waiting_count_++, bit = 1u << lane;
  waiting_[lane] = {number, ends, 0, false, described.emission.value, glm::max(described.transmittance.value, 0.0f)};
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
        put(n[corner], block_.normal[corner], lane);
      block_.smooth |= bit;
    }
    block_.on_mesh |= bit;
    block_.bary[0][lane] = hit.u;
    block_.bary[1][lane] = hit.v;
  }
  put(rays_[number].d, block_.d, lane);
  put(path.beta, block_.beta, lane);
  block_.terminator[lane] = instance.kind == ShapeKind::Mesh ? instance.terminator : 0.0f;
  block_.material[lane] = &wide;
  if (wide.transmits)
    block_.transmits |= bit;
  for (int i = 0; i < 3; ++i) {
    block_.weight[i][lane] = wide.weight[i];
    block_.base[i][lane] = wide.base[i];
  }
  block_.through[lane] = described.transmits() ? mean(waiting_[lane].transmittance) : 0.0f;
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
  if (waiting_count_ == kBlockLanes)
    shade_lanes(results);
}

template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::draw_numbers() {
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

template <uint32_t Shapes, bool Layers> Surface PathIntegrator<Shapes, Layers>::surface_of(uint32_t lane) const {
  return surface_at(scene_.geometry, scene_.slots, rays_[waiting_[lane].number], hits_[waiting_[lane].number]);
}

// Where each lane's hit is, and what the surface is like there.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::find_surfaces() {
  lanes_.surfaces(block_);
  for (uint32_t lane = 0; lane < waiting_count_; ++lane)
    if (!(block_.on_mesh >> lane & 1)) {
      const Surface surface = surface_of(lane);
      put(surface.p, block_.p, lane);
      put(surface.ng, block_.ng, lane);
      put(surface.ns, block_.ns, lane);
      block_.offset[lane] = surface.offset;
    }
  // Glass looks different from inside.
  for (uint32_t lane = 0; lane < waiting_count_; ++lane)
    if (block_.material[lane]->inside && glm::dot(get(block_.wo, lane), get(block_.ng, lane)) < 0.0f)
      block_.material[lane] += block_.material[lane]->inside;
}

// Colours that nodes say.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::ask_nodes() {
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    if (!block_.material[lane]->nodes)
      continue;
    Waiting &waiting = waiting_[lane];
    const Hit &hit = hits_[waiting.number];
    Surface surface;
    surface.p = get(block_.p, lane);
    surface.offset = block_.offset[lane];
    surface.ng = get(block_.ng, lane);
    surface.ns = get(block_.ns, lane);
    surface.bary = block_.on_mesh >> lane & 1 ? glm::dvec2(hit.u, hit.v) : glm::dvec2(0.0);
    surface.instance = hit.instance;
    surface.primitive = hit.primitive;
    surface.material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
    const double way = paths_[waiting.number].length + hit.t * block_.length[lane];
    const NodeColors colors =
        shader_.colors(surface, {.wo = get(block_.wo, lane), .footprint = float(cone_.base + way * cone_.spread)});
    put(colors.weight, block_.weight, lane);
    put(colors.base, block_.base, lane);
    block_.through[lane] = mean(colors.transmittance);
    waiting.emission = colors.emission;
    waiting.transmittance = colors.transmittance;
  }
}

template <uint32_t Shapes, bool Layers> LightSet::Choice PathIntegrator<Shapes, Layers>::choose_light(uint32_t lane) const {
  // Seen from the viewer's side, as the light comes.
  const glm::vec3 ns = get(block_.ns, lane);
  const bool behind = glm::dot(get(block_.wo, lane), get(block_.ng, lane)) < 0.0f;
  const LightQuery here(get(block_.p, lane), behind ? -ns : ns, block_.transmits >> lane & 1);
  const double u = double(block_.u[kVertexLightChoice][lane]) + 0x1p-24 * double(block_.u[kVertexLightDigits][lane]);
  return scene_.lights.choose(scene_.geometry, here, u);
}

// Chooses a light for every lane; samples those that kernels do not know.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::ask_lights() {
  static const WideLamp nothing;
  block_.asked = 0;
  const bool row = !scene_.lights.row().empty();
  if (row) {
    block_.row = scene_.lights.row().data();
    block_.row_count = uint32_t(scene_.lights.row().size());
    lanes_.choose(block_);
  }
  for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
    block_.lamp[lane] = &nothing;
    block_.light_pdf[lane] = 0.0;
    block_.light_delta[lane] = block_.light_hidden[lane] = 0;
    if (lane >= waiting_count_ || waiting_[lane].ends || scene_.lights.empty() || !block_.material[lane]->smooth)
      continue;
    const LightSet::Choice choice =
        row ? LightSet::Choice{block_.chosen[lane], 0, block_.chosen_probability[lane]} : choose_light(lane);
    if (!(choice.probability > 0.0))
      continue;
    waiting_[lane].light = choice.light;
    block_.light_hidden[lane] = scene_.lights.hidden_from(choice.light);
    if (const WideLamp *lamp = scene_.lights.wide_lamp(choice.light)) {
      block_.lamp[lane] = lamp;
      block_.light_pdf[lane] = choice.probability;
      block_.asked |= 1u << lane;
      continue;
    }
    const LightSample light = sample_scene_light(scene_, choice, get(block_.p, lane),
                                                 {block_.u[kVertexLight][lane], block_.u[kVertexLight + 1][lane]}, shader_);
    if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
      continue;
    waiting_[lane].far = std::isinf(light.distance);
    put(light.wi, block_.light_wi, lane);
    put(light.target, block_.light_target, lane);
    put(light.radiance, block_.light_radiance, lane);
    block_.light_pdf[lane] = light.pdf * choice.probability;
    block_.light_delta[lane] = light.delta;
  }
}

template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::send_shadow_of(uint32_t lane) {
  const Waiting &waiting = waiting_[lane];
  const Path &path = paths_[waiting.number];
  const WaitingLight light{.slot = path.slot, .indirect = path.scatterings > 0};
  const glm::vec3 contribution = get(block_.contribution, lane);
  if (scene_.lights.no_shadow(waiting.light))
    return shadows_.push_lit(light, contribution);
  const double infinity = std::numeric_limits<double>::infinity();
  Ray ray;
  if (block_.lifted >> lane & 1) {
    LightSample sample;
    sample.wi = get(block_.light_wi, lane);
    sample.target = get(block_.light_target, lane);
    sample.distance = waiting.far ? infinity : 1.0;
    ray = shadow_ray(scene_.geometry, surface_of(lane), get(block_.viewer_ns, lane), get(block_.viewer_ng, lane), sample);
  } else {
    ray.o = get(block_.shadow_origin, lane);
    ray.d = waiting.far ? get(block_.light_wi, lane) : get(block_.light_target, lane) - ray.o;
    ray.tmax = waiting.far ? infinity : 1.0;
    ray.skip_instance = hits_[waiting.number].instance;
    ray.skip_primitive = hits_[waiting.number].primitive;
    ray.kinds = LANCER_RAY_SHADOW;
  }
  shadows_.push(ray, light, contribution, path.passed_through);
}

template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::shade_lanes(std::span<SampleResult> results) {
  if (waiting_count_ == 0)
    return;
  for (uint32_t lane = waiting_count_; lane < kBlockLanes; ++lane) {
    block_.material[lane] = block_.material[0];
    block_.placement[lane] = block_.placement[0];
  }
  draw_numbers();
  find_surfaces();
  ask_nodes();
  ask_lights();
  lanes_.shade(block_);
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    const size_t number = waiting_[lane].number;
    if (block_.odd >> lane & 1)
      shade_surface(paths_[number], rays_[number], hits_[number].t, surface_of(lane), results, nullptr);
    else
      leave_lane(lane, results[paths_[number].slot]);
  }
  waiting_count_ = 0;
  block_.used = block_.on_mesh = block_.smooth = block_.ends = block_.transmits = 0;
}

// What follows from a shaded lane: its light, its shadow ray, its next ray.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::leave_lane(uint32_t lane, SampleResult &result) {
  const Waiting &waiting = waiting_[lane];
  Path &path = paths_[waiting.number];
  const Hit &hit = hits_[waiting.number];
  if (waiting.emission != glm::vec3(0.0f))
    add_emission(path, surface_of(lane), waiting.emission, result);
  if (path.last)
    return;
  if (!waiting.ends && (block_.lit >> lane & 1))
    send_shadow_of(lane);
  if constexpr (Layers) {
    const float pass = block_.pass[lane];
    const uint32_t dimension = kDimensionOpacity + 2 * (path.scatterings * kMaxLayers + path.layers);
    if (pass > 0.0f && (pass >= 1.0f || path.sampler.get1(dimension) < pass)) {
      if (path.layers + 1 < kMaxLayers) {
        next_rays_.push_back(
            pass_straight_on(path, surface_of(lane), rays_[waiting.number], hit.t, waiting.transmittance / pass));
        next_paths_.push_back(path);
      }
      return;
    }
  }
  if (waiting.ends || !(block_.sampled >> lane & 1))
    return;
  path.in_view = false;
  path.length += hit.t * block_.length[lane];
  path.beta = get(block_.beta, lane);
  path.pdf = block_.pdf[lane];
  path.from = get(block_.p, lane);
  path.normal = get(block_.viewer_ns, lane);
  path.transmits = block_.transmits >> lane & 1;
  path.kinds = block_.transmitted >> lane & 1 ? LANCER_RAY_TRANSMISSION
               : block_.glossy >> lane & 1    ? LANCER_RAY_GLOSSY
                                              : LANCER_RAY_DIFFUSE;
  path.layers = 0;
  path.passed = 0.0;
  ++path.scatterings;
  if (!survives(path, block_.u[kVertexRoulette][lane]))
    return;
  Ray next;
  next.o = get(block_.next_origin, lane);
  next.d = glm::dvec3(get(block_.wi, lane));
  next.skip_instance = hit.instance;
  next.skip_primitive = hit.primitive;
  next.kinds = path.kinds;
  next_paths_.push_back(path);
  next_rays_.push_back(next);
}

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::sample_occlusion(const Path &path, const Surface &surface, const VertexNumbers &u) {
  // Look around the normal of what is diffuse, with the weight of a cosine.
  glm::vec3 n(0.0f);
  for (int i = 0; i < point_.bsdf.count; ++i)
    if (point_.bsdf.lobes[i].component == Component::Diffuse)
      n += point_.bsdf.frames[point_.bsdf.lobes[i].frame].n * mean(point_.bsdf.lobes[i].color);
  n = n == glm::vec3(0.0f) ? point_.bsdf.ns : glm::normalize(n);
  const glm::vec3 local = warp_cosine_hemisphere({u[kVertexBsdf], u[kVertexBsdf + 1]});
  const double distance = settings_.occlusion_distance * scene_.normalisation.scale;
  Ray ray =
      leave(surface, glm::dvec3(Frame(n).to_world(local)), distance > 0.0 ? distance : std::numeric_limits<double>::infinity());
  ray.kinds = LANCER_RAY_SHADOW;
  shadows_.push(ray, {.slot = path.slot, .occlusion = true}, path.beta * point_.opacity(), path.passed_through);
}

template <uint32_t Shapes, bool Layers>
Ray PathIntegrator<Shapes, Layers>::pass_straight_on(Path &path, const Surface &surface, const Ray &ray, double t,
                                                     const glm::vec3 &weight) const {
  const double length = t * glm::length(ray.d);
  path.beta *= weight;
  path.passed += length;
  path.length += length;
  path.depth += t;
  ++path.layers;
  // Beyond the last layer the next surface shows its own light only.
  path.last = ++path.passed_through >= settings_.transparent_bounces;
  Ray next = leave(surface, ray.d, ray.tmax - t);
  next.kinds = path.kinds;
  return next;
}

template <uint32_t Shapes, bool Layers>
bool PathIntegrator<Shapes, Layers>::scatter(Path &path, const Surface &surface, double pass, const VertexNumbers &u,
                                             Ray &next) const {
  // Draw a direction from the BSDF.
  const BsdfSample sample = point_.bsdf.template sample<Shapes>(u[kVertexLobe], {u[kVertexBsdf], u[kVertexBsdf + 1]});
  if (sample.weight == glm::vec3(0.0f) || !(sample.pdf > 0.0f))
    return false;
  // Glass that does not count leaves the picture what it was.
  const bool clear = settings_.transparent_glass && sample.transmitted && sample.component != Component::Diffuse &&
                     sample.alpha2 <= settings_.glass_alpha2;
  if (path.in_view && !clear) {
    path.in_view = false;
    for (int component = 0; component < 2; ++component)
      path.share[component] = sample.share[component];
  }
  // Go on from here.
  path.beta *= sample.weight / float(1.0 - pass);
  path.pdf = sample.delta ? 0.0 : double(sample.pdf) * (1.0 - pass);
  path.from = surface.p;
  path.normal = point_.bsdf.ns;
  path.transmits = point_.bsdf.transmits;
  path.kinds = ray_kind(sample);
  path.layers = 0;
  path.passed = 0.0;
  ++path.scatterings;
  next = leave(surface, glm::dvec3(sample.wi), std::numeric_limits<double>::infinity());
  next.kinds = path.kinds;
  return true;
}

template <uint32_t Shapes, bool Layers> bool PathIntegrator<Shapes, Layers>::survives(Path &path, float u) const {
  if (path.scatterings <= kRouletteAfter)
    return true;
  // End dark paths early; what survives is brightened by exactly that.
  const float q = std::min(1.0f, largest(path.beta));
  if (u >= q)
    return false;
  path.beta /= q;
  return true;
}

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  constexpr uint32_t matte = shape_bit(LobeShape::Lambert);
  constexpr uint32_t plastic = matte | shape_bit(LobeShape::Beckmann) | shape_bit(LobeShape::Microfacet);
  const uint32_t shapes = settings.all_features ? kAllShapes : scene.shapes;
  const bool layers = settings.all_features || (scene.features & kFeatureTransparency);
  if (layers)
    return std::make_unique<PathIntegrator<kAllShapes, true>>(scene, camera, settings, "path all");
  if ((shapes & ~matte) == 0)
    return std::make_unique<PathIntegrator<matte, false>>(scene, camera, settings, "path lambert");
  if ((shapes & ~plastic) == 0)
    return std::make_unique<PathIntegrator<plastic, false>>(scene, camera, settings, "path lambert+microfacet");
  return std::make_unique<PathIntegrator<kAllShapes, false>>(scene, camera, settings, "path all lobes, solid");
}

} // namespace lancer
