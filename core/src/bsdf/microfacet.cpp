#include "bsdf/microfacet.h"

#include "bsdf/albedo_tables.h"
#include "bsdf/microfacet_fresnel.h"
#include "bsdf/microfacet_terms.h"

namespace lancer {

namespace {

float roughness_of(const Lobe &lobe) { return std::sqrt(std::sqrt(lobe.alpha_x * lobe.alpha_y)); }

// Share of light from a white sky that a smooth dielectric reflects, outside and inside: the fit of Kulla and Conty 2017.
float dielectric_sky(float eta) {
  if (eta < 1.0f)
    return 0.997118f + eta * (0.1014f - eta * (0.965241f + eta * 0.130607f));
  return std::isinf(eta) ? 1.0f : (eta - 1.0f) / (4.08567f + 1.00071f * eta);
}

// The integral of fresnel_f82 over a white sky.
glm::vec3 f82_sky(const glm::vec3 &f0, const glm::vec3 &b) { return f0 + (1.0f - f0) * (1.0f / 21.0f) - b * (1.0f / 126.0f); }

// Schlick's curve at the angle of cosine 1/7, and what b has to be there per unit of difference.
constexpr float kSix7 = 6.0f / 7.0f, kFifth = kSix7 * kSix7 * kSix7 * kSix7 * kSix7, kEdgeScale = 7.0f / (kFifth * kSix7);
glm::vec3 schlick_at_edge(const glm::vec3 &f0) { return f0 + (1.0f - f0) * kFifth; }

// Colour that a bounce of light between the facets has on average.
glm::vec3 further_bounce(const Lobe &lobe) {
  switch (lobe.fresnel) {
  case FresnelKind::None:
    return lobe.f0;
  case FresnelKind::Dielectric:
    return glm::vec3(dielectric_sky(lobe.ior));
  case FresnelKind::Conductor: {
    // The curve of F82 through the values at the normal and at the edge.
    glm::vec3 f0, edge;
    for (int c = 0; c < 3; ++c) {
      f0[c] = fresnel_conductor(1.0f, lobe.f0[c], lobe.f90[c]);
      edge[c] = fresnel_conductor(1.0f / 7.0f, lobe.f0[c], lobe.f90[c]);
    }
    return glm::clamp(f82_sky(f0, kEdgeScale * (schlick_at_edge(f0) - edge)), 0.0f, 1.0f);
  }
  case FresnelKind::F82:
    return f82_sky(lobe.f0, lobe.b);
  case FresnelKind::Schlick:
  case FresnelKind::Principled3: {
    if (lobe.transmission != glm::vec3(0.0f))
      return lobe.transmission;
    return lobe.reflection * schlick(lobe, dielectric_sky(lobe.ior));
  }
  }
  return glm::vec3(1.0f);
}

// The dielectric whose curve Schlick's follows; one that reflects all is at its end everywhere.
void set_curve(Lobe &lobe, float ior) {
  lobe.ior = ior;
  lobe.lowest = f0_of_ior(ior);
  const float range = 1.0f - lobe.lowest;
  if (range > 0.0f)
    lobe.per_range = 1.0f / range;
  else
    lobe.lowest = -1.0f;
}

// Share of the light lost between facets that further bounces bring back (Turquin 2019, with Kulla and Conty's colour).
glm::vec3 further_light(const Lobe &lobe, float roughness) {
  // Beyond 1 the sum over all bounces would not end.
  const glm::vec3 bounce = glm::min(further_bounce(lobe), 1.0f);
  if (bounce == glm::vec3(1.0f))
    return bounce;
  const float mean = refracts(lobe) ? glass_mean_albedo(roughness, lobe.ior) : ggx_mean_albedo(roughness);
  return bounce * mean / (1.0f - bounce * (1.0f - mean));
}

float single_albedo(const Lobe &lobe, float roughness, float cos_o, const AlbedoRows *rows) {
  if (rows)
    return tables::read_row(rows->single, refracts(lobe) ? tables::kCoarse : tables::kFine, cos_o);
  return refracts(lobe) ? glass_albedo(roughness, cos_o, lobe.ior) : ggx_albedo(roughness, cos_o);
}

float mix_of(const Lobe &lobe, float roughness, float cos_o, const AlbedoRows *rows) {
  if (rows)
    return tables::read_row(rows->mix, tables::kCoarse, cos_o);
  return lobe.fresnel == FresnelKind::F82 ? fifth_power_mix(roughness, cos_o) : dielectric_mix(roughness, cos_o, lobe.ior);
}

void set_smoothness(Lobe &lobe) {
  const float alpha2 = lobe.alpha_x * lobe.alpha_y;
  lobe.delta = alpha2 <= (lobe.rules == Rules::Blender3 ? kMirrorAlpha2Blender3 : kMirrorAlpha2);
  if (refracts(lobe)) {
    // The refracted lobe is narrower than the reflected one by the share by which the index bends.
    const float bent = std::abs(1.0f - 1.0f / lobe.ior);
    lobe.delta_through = std::abs(lobe.ior - 1.0f) < kStraightIor || alpha2 * bent * bent < kMirrorAlpha2;
  }
}

// What Cycles takes for the reflected albedo, without the colour.
glm::vec3 reflected_albedo(const Lobe &lobe, float cos_o, float roughness, const FacetResponse &smooth,
                           const AlbedoRows *rows) {
  if (smooth.reflected == glm::vec3(0.0f))
    return glm::vec3(0.0f);
  // Fresnel curves are averaged over the facets.
  if (lobe.fresnel == FresnelKind::Schlick)
    return (lobe.f0 + (lobe.f90 - lobe.f0) * mix_of(lobe, roughness, cos_o, rows)) * lobe.reflection;
  if (lobe.fresnel == FresnelKind::F82)
    return lobe.f0 + (1.0f - lobe.f0) * mix_of(lobe, roughness, cos_o, rows);
  if (lobe.fresnel == FresnelKind::Dielectric && lobe.ior > 1.0f && lobe.rules == Rules::Blender45) {
    const float f0 = f0_of_ior(lobe.ior);
    return (f0 + (1.0f - f0) * mix_of(lobe, roughness, cos_o, rows)) * lobe.reflection;
  }
  return smooth.reflected;
}

// Where nothing but the mean over the facets is asked for, and a smooth surface would not be black either.
bool needs_no_smooth_response(const Lobe &lobe) {
  return lobe.fresnel == FresnelKind::Schlick && !refracts(lobe) && lobe.f0 != glm::vec3(0.0f);
}

// Gives a lobe that holds all but these its energy, its colour and its albedo from wo.
void finish(Lobe &lobe, float cos_o, bool preserving, float roughness, const glm::vec3 &further, const AlbedoRows *rows) {
  if (preserving) {
    const float single = single_albedo(lobe, roughness, cos_o, rows);
    lobe.energy = 1.0f / single;
    if (further != glm::vec3(1.0f))
      lobe.color *= single + further * (1.0f - single);
  }
  FacetResponse smooth;
  smooth.reflected = glm::vec3(1.0f);
  if (!needs_no_smooth_response(lobe))
    smooth = facet_response(lobe, cos_o);
  const glm::vec3 through = lobe.color * smooth.through;
  lobe.albedo = lobe.color * reflected_albedo(lobe, cos_o, roughness, smooth, rows) + through;
  lobe.through = reflects(lobe) ? through : glm::vec3(0.0f);
}

} // namespace

float ior_of_f0(float f0) {
  const float root = std::sqrt(std::clamp(f0, 0.0f, 0.99f));
  return (1.0f + root) / (1.0f - root);
}

Lobe make_microfacet(Scatter scatter, uint8_t frame, const glm::vec3 &color, float alpha_x, float alpha_y, Rules rules) {
  Lobe lobe;
  lobe.shape = LobeShape::Microfacet;
  lobe.variant = static_cast<uint8_t>(scatter);
  lobe.component = scatter == Scatter::Refract ? Component::Transmission : Component::Glossy;
  lobe.frame = frame;
  lobe.rules = rules;
  lobe.color = color;
  lobe.shown = rules == Rules::Blender3 && scatter != Scatter::Both ? 1.0f : 0.0f;
  lobe.alpha_x = std::clamp(alpha_x, 0.0f, 1.0f);
  lobe.alpha_y = std::clamp(alpha_y, 0.0f, 1.0f);
  lobe.ior = 1.0f;
  lobe.f0 = glm::vec3(1.0f);
  return lobe;
}

void set_constant(Lobe &lobe, const glm::vec3 &further) {
  lobe.fresnel = FresnelKind::None;
  lobe.f0 = further;
}

void set_dielectric(Lobe &lobe, float ior) {
  lobe.fresnel = FresnelKind::Dielectric;
  lobe.ior = ior;
}

void set_conductor(Lobe &lobe, const glm::vec3 &n, const glm::vec3 &k) {
  lobe.fresnel = FresnelKind::Conductor;
  lobe.f0 = n;
  lobe.f90 = k;
}

void set_f82(Lobe &lobe, const glm::vec3 &f0, const glm::vec3 &tint) {
  lobe.fresnel = FresnelKind::F82;
  lobe.f0 = f0;
  lobe.b = schlick_at_edge(f0) * kEdgeScale * (1.0f - tint);
}

void set_schlick(Lobe &lobe, const glm::vec3 &f0, const glm::vec3 &f90, float ior, const glm::vec3 &reflection,
                 const glm::vec3 &transmission) {
  lobe.fresnel = FresnelKind::Schlick;
  lobe.f0 = glm::clamp(f0, 0.0f, 1.0f);
  lobe.f90 = f90;
  set_curve(lobe, ior);
  lobe.reflection = reflection;
  lobe.transmission = transmission;
}

void set_principled3(Lobe &lobe, const glm::vec3 &f0, float ior) {
  lobe.fresnel = FresnelKind::Principled3;
  lobe.f0 = glm::clamp(f0, 0.0f, 1.0f);
  set_curve(lobe, ior);
  lobe.transmission = glm::vec3(0.0f);
}

void complete_microfacet(Lobe &lobe, float cos_o, bool preserving) {
  const float roughness = roughness_of(lobe);
  const bool several = preserving && !lobe.beckmann;
  set_smoothness(lobe);
  finish(lobe, cos_o, several, roughness, several ? further_light(lobe, roughness) : glm::vec3(1.0f), nullptr);
}

MicrofacetPlan plan_microfacet(const Lobe &lobe, bool preserving) {
  MicrofacetPlan plan;
  plan.lobe = lobe;
  plan.preserving = preserving && !lobe.beckmann;
  plan.roughness = roughness_of(lobe);
  if (plan.preserving)
    plan.further = further_light(lobe, plan.roughness);
  set_smoothness(plan.lobe);
  return plan;
}

void keep_rows(MicrofacetPlan &plan) {
  const auto rows = std::make_shared<AlbedoRows>();
  const int singles = refracts(plan.lobe) ? tables::kCoarse : tables::kFine;
  for (int i = 0; i < singles; ++i)
    rows->single[i] = single_albedo(plan.lobe, plan.roughness, float(i) / float(singles - 1), nullptr);
  for (int i = 0; i < tables::kCoarse; ++i)
    rows->mix[i] = mix_of(plan.lobe, plan.roughness, float(i) / float(tables::kCoarse - 1), nullptr);
  plan.rows = rows;
}

Lobe seen_from(const MicrofacetPlan &plan, float cos_o, const glm::vec3 &color) {
  Lobe lobe = plan.lobe;
  lobe.color = color;
  finish(lobe, cos_o, plan.preserving, plan.roughness, plan.further, plan.rows.get());
  return lobe;
}

void add(Bsdf &bsdf, const Lobe &lobe) {
  if (bsdf.count >= kMaxLobes || lobe.color == glm::vec3(0.0f))
    return;
  bsdf.lobes[bsdf.count++] = lobe;
  bsdf.shapes |= shape_bit(lobe.shape);
}

} // namespace lancer
