#include "render/probe.h"

#include "integrator/stages/shader.h"
#include "scene/fill.h"
#include "scene/messages.h"

#include <cmath>

namespace lancer {

namespace {

glm::vec3 vec3_at(const float *array, size_t i) { return {array[3 * i], array[3 * i + 1], array[3 * i + 2]}; }

void store(float *target, const glm::vec3 &v) {
  for (int i = 0; i < 3; ++i)
    target[i] = v[i];
}

// A unit square in the plane z = 0 with a UV map, on which a material is evaluated.
class Stage {
public:
  Stage(const Scene &scene, uint32_t material) : shader_(scene, nullptr), material_(material) {
    if (material >= scene.materials.size())
      bad_argument("probe: material " + std::to_string(material) + " >= " + std::to_string(scene.materials.size()) +
                   " materials");
    Mesh &square = mesh_;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const glm::uvec3 &triangle : square.triangles)
      for (int corner = 0; corner < 3; ++corner)
        square.uvs.push_back(glm::vec2(square.positions[triangle[corner]]));
    square.low = {0, 0, 0};
    square.high = {1, 1, 0};
    view_ = square;
    instance_.place(scene.normalisation.to_normalised(Affine{}));
    geometry_.meshes = std::span(&view_, 1);
    geometry_.instances = std::span(&instance_, 1);
    shader_.set_geometry(geometry_);
  }

  Surface at(glm::vec2 uv) const {
    Surface surface;
    surface.p = instance_.to_world.point({double(uv.x), double(uv.y), 0.0});
    surface.instance = 0;
    surface.material = material_;
    // Below the diagonal, the weights of vertices 1 and 2 are (u - v, v); above it, (u, v - u).
    surface.primitive = uv.y <= uv.x ? 0 : 1;
    surface.bary = surface.primitive == 0 ? glm::dvec2(uv.x - uv.y, uv.y) : glm::dvec2(uv.x, uv.y - uv.x);
    return surface;
  }

  // Returns the material in the middle of the square, seen from wo (local: tangent x, normal z).
  const Shaded &seen_from(const glm::vec3 &wo) {
    shader_.shade(at(glm::vec2(0.5f)), {.wo = wo}, shaded_);
    return shaded_;
  }

  glm::vec4 node(uint32_t number, glm::vec2 uv) { return shader_.node_value(at(uv), number, glm::vec3(0.0f, 0.0f, 1.0f)); }

private:
  Mesh mesh_;
  MeshView view_;
  Instance instance_;
  GeometryView geometry_;
  Shader shader_;
  uint32_t material_;
  Shaded shaded_;
};

// Returns the kind in lancer.h of a built lobe.
uint32_t kind_of(const Lobe<float> &lobe) {
  switch (lobe.shape) {
  case LobeShape::Lambert:
    return LANCER_LAMBERT;
  case LobeShape::Beckmann:
    return LANCER_BECKMANN;
  case LobeShape::Mirror:
    return LANCER_MIRROR;
  case LobeShape::Dielectric:
    return LANCER_DIELECTRIC;
  case LobeShape::Phong:
    return LANCER_PHONG;
  case LobeShape::BlinnPhong:
    return LANCER_BLINN_PHONG;
  case LobeShape::Matte:
    return matte_transmits(lobe)                      ? LANCER_TRANSLUCENT
           : lobe.variant == uint8_t(Matte::Minnaert) ? LANCER_MINNAERT
                                                      : LANCER_DIFFUSE;
  case LobeShape::Microfacet:
    return lobe.variant == uint8_t(Scatter::Both)   ? LANCER_GLASS
           : refracts(lobe) || passes_through(lobe) ? LANCER_REFRACTION
                                                    : LANCER_GLOSSY;
  case LobeShape::Ashikhmin:
    return LANCER_GLOSSY;
  case LobeShape::Sheen:
    return LANCER_SHEEN;
  case LobeShape::Toon:
    return LANCER_TOON;
  case LobeShape::Hair:
    return is_hair(lobe, Hair::Chiang) ? LANCER_HAIR_FIBRE : LANCER_HAIR;
  case LobeShape::Subsurface:
    return LANCER_SUBSURFACE;
  }
  return LANCER_LAMBERT;
}

} // namespace

