// Means over the lobes of a surface for passes: the mean normal, and the matt share for denoisers.
#pragma once

#include "bsdf/bsdf.h"
#include "simd/vectors.h"

namespace lancer {

// Returns the mean normal of the lobes, or of the diffuse lobes, weighted by their colours; the shading normal where all
// weights are 0.
template <class F> LANCER_LANE Vec3<F> mean_normal(const Bsdf<F> &bsdf, bool diffuse_only = false) {
  using V = Vec3<F>;
  V sum(F(0.0f));
  for (int i = 0; i < bsdf.count; ++i)
    if (!diffuse_only || bsdf.lobes[i].component == Component::Diffuse)
      sum += bsdf.frames[bsdf.lobes[i].frame].n * mean(bsdf.lobes[i].color);
  // The square of a very dark or bright colour leaves the range of float: scale the sum to about 1 by a power of two, which
  // changes no other bit.
  const auto power = as_word(largest(abs(sum))) & WordOf<F>(0x7f800000u);
  const MaskOf<F> normal = (!equal(power, WordOf<F>(0u))) & !equal(power, WordOf<F>(0x7f800000u));
  return select(normal, normalize(sum * (1.0f / as_float(power))), bsdf.ns);
}

// A lobe of at most this alpha is treated as a mirror.
inline constexpr float kMirrorLike = 0.075f;

template <class F> LANCER_LANE F smooth_step(F x) {
  const F t = clamp01(x);
  return t * t * (3.0f - 2.0f * t);
}

// Returns the alpha of a lobe's facets: 0 of a mirror, 1 of a lobe without facets.
template <class F> LANCER_LANE F alpha_of(const Lobe<F> &lobe) {
  switch (lobe.shape) {
  case LobeShape::Mirror:
  case LobeShape::Dielectric:
    return F(0.0f);
  case LobeShape::Beckmann:
  case LobeShape::Microfacet:
  case LobeShape::Ashikhmin:
    return sqrt(lobe.alpha_x * lobe.alpha_y);
  default:
    return F(1.0f);
  }
}

// Returns the matt share of a lobe of this alpha: 0 or 1, or a smooth step over twice the limit.
template <class F> LANCER_LANE F matt_share(F alpha, bool blended) {
  if (blended)
    return smooth_step(alpha / (2.0f * kMirrorLike));
  return select(alpha > kMirrorLike, F(1.0f), F(0.0f));
}

// The scattering of a surface, divided into matt and mirror-like.
template <class F> struct Mixture {
  using V = Vec3<F>;
  V normal{F(0.0f)}, diffuse{F(0.0f)}, specular{F(0.0f)};
  F all{0.0f}, matt{0.0f};
  F roughness{0.0f}; // as of shader nodes
};

// Without blending, transmitted light is treated as mirrored. ended: lanes at the end of a path, where no lobe scatters. bare:
// of bakes, the roughness where no lobe counts; negative: no bake. As in Cycles, bakes leave diffuse lobes out, and light that
// passes straight counts as that of a mirror.
template <class F>
LANCER_LANE Mixture<F> mix(const Bsdf<F> &bsdf, const Vec3<F> &transmittance, MaskOf<F> ended, bool blended, float bare) {
  const F zero(0.0f);
  const bool baked = bare >= 0.0f;
  F rough = baked ? mean(transmittance) : zero; // weights in the roughness
  Mixture<F> mixture;
  if (!blended) {
    mixture.specular = transmittance;
    mixture.all = mean(transmittance);
    mixture.normal = mixture.all * bsdf.ns;
  }
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<F> &lobe = bsdf.lobes[i];
    const MaskOf<F> there = (!black(lobe.color)) & !ended;
    const Vec3<F> albedo = lobe.rules < Rules::Blender52 ? lobe.albedo : lobe.albedo - lobe.through + shown_through(lobe);
    const F weight = select(there, abs(mean(albedo)), zero), alpha = alpha_of(lobe);
    const F share = matt_share(alpha, blended);
    // Cycles shows denoisers the direction of Huang's fibres.
    const Frame<F> &frame = bsdf.frames[lobe.frame];
    mixture.normal += weight * (is_hair(lobe, Hair::Huang) ? frame.t : frame.n);
    mixture.all += weight;
    mixture.matt += share * weight;
    if (blended && !(baked && lobe.component == Component::Diffuse)) {
      mixture.roughness += weight * sqrt(alpha);
      rough += weight;
    }
    mixture.diffuse = select(there, mixture.diffuse + share * albedo, mixture.diffuse);
    mixture.specular = select(there, mixture.specular + (1.0f - share) * albedo, mixture.specular);
  }
  mixture.normal = select(mixture.all > zero, mixture.normal / mixture.all, mixture.normal);
  mixture.roughness = select(rough > zero, mixture.roughness / rough, baked ? F(bare) : zero);
  return mixture;
}

} // namespace lancer
