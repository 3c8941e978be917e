#include "integrator/stages/surface.h"

#include "compile/scene.h"
#include "integrator/stages/light_passes.h"
#include "scene/bake.h"
#include "simd/vectors.h"

#include <algorithm>
#include <bit>

namespace lancer {

const SurfaceKernel &surface_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(surface_kernel); }

namespace {

MeansWanted means_wanted(const IntegratorSettings &settings) {
  const LightPasses passes(settings);
  return {.normal = (settings.passes & bit(Pass::Normal)) != 0,
          .matt_normal = passes.occlusion() || settings.ambient > 0.0f,
          .shown = passes.components() || settings.ambient > 0.0f,
          .mixture = passes.guides(),
          .blended = settings.blended_features,
          .bare_roughness = settings.bake ? settings.bake->bare_roughness : -1.0f};
}

} // namespace

SurfaceStage::SurfaceStage(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
    : kernel_(surface_kernel()), node_kernel_(node_kernel()), scene_(scene), cone_(camera), wanted_(means_wanted(settings)),
      values_(most_values(scene.materials)), storage_(kernel_.lobes_bytes / sizeof(Bytes) + 1) {
  materials_.values = reinterpret_cast<const float(*)[4][kBlockLanes]>(values_.data());
  materials_.shares = wanted_.shown;
  materials_.spreads = scene.features & kFeatureMipmaps;
  const bool path = settings.kind() == IntegratorKind::Path;
  materials_.no_reflections = path && settings.no_reflections;
  materials_.no_refractions = path && settings.no_refractions;
  materials_.blurs = path && settings.filter_glossy > 0.0f;
  lobes_.storage = reinterpret_cast<std::byte *>(storage_.data());
  nodes_.scene = scene.node_scene(&camera);
  if (!(scene.features & kFeatureMotion))
    return;
  placed_.resize(kBlockLanes);
  nodes_.moved = &moved_;
}

uint32_t SurfaceStage::add(const Ray &ray, const Hit &hit, const MaterialView &material, bool ends) {
  const Instance &instance = scene_.geometry.instances[hit.instance];
  const uint32_t lane = count_++, bit = 1u << lane;
  ray_of_[lane] = &ray;
  hit_of_[lane] = &hit;
  emission_[lane] = material.emission.value;
  transmittance_[lane] = glm::max(material.transmittance.value, 0.0f);
  materials_.material[lane] = &material;
  materials_.through[lane] = material.is_transparent() ? mean(transmittance_[lane]) : 0.0f;
  materials_.ends |= uint32_t{ends} << lane;
  materials_.seen_by_camera |= uint32_t{(ray.kinds & kCameraKinds) != 0} << lane;
  hits_.used |= bit;
  hits_.placement[lane] = instance.placement();
  surfaces_.time[lane] = ray.time;
  if (!placed_.empty()) {
    const Instance &placed = scene_.geometry.placed_at(hit.instance, ray.time, placed_[lane]);
    hits_.placement[lane] = placed.placement();
    moved_.instance[lane] = &placed;
    moved_.time[lane] = ray.time;
  }
  if (instance.kind == ShapeKind::Mesh) {
    const MeshView &mesh = scene_.geometry.meshes[instance.mesh];
    for (int corner = 0; corner < 3; ++corner)
      put(mesh.vertex(hit.primitive, corner, ray.time), hits_.corner[corner], lane);
    glm::vec3 n[3];
    if (corner_normals(mesh, instance.shading, hit.primitive, ray.time, n)) {
      for (int corner = 0; corner < 3; ++corner)
        put(n[corner], hits_.normals[corner], lane);
      hits_.smooth |= bit;
    }
    hits_.on_mesh |= bit;
    hits_.bary[0][lane] = hit.u;
    hits_.bary[1][lane] = hit.v;
  } else {
    hits_.exact |= bit;
    hits_.on_plane |= uint32_t{instance.kind == ShapeKind::Plane} << lane;
    hits_.on_cylinder |= uint32_t{instance.kind == ShapeKind::Cylinder} << lane;
    hits_.on_cone |= uint32_t{instance.kind == ShapeKind::Cone} << lane;
    put(ray.o, hits_.o, lane);
    hits_.t[lane] = hit.t;
  }
  put(ray.d, hits_.d, lane);
  surfaces_.terminator[lane] = instance.kind == ShapeKind::Mesh ? instance.terminator : 0.0f;
  return lane;
}

void SurfaceStage::replace(uint32_t lane, const Surface &surface, const glm::dvec3 &view) {
  hits_.on_mesh &= ~(1u << lane);
  hits_.smooth &= ~(1u << lane);
  hits_.exact &= ~(1u << lane);
  put(surface.p, surfaces_.p, lane);
  surfaces_.offset[lane] = surface.offset;
  put(surface.ng, surfaces_.ng, lane);
  put(surface.ns, surfaces_.ns, lane);
  surfaces_.time[lane] = surface.time;
  view_along(lane, view);
}

void SurfaceStage::move(uint32_t lane, const Hit &hit) {
  hit_of_[lane] = &hit;
  hits_.bary[0][lane] = hit.u;
  hits_.bary[1][lane] = hit.v;
}

void SurfaceStage::go_back(const Places &places) {
  hits_ = places.hits;
  surfaces_ = places.surfaces;
  lobes_ = places.lobes;
}

void SurfaceStage::find() {
  for (uint32_t lane = count_; lane < kBlockLanes; ++lane) {
    materials_.material[lane] = materials_.material[0];
    hits_.placement[lane] = hits_.placement[0];
  }
  kernel_.find(hits_, surfaces_);
}

void SurfaceStage::run_nodes(std::span<const View> views) {
  const MaterialView &material = *materials_.material[0];
  if (!material.surface_nodes.empty() || outputs_asked_)
    place_nodes(material, views);
  if (!material.surface_nodes.empty())
    node_kernel_.run(material.program, material.surface_nodes, nodes_, values_.data());
  if (outputs_asked_)
    node_kernel_.run(material.program, material.output_nodes, nodes_, values_.data());
  for (uint32_t lane = 0; lane < count_; ++lane) {
    const MaterialView &of = *materials_.material[lane];
    emission_[lane] = value(of.emission, lane);
    transmittance_[lane] = of.is_transparent() ? glm::max(value(of.transmittance, lane), 0.0f) : glm::vec3(0.0f);
    materials_.through[lane] = mean(transmittance_[lane]);
  }
}

// Turns both normals to the viewer's side.
void SurfaceStage::place_nodes(const MaterialView &material, std::span<const View> views) {
  const SurfaceBlock &at = surfaces_;
  nodes_.used = (1u << count_) - 1u;
  nodes_.backfacing = 0;
  float side[kBlockLanes];
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    const float facing = at.ng[0][lane] * at.wo[0][lane] + at.ng[1][lane] * at.wo[1][lane] + at.ng[2][lane] * at.wo[2][lane];
    side[lane] = facing < 0.0f ? -1.0f : 1.0f;
    nodes_.backfacing |= uint32_t(facing < 0.0f) << lane;
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      nodes_.p[axis][lane] = at.p[axis][lane];
      nodes_.wo[axis][lane] = at.wo[axis][lane];
      nodes_.ns[axis][lane] = side[lane] * at.ns[axis][lane];
      nodes_.ng[axis][lane] = side[lane] * at.ng[axis][lane];
    }
  for (uint32_t lane = 0; lane < count_; ++lane) {
    const Hit &met = hit(lane);
    nodes_.instance[lane] = met.instance;
    nodes_.primitive[lane] = met.primitive;
    nodes_.bary[0][lane] = met.u;
    nodes_.bary[1][lane] = met.v;
    nodes_.footprint[lane] = views[lane].footprint;
    if (material.program.asks_light_path || material.program.mipmapped)
      put(views[lane].path, nodes_, lane);
  }
  const bool looks = material.program.looks_around && looking_.rays;
  nodes_.looking = looks ? &looking_ : nullptr;
  if (!looks)
    return;
  looking_.used = nodes_.used;
  looking_.sharp = 0;
  for (uint32_t lane = 0; lane < count_; ++lane) {
    looking_.offset[lane] = at.offset[lane];
    looking_.pixel[lane] = views[lane].pixel;
    looking_.sample[lane] = views[lane].sample;
    looking_.dimension[lane] = views[lane].dimension;
    looking_.sharp |= uint32_t{views[lane].sharp} << lane;
  }
}