void probe_bsdf(const Scene &scene, uint32_t material, uint32_t count, const float *wo, const float *wi, float *f, float *pdf) {
  Stage stage(scene, material);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 w = vec3_at(wi, i);
    const BsdfValue<float> value = stage.seen_from(vec3_at(wo, i)).bsdf.eval(w);
    const float cosine = std::abs(w.z);
    store(f + size_t(3) * i, cosine > 0.0f ? value.f() / cosine : glm::vec3(0.0f));
    pdf[i] = value.pdf;
  }
}

void probe_bsdf_sample(const Scene &scene, uint32_t material, uint32_t count, const float *wo, const float *u,
                       lancer_bsdf_sample *samples) {
  check_unit(u, size_t(3) * count);
  Stage stage(scene, material);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 numbers = vec3_at(u, i);
    const BsdfSample<float> sample = stage.seen_from(vec3_at(wo, i)).bsdf.sample(numbers.x, numbers.y, numbers.z);
    store(samples[i].wi, sample.wi);
    store(samples[i].weight, sample.weight);
    samples[i].pdf = sample.pdf;
    samples[i].delta = sample.delta;
  }
}

void probe_lobes(const Scene &scene, uint32_t material, const float *wo, lancer_lobe_info *lobes, uint32_t capacity,
                 uint32_t *count, float *emission, float *transmittance) {
  Stage stage(scene, material);
  const Shaded &seen = stage.seen_from(vec3_at(wo, 0));
  *count = uint32_t(seen.bsdf.count);
  for (uint32_t i = 0; i < std::min(capacity, *count); ++i) {
    const Lobe<float> &lobe = seen.bsdf.lobes[i];
    lancer_lobe_info &info = lobes[i];
    info = {};
    info.kind = kind_of(lobe);
    info.component = uint32_t(lobe.component);
    store(info.weight, lobe.color);
    store(info.albedo, lobe.albedo);
    info.roughness[0] = lobe.alpha_x;
    info.roughness[1] = lobe.alpha_y;
    info.ior = lobe.ior;
    info.probability = lobe.probability;
  }
  if (emission)
    store(emission, seen.emission);
  if (transmittance)
    store(transmittance, seen.transmittance);
}

void evaluate_node(const lancer_node &node, float *value) {
  if (!asks_no_place(node.kind))
    bad_argument("node: kind " + std::to_string(node.kind) + " depends on the shading point");
  const Program program = read_program({}, "node", &node, 1);
  glm::vec4 result(0.0f);
  run(program, Schedule{0}, NodeContext(), std::span(&result, 1));
  std::copy_n(&result.x, 4, value);
}

void probe_node(const Scene &scene, uint32_t material, uint32_t node, uint32_t count, const float *uv, float *values) {
  Stage stage(scene, material);
  const size_t nodes = scene.materials[material].program.nodes.size();
  if (node >= nodes)
    bad_argument("probe: node " + std::to_string(node) + " >= " + std::to_string(nodes) + " nodes");
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec4 value = stage.node(node, {uv[2 * i], uv[2 * i + 1]});
    for (int k = 0; k < 4; ++k)
      values[4 * i + uint32_t(k)] = value[k];
  }
}

void probe_world(const Scene &scene, uint32_t count, const double *directions, float *radiance, float *pdf) {
  check_directions(directions, count);
  const Environment &environment = scene.lights.environment();
  std::vector<glm::vec4> values(scene.world.program.value_count());
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 wi(directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]);
    store(radiance + size_t(3) * i, environment.radiance(wi, values, nullptr));
    pdf[i] = environment.is_light() ? float(environment.pdf(wi, false)) : 0.0f;
  }
}

} // namespace lancer
