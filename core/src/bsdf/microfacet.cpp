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
    const float lowest = f0_of_ior(lobe.ior);
    const float s = std::clamp((dielectric_sky(lobe.ior) - lowest) / (1.0f - lowest), 0.0f, 1.0f);
    return lobe.reflection * (lobe.f0 + (lobe.f90 - lobe.f0) * s);
  }
  }
  return glm::vec3(1.0f);
}

// Gives the lobe the light that is lost between facets (Turquin 2019, with Kulla and Conty's colour).
void preserve_energy(Lobe &lobe, float cos_o) {
  const float roughness = roughness_of(lobe);
  const bool glass = refracts(lobe);
  const float albedo = glass ? glass_albedo(roughness, cos_o, lobe.ior) : ggx_albedo(roughness, cos_o);
  const float mean = glass ? glass_mean_albedo(roughness, lobe.ior) : ggx_mean_albedo(roughness);
  const float missing = (1.0f - albedo) / albedo;
  lobe.energy = 1.0f + missing;
  const glm::vec3 bounce = further_bounce(lobe);
  if (bounce == glm::vec3(1.0f))
    return;
  const glm::vec3 all_further = bounce * mean / (1.0f - bounce * (1.0f - mean));
  lobe.color *= (1.0f + all_further * missing) / lobe.energy;
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
  lobe.ior = ior;
  lobe.reflection = reflection;
  lobe.transmission = transmission;
}

void set_principled3(Lobe &lobe, const glm::vec3 &f0, float ior) {
  lobe.fresnel = FresnelKind::Principled3;
  lobe.f0 = glm::clamp(f0, 0.0f, 1.0f);
  lobe.ior = ior;
  lobe.transmission = glm::vec3(0.0f);
}

MicrofacetAlbedo microfacet_albedo(const Lobe &lobe, float cos_o) {
  // Smooth surfaces first; reflection of Fresnel curves is averaged over the facets.
  const FacetResponse smooth = facet_response(lobe, cos_o);
  glm::vec3 reflected = smooth.reflected;
  if (reflected != glm::vec3(0.0f)) {
    const float roughness = roughness_of(lobe);
    if (lobe.fresnel == FresnelKind::Schlick) {
      const float s = dielectric_mix(roughness, cos_o, lobe.ior);
      reflected = (lobe.f0 + (lobe.f90 - lobe.f0) * s) * lobe.reflection;
    } else if (lobe.fresnel == FresnelKind::F82) {
      reflected = lobe.f0 + (1.0f - lobe.f0) * fifth_power_mix(roughness, cos_o);
    } else if (lobe.fresnel == FresnelKind::Dielectric && lobe.ior > 1.0f && lobe.rules == Rules::Blender45) {
      const float f0 = f0_of_ior(lobe.ior);
      reflected = (f0 + (1.0f - f0) * dielectric_mix(roughness, cos_o, lobe.ior)) * lobe.reflection;
    }
  }
  return {lobe.color * reflected, lobe.color * smooth.through};
}

void complete_microfacet(Lobe &lobe, float cos_o, bool preserving) {
  const float alpha2 = lobe.alpha_x * lobe.alpha_y;
  lobe.delta = alpha2 <= (lobe.rules == Rules::Blender3 ? kMirrorAlpha2Blender3 : kMirrorAlpha2);
  if (refracts(lobe)) {
    // The refracted lobe is narrower than the reflected one by the share by which the index bends.
    const float bent = std::abs(1.0f - 1.0f / lobe.ior);
    lobe.delta_through = std::abs(lobe.ior - 1.0f) < kStraightIor || alpha2 * bent * bent < kMirrorAlpha2;
  }
  if (preserving && !lobe.beckmann)
    preserve_energy(lobe, cos_o);
  const MicrofacetAlbedo albedo = microfacet_albedo(lobe, cos_o);
  lobe.albedo = albedo.reflected + albedo.through;
  lobe.through = reflects(lobe) ? albedo.through : glm::vec3(0.0f);
}

void add(Bsdf &bsdf, const Lobe &lobe) {
  if (bsdf.count >= kMaxLobes || lobe.color == glm::vec3(0.0f))
    return;
  bsdf.lobes[bsdf.count++] = lobe;
  bsdf.shapes |= shape_bit(lobe.shape);
}

} // namespace lancer