SurfaceStage::Holes SurfaceStage::cut_holdouts(uint32_t seen) {
  materials_.holes = 0;
  Holes holes;
  if (!(scene_.features & kFeatureHoldout))
    return holes;
  for (; seen != 0; seen &= seen - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(seen));
    if (instance(lane).holdout) {
      emission_[lane] = glm::vec3(0.0f);
      materials_.holes |= 1u << lane;
      holes.cut |= 1u << lane;
      holes.nothing |= uint32_t(transmittance_[lane] == glm::vec3(0.0f)) << lane;
    } else {
      const float share = holdout(lane);
      holes.cut |= uint32_t(share > 0.0f) << lane;
      holes.nothing |= uint32_t(share >= 1.0f) << lane;
    }
  }
  materials_.holes |= holes.nothing;
  return holes;
}

float SurfaceStage::cut_alpha(uint32_t lane, const glm::vec3 &beta) const {
  // The whole share of a holdout object becomes a hole.
  return instance(lane).holdout ? mean(beta * opacity(lane)) : holdout(lane) * mean(beta);
}

void SurfaceStage::make_opaque() { std::fill_n(transmittance_, count_, glm::vec3(0.0f)); }

void SurfaceStage::build_lobes() {
  lobes_.used = hits_.used;
  // Light from below meets no other part of the surface.
  for (uint32_t lane = 0; lane < count_ && materials_.leaving; ++lane) {
    emission_[lane] = transmittance_[lane] = glm::vec3(0.0f);
    materials_.through[lane] = 0.0f;
  }
  kernel_.build(surfaces_, materials_, lobes_);
  for (uint32_t sheets = lobes_.sheets; sheets != 0; sheets &= sheets - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(sheets));
    transmittance_[lane] += get(lobes_.straight, lane);
  }
}

