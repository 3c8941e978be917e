#include "bsdf/build.h"

#include <algorithm>
#include <cmath>

#include "bsdf/ashikhmin.h"
#include "bsdf/coating.h"
#include "bsdf/facet_plans.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet.h"
#include "bsdf/microfacet_fresnel.h"
#include "bsdf/sheen.h"

namespace lancer {

namespace {

// The normal of lobes that need not reflect: as it is given; Blender 3.x bent it, too.
glm::vec3 wide_normal(const Bsdf &bsdf, const LobeInputs &inputs) {
  return inputs.rules == Rules::Blender3 ? reflecting_normal(bsdf, inputs.normal) : inputs.normal;
}

Lobe course_lobe(LobeShape shape, Component component, uint8_t frame, const LobeInputs &inputs) {
  Lobe lobe;
  lobe.shape = shape;
  lobe.component = component;
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  lobe.color = lobe.albedo = colored_weight(inputs);
  lobe.ior = inputs.ior;
  lobe.shininess = inputs.shininess;
  return lobe;
}

void add_lambert(Bsdf &bsdf, const LobeInputs &inputs) {
  const uint8_t frame = add_frame(bsdf, wide_normal(bsdf, inputs), glm::vec3(0.0f));
  add(bsdf, course_lobe(LobeShape::Lambert, Component::Diffuse, frame, inputs));
}

void add_diffuse(Bsdf &bsdf, const LobeInputs &inputs) {
  const uint8_t frame = add_frame(bsdf, wide_normal(bsdf, inputs), glm::vec3(0.0f));
  Lobe lobe = make_diffuse(colored_weight(inputs), inputs.color, inputs.roughness, inputs.option != 0, bsdf.wo_local[frame].z);
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  add(bsdf, lobe);
}

void add_minnaert(Bsdf &bsdf, const LobeInputs &inputs) {
  const uint8_t frame = add_frame(bsdf, wide_normal(bsdf, inputs), glm::vec3(0.0f));
  const float rho = std::max({inputs.color.x, inputs.color.y, inputs.color.z, 0.0f});
  Lobe lobe = make_minnaert(colored_weight(inputs), inputs.shininess, rho, bsdf.wo_local[frame]);
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  add(bsdf, lobe);
}

void add_coating(Bsdf &bsdf, const LobeInputs &inputs, uint8_t frame) {
  Lobe lobe = course_lobe(LobeShape::Beckmann, Component::Glossy, frame, inputs);
  lobe.alpha_x = lobe.alpha_y = inputs.roughness;
  lobe.delta = lobe.alpha_x < kMirrorAlpha;
  lobe.albedo *= coating_albedo_estimate(lobe, bsdf.wo_local[frame]);
  add(bsdf, lobe);
}

void add_smooth_glass(Bsdf &bsdf, const LobeInputs &inputs, uint8_t frame) {
  Lobe lobe = course_lobe(LobeShape::Dielectric, Component::Glossy, frame, inputs);
  lobe.delta = true;
  lobe.ior = bsdf.inside ? 1.0f / inputs.ior : inputs.ior;
  lobe.through = lobe.color * (1.0f - fresnel_dielectric(bsdf.wo_local[frame].z, lobe.ior));
  add(bsdf, lobe);
}

// Roughness along the tangent and across it, and the frame that they lie in.
struct Stretched {
  float alpha_x, alpha_y;
  uint8_t frame;
};

// axis: what the tangent is turned about.
Stretched stretched(Bsdf &bsdf, const LobeInputs &inputs, const glm::vec3 &n, const glm::vec3 &axis, float alpha, float along,
                    float across) {
  const glm::vec3 t = inputs.rotation != 0.0f ? turn_about(inputs.tangent, axis, inputs.rotation) : inputs.tangent;
  return {alpha * along, alpha * across, add_frame(bsdf, n, t)};
}

// The Glossy node's: squeezed one way as it is drawn out the other.
Stretched glossy_roughness(Bsdf &bsdf, const LobeInputs &inputs, const glm::vec3 &n) {
  const float alpha = alpha_of(inputs.roughness);
  const float anisotropy = std::clamp(inputs.anisotropy, -0.99f, 0.99f);
  if (std::abs(anisotropy) <= 1e-4f)
    return {alpha, alpha, add_frame(bsdf, n, glm::vec3(0.0f))};
  if (anisotropy < 0.0f)
    return stretched(bsdf, inputs, n, n, alpha, 1.0f / (1.0f + anisotropy), 1.0f + anisotropy);
  return stretched(bsdf, inputs, n, n, alpha, 1.0f - anisotropy, 1.0f / (1.0f - anisotropy));
}

// The Metallic node's, as Principled has it.
Stretched conductor_roughness(Bsdf &bsdf, const LobeInputs &inputs, const glm::vec3 &n) {
  const float alpha = alpha_of(inputs.roughness);
  const float anisotropy = std::clamp(inputs.anisotropy, 0.0f, 1.0f);
  if (anisotropy == 0.0f)
    return {alpha, alpha, add_frame(bsdf, n, glm::vec3(0.0f))};
  const float aspect = std::sqrt(1.0f - 0.9f * anisotropy);
  return stretched(bsdf, inputs, n, normal_or_shading(bsdf, inputs.normal), alpha, 1.0f / aspect, aspect);
}

void add_glossy(Bsdf &bsdf, const LobeInputs &inputs) {
  const Stretched s = glossy_roughness(bsdf, inputs, reflecting_normal(bsdf, inputs.normal));
  if (inputs.distribution == Facets::AshikhminShirley) {
    Lobe lobe = make_ashikhmin(colored_weight(inputs), s.alpha_x, s.alpha_y);
    lobe.frame = s.frame;
    lobe.rules = inputs.rules;
    add(bsdf, lobe);
    return;
  }
  Lobe lobe = glossy_facets(inputs, s.frame, s.alpha_x, s.alpha_y);
  complete_microfacet(lobe, bsdf.wo_local[s.frame].z, inputs.distribution == Facets::MultiGgx);
  add(bsdf, lobe);
}

void add_conductor(Bsdf &bsdf, const LobeInputs &inputs) {
  const Stretched s = conductor_roughness(bsdf, inputs, reflecting_normal(bsdf, inputs.normal));
  Lobe lobe = conductor_facets(inputs, s.frame, s.alpha_x, s.alpha_y);
  complete_microfacet(lobe, bsdf.wo_local[s.frame].z, inputs.distribution == Facets::MultiGgx);
  add(bsdf, lobe);
}

void add_refraction(Bsdf &bsdf, const LobeInputs &inputs) {
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal), glm::vec3(0.0f));
  const float alpha = inputs.roughness * inputs.roughness; // below 0, too
  Lobe lobe = make_microfacet(Scatter::Refract, frame, colored_weight(inputs), alpha, alpha, inputs.rules);
  lobe.beckmann = inputs.distribution == Facets::Beckmann;
  lobe.ior = index_from(bsdf.inside, inputs.ior);
  complete_microfacet(lobe, bsdf.wo_local[frame].z, false);
  add(bsdf, lobe);
}

