#include "integrator/stages/surface_stage.h"

#include "integrator/stages/light_passes.h"
#include "sampling/color.h"

#include <algorithm>

namespace lancer {

SurfaceStage::SurfaceStage(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
    : kernel(vertex_kernel()), node_kernel_(node_kernel()), scene_(scene), shader_(scene, &camera), cone_(camera),
      values_(shader_.values().size()), lobes_(kernel.lobes_bytes / sizeof(Lobes) + 1) {
  const LightPasses passes(settings);
  block.values = reinterpret_cast<const float(*)[4][kBlockLanes]>(values_.data());
  block.lobes = reinterpret_cast<std::byte *>(lobes_.data());
  nodes_.scene = shader_.node_scene();
  block.shares_wanted = block.wants_shown = passes.components();
  block.wants_normal = settings.passes >> LANCER_PASS_NORMAL & 1;
  block.wants_matt_normal = passes.occlusion();
  block.wants_mixture = passes.features();
  block.blended = settings.blended_features;
}

uint32_t SurfaceStage::add(const Ray &ray, const Hit &hit, const Material &material) {
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const uint32_t lane = count_++, bit = 1u << lane;
  rays_[lane] = &ray;
  hits_[lane] = &hit;
  emission[lane] = material.emission.value;
  transmittance[lane] = glm::max(material.transmittance.value, 0.0f);
  block.through[lane] = material.transmits() ? mean(transmittance[lane]) : 0.0f;
  block.used |= bit;
  block.placement[lane] = instance.placement();
  if (instance.kind == ShapeKind::Mesh) {
    const Mesh &mesh = scene_.geometry.meshes[instance.mesh];
    const glm::uvec3 &triangle = mesh.triangles[hit.primitive];
    for (int corner = 0; corner < 3; ++corner)
      put(mesh.positions[triangle[corner]], block.corner[corner], lane);
    glm::vec3 n[3];
    if (corner_normals(mesh, instance.shading, hit.primitive, n)) {
      for (int corner = 0; corner < 3; ++corner)
        put(n[corner], block.normals[corner], lane);
      block.smooth |= bit;
    }
    block.on_mesh |= bit;
    block.bary[0][lane] = hit.u;
    block.bary[1][lane] = hit.v;
  } else {
    block.exact |= bit;
    block.on_plane |= uint32_t{instance.kind == ShapeKind::Plane} << lane;
    block.on_cylinder |= uint32_t{instance.kind == ShapeKind::Cylinder} << lane;
    block.on_cone |= uint32_t{instance.kind == ShapeKind::Cone} << lane;
    put(ray.o, block.o, lane);
    block.t[lane] = hit.t;
  }
  put(ray.d, block.d, lane);
  block.terminator[lane] = instance.kind == ShapeKind::Mesh ? instance.terminator : 0.0f;
  block.material[lane] = &material;
  return lane;
}

void SurfaceStage::give(uint32_t lane, const Surface &surface, const glm::dvec3 &view) {
  block.on_mesh &= ~(1u << lane);
  block.smooth &= ~(1u << lane);
  block.exact &= ~(1u << lane);
  put(surface.p, block.p, lane);
  block.offset[lane] = surface.offset;
  put(surface.ng, block.ng, lane);
  put(surface.ns, block.ns, lane);
  put(view, block.d, lane);
}

void SurfaceStage::move(uint32_t lane, const Hit &hit) {
  hits_[lane] = &hit;
  block.bary[0][lane] = hit.u;
  block.bary[1][lane] = hit.v;
}

void SurfaceStage::find() {
  for (uint32_t lane = count_; lane < kBlockLanes; ++lane) {
    block.material[lane] = block.material[0];
    block.placement[lane] = block.placement[0];
  }
  kernel.surfaces(block);
}

void SurfaceStage::ask_nodes(std::span<const View> views) {
  const Material &material = *block.material[0];
  if (!material.surface_nodes.empty()) {
    place_nodes(material, views);
    node_kernel_.run(material.program, material.surface_nodes, nodes_, values_.data());
  }
  for (uint32_t lane = 0; lane < count_; ++lane) {
    const Material &of = *block.material[lane];
    emission[lane] = value(of.emission, lane);
    transmittance[lane] = of.transmits() ? glm::max(value(of.transmittance, lane), 0.0f) : glm::vec3(0.0f);
    block.through[lane] = mean(transmittance[lane]);
  }
}

// Both normals are turned to the viewer's side.
void SurfaceStage::place_nodes(const Material &material, std::span<const View> views) {
  nodes_.used = (1u << count_) - 1u;
  nodes_.backfacing = 0;
  float side[kBlockLanes];
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    const float facing =
        block.ng[0][lane] * block.wo[0][lane] + block.ng[1][lane] * block.wo[1][lane] + block.ng[2][lane] * block.wo[2][lane];
    side[lane] = facing < 0.0f ? -1.0f : 1.0f;
    nodes_.backfacing |= uint32_t(facing < 0.0f) << lane;
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      nodes_.p[axis][lane] = block.p[axis][lane];
      nodes_.wo[axis][lane] = block.wo[axis][lane];
      nodes_.ns[axis][lane] = side[lane] * block.ns[axis][lane];
      nodes_.ng[axis][lane] = side[lane] * block.ng[axis][lane];
    }
  for (uint32_t lane = 0; lane < count_; ++lane) {
    const Hit &met = hit(lane);
    nodes_.instance[lane] = met.instance;
    nodes_.primitive[lane] = met.primitive;
    nodes_.bary[0][lane] = met.u;
    nodes_.bary[1][lane] = met.v;
    nodes_.footprint[lane] = views[lane].footprint;
    if (material.program.asks_light_path)
      put(views[lane].path, nodes_, lane);
  }
}

void SurfaceStage::describe() {
  for (uint32_t lane = 0; lane < count_; ++lane)
    put(transmittance[lane], block.transmittance, lane);
  if (block.wants_normal | block.wants_matt_normal | block.wants_shown | block.wants_mixture)
    kernel.describe(block);
}

void SurfaceStage::clear() {
  count_ = 0;
  block.used = block.on_mesh = block.smooth = block.exact = block.on_plane = block.on_cylinder = block.on_cone = 0;
}

Surface SurfaceStage::surface(uint32_t lane) const {
  const Hit &met = hit(lane);
  Surface surface;
  surface.p = get(block.p, lane);
  surface.offset = block.offset[lane];
  surface.ng = get(block.ng, lane);
  surface.ns = get(block.ns, lane);
  // Exact surfaces have no corner weights: their hits have 0.
  surface.bary = {met.u, met.v};
  surface.instance = met.instance;
  surface.primitive = met.primitive;
  surface.material = material_of(scene_.geometry, scene_.slots, met.instance, met.primitive);
  return surface;
}

glm::vec3 SurfaceStage::value(const Parameter &parameter, uint32_t lane) const {
  if (!parameter.varies())
    return parameter.value;
  const auto &node = values_[size_t(parameter.node)].of;
  return {node[0][lane], node[1][lane], node[2][lane]};
}

float SurfaceStage::holdout(uint32_t lane) const {
  return std::clamp(value(block.material[lane]->holdout, lane).x, 0.0f, 1.0f);
}

Mixture<float> SurfaceStage::mixture(uint32_t lane) const {
  return {get(block.mixed_normal, lane), get(block.mixed_diffuse, lane), get(block.mixed_specular, lane), block.mixed_all[lane],
          block.mixed_matt[lane]};
}

void SurfaceStage::write_shadow_ray(uint32_t lane, bool far, Ray &ray) const {
  const double end = far ? std::numeric_limits<double>::infinity() : 1.0;
  if (block.lifted >> lane & 1) {
    LightSample sample;
    sample.wi = get(block.light_wi, lane);
    sample.target = get(block.light_target, lane);
    sample.distance = end;
    ray = shadow_ray(scene_.geometry, surface(lane), get(block.viewer_ns, lane), get(block.viewer_ng, lane), sample);
    return;
  }
  const glm::dvec3 o = get(block.shadow_origin, lane);
  leave(hit(lane), o, far ? get(block.light_wi, lane) : get(block.light_target, lane) - o, end, LANCER_RAY_SHADOW, ray);
}

} // namespace lancer