void SurfaceStage::describe() {
  for (uint32_t lane = 0; lane < count_; ++lane)
    put(transmittance_[lane], materials_.transmittance, lane);
  if (wanted_.normal | wanted_.matt_normal | wanted_.shown | wanted_.mixture)
    kernel_.describe(materials_, lobes_, wanted_, means_);
}

void SurfaceStage::clear() {
  count_ = 0;
  hits_.used = hits_.on_mesh = hits_.smooth = hits_.exact = hits_.on_plane = hits_.on_cylinder = hits_.on_cone = 0;
  materials_.ends = materials_.seen_by_camera = materials_.after_diffuse = materials_.dimmed = 0;
  materials_.no_caustics = materials_.only_caustics = materials_.even_choices = 0;
  materials_.leaving = false;
}

Surface SurfaceStage::surface(uint32_t lane) const {
  const Hit &met = hit(lane);
  Surface surface;
  surface.p = get(surfaces_.p, lane);
  surface.offset = surfaces_.offset[lane];
  surface.ng = get(surfaces_.ng, lane);
  surface.ns = get(surfaces_.ns, lane);
  // Exact surfaces have no corner weights: their hits have 0.
  surface.bary = {met.u, met.v};
  surface.instance = met.instance;
  surface.primitive = met.primitive;
  surface.time = surfaces_.time[lane];
  surface.material = material_of(scene_.geometry, scene_.slots, met.instance, met.primitive);
  return surface;
}

glm::vec3 SurfaceStage::value(const Parameter &parameter, uint32_t lane) const {
  if (!parameter.varies())
    return parameter.value;
  const auto &node = values_[size_t(parameter.node)].of;
  return {node[0][lane], node[1][lane], node[2][lane]};
}

// Returns the share of a lane that becomes a hole in the picture.
float SurfaceStage::holdout(uint32_t lane) const {
  return std::clamp(value(materials_.material[lane]->holdout, lane).x, 0.0f, 1.0f);
}

Mixture<float> SurfaceStage::mixture(uint32_t lane) const {
  return {get(means_.mixed_normal, lane), get(means_.mixed_diffuse, lane), get(means_.mixed_specular, lane),
          means_.mixed_all[lane],         means_.mixed_matt[lane],         means_.mixed_roughness[lane]};
}

} // namespace lancer