void add_glass(Bsdf &bsdf, const LobeInputs &inputs) {
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal), glm::vec3(0.0f));
  const float cos_o = bsdf.wo_local[frame].z;
  const bool preserving = inputs.distribution == Facets::MultiGgx;
  if (inputs.rules == Rules::Blender3 && !preserving) {
    // Blender 3.x: Fresnel of the smooth surface shares the light between two lobes of facets without Fresnel.
    const float alpha = alpha_of(inputs.roughness), eta = index_from(bsdf.inside, inputs.ior);
    const float f = fresnel_dielectric(cos_o, eta);
    for (Scatter scatter : {Scatter::Reflect, Scatter::Refract}) {
      const float share = scatter == Scatter::Reflect ? f : 1.0f - f;
      Lobe lobe = make_microfacet(scatter, frame, colored_weight(inputs) * share, alpha, alpha, inputs.rules);
      lobe.beckmann = inputs.distribution == Facets::Beckmann;
      lobe.ior = eta;
      complete_microfacet(lobe, cos_o, false);
      add(bsdf, lobe);
    }
    return;
  }
  Lobe lobe = glass_facets(inputs, frame, bsdf.inside);
  complete_microfacet(lobe, cos_o, preserving);
  add(bsdf, lobe);
}

void add_sheen(Bsdf &bsdf, const LobeInputs &inputs) {
  const uint8_t frame = add_frame(bsdf, wide_normal(bsdf, inputs), glm::vec3(0.0f));
  const glm::vec3 weight = colored_weight(inputs);
  const float roughness = std::clamp(inputs.roughness, 0.0f, 1.0f);
  Lobe lobe = inputs.distribution == Facets::Beckmann ? make_velvet(weight, roughness)
                                                      : make_sheen(weight, roughness, bsdf.wo_local[frame].z);
  lobe.frame = frame;
  lobe.rules = inputs.rules;
  add(bsdf, lobe);
}

