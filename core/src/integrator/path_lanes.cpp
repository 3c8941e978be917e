// Vertices of paths that are shaded side by side: into the lanes of a block, through the kernels, and out again.
#include "integrator/lane_access.h"
#include "integrator/path_kinds.h"
#include "sampling/color.h"

#include <cmath>

namespace lancer {

// The record of a surface that kernels of many lanes shade; null for the others.
template <uint32_t Shapes, bool Layers>
const WideMaterial *PathIntegrator<Shapes, Layers>::for_lanes(uint32_t material, uint32_t instance) const {
  if (!picture_alone_ || material == kNone || scene_.wide[material].count == 0 || scene_.geometry.instances[instance].holdout)
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
  // Part by part: a copy of the whole would wait until they have left the processor's stores.
  Waiting &waiting = waiting_[lane];
  waiting.number = number;
  waiting.ends = ends;
  waiting.light = 0;
  waiting.far = false;
  waiting.emission = described.emission.value;
  waiting.transmittance = glm::max(described.transmittance.value, 0.0f);
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
  } else if (instance.kind == ShapeKind::Sphere || instance.kind == ShapeKind::Plane) {
    (instance.kind == ShapeKind::Sphere ? block_.on_sphere : block_.on_plane) |= bit;
    put(rays_[number].o, block_.o, lane);
    block_.t[lane] = hit.t;
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
  block_.through[lane] = described.transmits() ? mean(waiting.transmittance) : 0.0f;
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
    if (!((block_.on_mesh | block_.on_sphere | block_.on_plane) >> lane & 1)) {
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
  const uint32_t pictured = ask_pictures();
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    if (!block_.material[lane]->nodes || (pictured >> lane & 1))
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
    const NodeColors colors = shader_.colors(
        surface, {.wo = get(block_.wo, lane),
                  .footprint = float(cone_.base + way * cone_.spread),
                  .path = light_path(paths_[waiting.number], (hit.t - rays_[waiting.number].tmin) * block_.length[lane])});
    put(colors.weight, block_.weight, lane);
    put(colors.base, block_.base, lane);
    block_.through[lane] = mean(colors.transmittance);
    waiting.emission = colors.emission;
    waiting.transmittance = colors.transmittance;
  }
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
  block_.used = block_.on_mesh = block_.on_sphere = block_.on_plane = block_.smooth = block_.ends = block_.transmits = 0;
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
  if constexpr (Layers)
    if (const float pass = block_.pass[lane]; path.chooses_to_pass(pass))
      return pass_straight_on(path, surface_of(lane), rays_[waiting.number], hit.t, waiting.transmittance / pass);
  if (waiting.ends || !(block_.sampled >> lane & 1))
    return;
  const uint32_t scatterings = path.scatterings + 1;
  glm::vec3 beta = get(block_.beta, lane);
  if (!survives(scatterings, block_.u[kVertexRoulette][lane], beta))
    return;
  Path &next = next_paths_.emplace_back(path.sampler, path.slot);
  next.beta = beta;
  next.from = get(block_.p, lane);
  next.normal = get(block_.viewer_ns, lane);
  next.transmits = block_.transmits >> lane & 1;
  next.pdf = block_.pdf[lane];
  next.scatterings = scatterings;
  next.kinds = block_.transmitted >> lane & 1 ? LANCER_RAY_TRANSMISSION
               : block_.glossy >> lane & 1    ? LANCER_RAY_GLOSSY
                                              : LANCER_RAY_DIFFUSE;
  next.passed_through = path.passed_through;
  next.story = path.story;
  next.story.scatter(next.kinds == LANCER_RAY_DIFFUSE, next.kinds == LANCER_RAY_TRANSMISSION, next.pdf == 0.0);
  next.in_view = false;
  next.length = path.length + hit.t * block_.length[lane];
  leave(hit, get(block_.next_origin, lane), glm::dvec3(get(block_.wi, lane)), std::numeric_limits<double>::infinity(),
        next.kinds, next_rays_.emplace_back());
}

#define LANCER_PATH(shapes, layers)                                                                                            \
  template const WideMaterial *PathIntegrator<shapes, layers>::for_lanes(uint32_t, uint32_t) const;                            \
  template void PathIntegrator<shapes, layers>::put_in_lane(size_t, uint32_t, const WideMaterial &, std::span<SampleResult>);  \
  template Surface PathIntegrator<shapes, layers>::surface_of(uint32_t) const;                                                 \
  template void PathIntegrator<shapes, layers>::shade_lanes(std::span<SampleResult>);
LANCER_PATH_KINDS(LANCER_PATH)
#undef LANCER_PATH

} // namespace lancer
