// The Principled BSDF: from the artist's sliders to lobes, in the layers of Blender 4 and in the sum of Blender 3.
#include <algorithm>
#include <cmath>

#include "bsdf/ashikhmin.h"
#include "bsdf/build.h"
#include "bsdf/fresnel.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet.h"
#include "bsdf/sheen.h"

namespace lancer {

namespace {

// Layers and shares smaller than this are not there, as in Cycles.
constexpr float kNothing = 1e-5f;

float unit(float x) { return std::clamp(x, 0.0f, 1.0f); }
glm::vec3 unit(const glm::vec3 &x) { return glm::clamp(x, 0.0f, 1.0f); }
glm::vec3 positive(const glm::vec3 &x) { return glm::max(x, 0.0f); }

// What a layer leaves for those below it: one factor for all colours, by the channel that it takes most of.
glm::vec3 below(const glm::vec3 &weight, const glm::vec3 &albedo) {
  float taken = 0.0f;
  for (int i = 0; i < 3; ++i)
    if (weight[i] != 0.0f)
      taken = std::max(taken, albedo[i] / weight[i]);
  return weight * unit(1.0f - taken);
}

// Both roughnesses and the tangent that all lobes of the base share.
struct Grain {
  float alpha_x, alpha_y;
  glm::vec3 tangent{0.0f};
};

Grain grain_of(const glm::vec3 &n, const LobeInputs &lobe, float roughness, float anisotropic, float rotation) {
  const float alpha = roughness * roughness;
  if (!(anisotropic > 0.0f) || lobe.tangent == glm::vec3(0.0f))
    return {alpha, alpha};
  const float aspect = std::sqrt(std::max(0.0f, 1.0f - 0.9f * anisotropic));
  return {unit(alpha / aspect), alpha * aspect, turn_about(lobe.tangent, n, rotation)};
}

float cos_in(const Bsdf &bsdf, uint8_t frame) { return std::max(0.0f, bsdf.wo_local[frame].z); }

// The light that a coat's colour lets pass on a slanted way down: Beer's law over 1/cos of the refracted direction.
glm::vec3 through_coat(const glm::vec3 &tint, float cos_o, float ior, float coat) {
  const float sin = std::sqrt(std::max(0.0f, (1.0f - cos_o) * (1.0f + cos_o))) / ior;
  const float depth = 1.0f / std::sqrt((1.0f - sin) * (1.0f + sin));
  return glm::mix(glm::vec3(1.0f), glm::pow(tint, glm::vec3(depth)), coat);
}

void add_layers(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &in) {
  const glm::vec3 n = normal_or_shading(bsdf, lobe.normal), n_reflect = reflecting_normal(bsdf, lobe.normal);
  const glm::vec3 n_coat = normal_or_shading(bsdf, in.coat_normal);
  const glm::vec3 color = positive(in.base_color), albedo = unit(color), tint = positive(in.specular_tint);
  const float roughness = unit(in.roughness), ior = std::max(in.ior, 1e-5f), coat = std::max(in.coat, 0.0f);
  const float metallic = unit(in.metallic), transmission = unit(in.transmission);
  const bool preserving = in.distribution == Facets::MultiGgx;
  glm::vec3 weight = lobe.weight;

  // Cloth on top of all, its normal between the base's and the coat's.
  if (in.sheen > kNothing) {
    const glm::vec3 n_cloth = n_coat == n ? n : glm::mix(n, n_coat, unit(coat));
    const uint8_t frame = add_frame(bsdf, n_cloth, glm::vec3(0.0f));
    Lobe sheen = make_sheen(in.sheen * positive(in.sheen_tint) * weight, unit(in.sheen_roughness), cos_in(bsdf, frame));
    sheen.frame = frame;
    add(bsdf, sheen);
    weight = below(weight, sheen.albedo);
  }

  // The coat reflects, with all its light from Blender 4.5 on, and colours what passes it twice.
  if (coat > kNothing) {
    const uint8_t frame = add_frame(bsdf, reflecting_normal(bsdf, n_coat), glm::vec3(0.0f));
    const float alpha = unit(in.coat_roughness) * unit(in.coat_roughness), coat_ior = std::max(in.coat_ior, 1.0f);
    const float cos_o = cos_in(bsdf, frame);
    Lobe reflection = make_microfacet(Scatter::Reflect, frame, coat * weight, alpha, alpha, in.rules);
    set_dielectric(reflection, coat_ior);
    complete_microfacet(reflection, cos_o, in.rules == Rules::Blender45);
    add(bsdf, reflection);
    weight = below(weight, reflection.albedo);
    if (in.coat_tint != glm::vec3(1.0f))
      weight *= through_coat(positive(in.coat_tint), cos_o, coat_ior, coat);
  }

  bsdf.emission += in.emission * weight;

  const Grain grain = grain_of(n, lobe, roughness, unit(in.anisotropic), in.anisotropic_rotation);
  const uint8_t frame = add_frame(bsdf, n_reflect, grain.tangent);
  const float cos_o = cos_in(bsdf, frame);

  // Metal, glass and plastic share what is left.
  if (metallic > kNothing) {
    Lobe metal = make_microfacet(Scatter::Reflect, frame, metallic * weight, grain.alpha_x, grain.alpha_y, in.rules);
    set_f82(metal, albedo, unit(tint));
    complete_microfacet(metal, cos_o, preserving);
    add(bsdf, metal);
    weight *= 1.0f - metallic;
  }
  if (transmission > kNothing) {
    const float alpha = roughness * roughness;
    Lobe glass = make_microfacet(Scatter::Both, frame, transmission * weight, alpha, alpha, in.rules);
    set_schlick(glass, unit(f0_of_ior(ior) * tint), glm::vec3(1.0f), bsdf.inside ? 1.0f / ior : ior, glm::vec3(1.0f),
                glm::sqrt(albedo));
    complete_microfacet(glass, cos_o, preserving);
    add(bsdf, glass);
    weight *= 1.0f - transmission;
  }
  if (weight == glm::vec3(0.0f))
    return;

  // The plastic's index bends with the artist's level, on its own side of 1.
  float eta = ior, f0 = f0_of_ior(ior);
  if (in.specular != 0.5f) {
    f0 *= 2.0f * std::max(in.specular, 0.0f);
    eta = ior_of_f0(f0);
    if (ior < 1.0f)
      eta = 1.0f / eta;
  }
  if (eta != 1.0f) {
    Lobe gloss = make_microfacet(Scatter::Reflect, frame, weight, grain.alpha_x, grain.alpha_y, in.rules);
    set_schlick(gloss, unit(f0 * tint), glm::vec3(1.0f), eta, glm::vec3(1.0f), glm::vec3(0.0f));
    complete_microfacet(gloss, cos_o, preserving);
    add(bsdf, gloss);
    weight = below(weight, gloss.albedo);
  }

  const uint8_t matte_frame = n == n_reflect ? frame : add_frame(bsdf, n, glm::vec3(0.0f));
  Lobe diffuse = make_diffuse(color * weight, color, unit(in.diffuse_roughness), in.option == 1, cos_in(bsdf, matte_frame));
  diffuse.frame = matte_frame;
  add(bsdf, diffuse);
}

// Hue and saturation of a colour, its luminance brought to 1.
glm::vec3 hue_of(const glm::vec3 &color, const glm::vec3 &luminance_weights) {
  const float luminance = glm::dot(color, luminance_weights);
  return luminance > 0.0f ? color / luminance : glm::vec3(1.0f);
}

// Cycles 3 walks from facet to facet at random, with height-correlated masking; the compensated lobe of Blender 4 stands in.
constexpr Rules kSeveralBounces = Rules::Blender45;

// Blender 3 glass of one bounce: reflection and refraction each weighted by Fresnel at the normal, with roughnesses of their
// own; of several bounces: one lobe.
void add_glass3(Bsdf &bsdf, uint8_t frame, const glm::vec3 &weight, const PrincipledInputs &in, float ior) {
  const glm::vec3 tint = glm::mix(glm::vec3(1.0f), in.base_color, in.specular_tint.x);
  const float cos_o = cos_in(bsdf, frame), alpha = in.roughness * in.roughness;
  const bool single = in.distribution != Facets::MultiGgx;
  if (!single && in.roughness > 0.05f) {
    Lobe glass = make_microfacet(Scatter::Both, frame, weight, alpha, alpha, kSeveralBounces);
    set_schlick(glass, glm::vec3(f0_of_ior(ior)), glm::vec3(1.0f), ior, unit(tint), unit(in.base_color));
    complete_microfacet(glass, cos_o, true);
    add(bsdf, glass);
    return;
  }
  const float reflectance = fresnel_dielectric(cos_o, ior);
  Lobe reflection = make_microfacet(Scatter::Reflect, frame, reflectance * weight, alpha, alpha, in.rules);
  set_principled3(reflection, unit(tint), ior);
  complete_microfacet(reflection, cos_o, false);
  add(bsdf, reflection);

  const float through = single ? 1.0f - (1.0f - in.roughness) * (1.0f - in.transmission_roughness) : in.roughness;
  const glm::vec3 passing = in.base_color * weight * std::max(1e-4f, 1.0f - reflectance);
  Lobe refraction = make_microfacet(Scatter::Refract, frame, passing, through * through, through * through, in.rules);
  refraction.ior = ior;
  complete_microfacet(refraction, cos_o, false);
  add(bsdf, refraction);
}

void add_sum3(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &in) {
  // Every normal is bent so that what it mirrors stays above the surface, the diffuse one too.
  const glm::vec3 n = reflecting_normal(bsdf, lobe.normal);
  const Grain grain = grain_of(n, lobe, in.roughness, in.anisotropic, in.anisotropic_rotation);
  const uint8_t frame = add_frame(bsdf, n, grain.tangent);
  const float cos_o = cos_in(bsdf, frame);
  const float metallic = unit(in.metallic), glass = unit(in.transmission) * (1.0f - metallic);
  const float diffuse = (1.0f - metallic) * (1.0f - unit(in.transmission));
  const bool preserving = in.distribution == Facets::MultiGgx;

  bsdf.emission += in.emission * lobe.weight;

  if (diffuse > kNothing) {
    Lobe burley = make_burley(diffuse * in.base_color * lobe.weight, in.roughness);
    burley.frame = frame;
    add(bsdf, burley);
  }
  if (diffuse > kNothing && in.sheen > kNothing) {
    const glm::vec3 hue = hue_of(in.base_color, {0.2126729f, 0.7151522f, 0.0721750f});
    Lobe dust =
        make_matte(Matte::DustSheen, diffuse * in.sheen * glm::mix(glm::vec3(1.0f), hue, in.sheen_tint.x) * lobe.weight);
    dust.frame = frame;
    add(bsdf, dust);
  }

  // One reflection for plastic and metal: what it does at the normal goes from a level to the base colour.
  if (1.0f - glass > kNothing && (in.specular > kNothing || in.metallic > kNothing)) {
    const glm::vec3 hue = hue_of(in.base_color, {0.3f, 0.6f, 0.1f});
    const glm::vec3 plastic = 0.08f * in.specular * glm::mix(glm::vec3(1.0f), hue, in.specular_tint.x);
    const float ior = 2.0f / (1.0f - std::sqrt(std::max(0.0f, 0.08f * in.specular))) - 1.0f;
    const bool several = preserving && in.roughness > 0.075f;
    Lobe gloss = make_microfacet(Scatter::Reflect, frame, (1.0f - glass) * lobe.weight, grain.alpha_x, grain.alpha_y,
                                 several ? kSeveralBounces : in.rules);
    set_principled3(gloss, unit(glm::mix(plastic, in.base_color, in.metallic)), ior);
    complete_microfacet(gloss, cos_o, several);
    add(bsdf, gloss);
  }
  if (glass > kNothing) {
    const float ior = std::max(in.ior, 1e-5f);
    const uint8_t plain = grain.tangent == glm::vec3(0.0f) ? frame : add_frame(bsdf, n, glm::vec3(0.0f));
    add_glass3(bsdf, plain, glass * lobe.weight, in, bsdf.inside ? 1.0f / ior : ior);
  }

  if (in.coat > kNothing) {
    const uint8_t coat_frame = add_frame(bsdf, reflecting_normal(bsdf, in.coat_normal), glm::vec3(0.0f));
    Lobe coat = make_clear_coat(in.coat * lobe.weight, in.coat_roughness * in.coat_roughness, cos_in(bsdf, coat_frame));
    coat.frame = coat_frame;
    add(bsdf, coat);
  }
}

} // namespace

void add_principled(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &principled) {
  if (principled.rules == Rules::Blender3)
    add_sum3(bsdf, lobe, principled);
  else
    add_layers(bsdf, lobe, principled);
}

} // namespace lancer