void add_translucent(Bsdf &bsdf, const LobeInputs &inputs) {
  Lobe lobe = make_translucent(colored_weight(inputs));
  lobe.frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal), glm::vec3(0.0f));
  lobe.rules = inputs.rules;
  add(bsdf, lobe);
}

} // namespace

uint32_t shapes_of(LobeKind kind) {
  switch (kind) {
  case LobeKind::Lambert:
    return shape_bit(LobeShape::Lambert);
  case LobeKind::Beckmann:
    return shape_bit(LobeShape::Beckmann);
  case LobeKind::Mirror:
    return shape_bit(LobeShape::Mirror);
  case LobeKind::Dielectric:
    return shape_bit(LobeShape::Dielectric);
  case LobeKind::Phong:
    return shape_bit(LobeShape::Phong);
  case LobeKind::BlinnPhong:
    return shape_bit(LobeShape::BlinnPhong);
  case LobeKind::Diffuse:
    return shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Matte);
  case LobeKind::Glossy:
    return shape_bit(LobeShape::Microfacet) | shape_bit(LobeShape::Ashikhmin);
  case LobeKind::Glass:
  case LobeKind::Refraction:
  case LobeKind::Conductor:
    return shape_bit(LobeShape::Microfacet);
  case LobeKind::Sheen:
    return shape_bit(LobeShape::Sheen) | shape_bit(LobeShape::Matte);
  case LobeKind::Translucent:
  case LobeKind::Minnaert:
    return shape_bit(LobeShape::Matte);
  case LobeKind::Principled:
    return shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Matte) | shape_bit(LobeShape::Microfacet) |
           shape_bit(LobeShape::Ashikhmin) | shape_bit(LobeShape::Sheen);
  }
  return kAllShapes;
}

void add_lobe(Bsdf &bsdf, const LobeInputs &inputs) {
  switch (inputs.kind) {
  case LobeKind::Lambert:
    return add_lambert(bsdf, inputs);
  case LobeKind::Diffuse:
    return add_diffuse(bsdf, inputs);
  case LobeKind::Glossy:
    return add_glossy(bsdf, inputs);
  case LobeKind::Glass:
    return add_glass(bsdf, inputs);
  case LobeKind::Refraction:
    return add_refraction(bsdf, inputs);
  case LobeKind::Conductor:
    return add_conductor(bsdf, inputs);
  case LobeKind::Sheen:
    return add_sheen(bsdf, inputs);
  case LobeKind::Translucent:
    return add_translucent(bsdf, inputs);
  case LobeKind::Minnaert:
    return add_minnaert(bsdf, inputs);
  case LobeKind::Principled:
    return;
  default:
    break;
  }
  const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, inputs.normal), glm::vec3(0.0f));
  if (inputs.kind == LobeKind::Beckmann)
    return add_coating(bsdf, inputs, frame);
  if (inputs.kind == LobeKind::Dielectric)
    return add_smooth_glass(bsdf, inputs, frame);
  const LobeShape shape = inputs.kind == LobeKind::Mirror  ? LobeShape::Mirror
                          : inputs.kind == LobeKind::Phong ? LobeShape::Phong
                                                           : LobeShape::BlinnPhong;
  Lobe lobe = course_lobe(shape, Component::Glossy, frame, inputs);
  lobe.delta = shape == LobeShape::Mirror;
  add(bsdf, lobe);
}

} // namespace lancer
