// How the lobes of a Bsdf are summed and sampled. Included by bsdf.h alone.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/ashikhmin.h"
#include "bsdf/blinn_phong.h"
#include "bsdf/bsdf.h"
#include "bsdf/bump.h"
#include "bsdf/coating.h"
#include "bsdf/dielectric.h"
#include "bsdf/lambert.h"
#include "bsdf/matte.h"
#include "bsdf/microfacet_terms.h"
#include "bsdf/mirror.h"
#include "bsdf/phong.h"
#include "bsdf/sheen.h"

namespace lancer {

template <uint32_t Shapes> bool Bsdf::is(const Lobe &lobe, LobeShape shape) {
  return (Shapes & shape_bit(shape)) != 0 && (Shapes == shape_bit(shape) || lobe.shape == shape);
}

template <uint32_t Shapes> bool Bsdf::is_delta(const Lobe &lobe) {
  constexpr uint32_t never = shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Phong) | shape_bit(LobeShape::BlinnPhong) |
                             shape_bit(LobeShape::Matte) | shape_bit(LobeShape::Sheen);
  return (Shapes & ~never) != 0 && lobe.delta;
}

// The component of light that a lobe sends that way.
inline Component component_of(const Lobe &lobe, bool through) {
  const bool both = lobe.shape == LobeShape::Microfacet || lobe.shape == LobeShape::Dielectric;
  return both && through ? Component::Transmission : lobe.component;
}

// alpha_x alpha_y, or what takes its place.
inline float alpha2_of(const Lobe &lobe) {
  switch (lobe.shape) {
  case LobeShape::Microfacet:
  case LobeShape::Ashikhmin:
    return lobe.alpha_x * lobe.alpha_y;
  case LobeShape::Beckmann:
    return lobe.alpha_x * lobe.alpha_x;
  case LobeShape::Phong:
  case LobeShape::BlinnPhong:
    // Beckmann's lobe of the same curvature at its top.
    return std::min(1.0f, 2.0f / (lobe.shininess + 2.0f));
  default:
    return 1.0f;
  }
}

// Whether a lobe draws a direction on that side of ng: none passes the surface the wrong way, except that Cycles 3 does not ask
// it of lobes that refract.
inline bool draws_on_side(const Lobe &lobe, bool through, float cos_ng) {
  return (cos_ng < 0.0f) == through || (lobe.rules == Rules::Blender3 && lobe.shape == LobeShape::Microfacet && refracts(lobe));
}

inline void Bsdf::turn_to_frames(const glm::vec3 &wi, int known, const glm::vec3 &wi_known, Local &local) const {
  for (int i = 0; i < frame_count; ++i)
    local.wi[i] = i == known ? wi_known : frames[i].to_local(wi);
  local.cos_ng = flat ? local.wi[0].z : glm::dot(ng, wi);
}

template <uint32_t Shapes> BsdfValue Bsdf::sum(const Local &local, const Drawn &drawn, bool lit) const {
  BsdfValue value;
  // The half vector of a frame serves all lobes that reflect in it.
  int half_frame = drawn.has_h && local.wi[lobes[drawn.lobe].frame].z > 0.0f ? lobes[drawn.lobe].frame : -1;
  glm::vec3 h = drawn.h;
  for (int i = 0; i < count; ++i) {
    const Lobe &lobe = lobes[i];
    if (is_delta<Shapes>(lobe) || lobe.probability == 0.0f)
      continue;
    const glm::vec3 &wi = local.wi[lobe.frame];
    const bool through = wi.z < 0.0f;
    const bool counts = lit || draws_on_side(lobe, through, local.cos_ng);
    if (is<Shapes>(lobe, LobeShape::Lambert) && lobe.frame == 0) {
      const float value_pdf = lambert_eval(wi);
      value.part[0] += lobe.color * value_pdf;
      value.pdf += counts ? lobe.probability * value_pdf : 0.0f;
      continue;
    }
    float bump = 1.0f;
    if (lobe.frame != 0 && bump_acts(lobe, i == drawn.lobe)) {
      bump = bump_factor(lobe, frames[lobe.frame].n, ns, local.wi[0].z, wi.z, bump_correction);
      if (bump == 0.0f) {
        // Where the lobe that drew wi gives nothing the sample is lost: its density is not in the sum either.
        if (i == drawn.lobe)
          return {};
        continue;
      }
    }
    const glm::vec3 &wo_l = wo_local[lobe.frame];
    ColorValue term;
    if (is<Shapes>(lobe, LobeShape::Lambert)) {
      const float value_pdf = lambert_eval(wi);
      term = {glm::vec3(value_pdf), value_pdf};
    } else if (is<Shapes>(lobe, LobeShape::Matte)) {
      term = matte_eval(lobe, wo_l, wi);
    } else if (is<Shapes>(lobe, LobeShape::Sheen)) {
      term = sheen_eval(lobe, wo_l, wi);
    } else if (is<Shapes>(lobe, LobeShape::Ashikhmin)) {
      term = gloss_eval(lobe, wo_l, wi);
    } else if (is<Shapes>(lobe, LobeShape::Microfacet) && through) {
      term = microfacet_eval_through(
          lobe, wo_l, wi, i == drawn.lobe && drawn.has_h ? drawn.h : refraction_half_vector(wo_l, wi, lobe.ior), lit);
    } else if (wo_l.z > 0.0f && wi.z > 0.0f) {
      // What is left reflects about the half vector.
      if (half_frame != lobe.frame) {
        half_frame = lobe.frame;
        h = half_vector(wo_l, wi);
      }
      if (is<Shapes>(lobe, LobeShape::Microfacet)) {
        term = microfacet_eval_reflected(lobe, wo_l, wi, h);
      } else {
        LobeValue grey;
        if (is<Shapes>(lobe, LobeShape::Beckmann))
          grey = coating_eval_pdf(lobe, wo_l, wi, h);
        else if (is<Shapes>(lobe, LobeShape::Phong))
          grey = phong_eval_pdf(lobe, wo_l, wi);
        else if (is<Shapes>(lobe, LobeShape::BlinnPhong))
          grey = blinn_phong_eval_pdf(lobe, wo_l, h);
        term = {glm::vec3(grey.f * wi.z), grey.pdf};
      }
    }
    value.part[static_cast<int>(component_of(lobe, through))] += lobe.color * term.f * bump;
    value.pdf += counts ? lobe.probability * term.pdf : 0.0f;
  }
  return value;
}

template <uint32_t Shapes> BsdfValue Bsdf::eval(const glm::vec3 &wi, int drawn) const {
  Local local;
  turn_to_frames(wi, -1, wi, local);
  return sum<Shapes>(local, {.lobe = drawn}, false);
}

template <uint32_t Shapes> BsdfValue Bsdf::eval_lit(const glm::vec3 &wi) const {
  Local local;
  turn_to_frames(wi, -1, wi, local);
  return sum<Shapes>(local, {}, true);
}

// The lobe that u falls on, and in u what remains of it, again in [0, 1). A lobe of probability 0 is never picked, even where
// rounding leaves u beyond the last sum. -1: all are black.
inline int Bsdf::pick(float &u) const {
  int last = -1;
  for (int i = 0; i < count; ++i) {
    const float probability = lobes[i].probability;
    if (!(probability > 0.0f))
      continue;
    last = i;
    if (u < probability) {
      u /= probability;
      break;
    }
    u -= probability;
  }
  u = std::min(u, 1.0f - 0x1p-24f);
  return last;
}

template <uint32_t Shapes> BsdfSample Bsdf::sample(float u_lobe, glm::vec2 u) const {
  const int chosen = pick(u_lobe);
  if (chosen < 0)
    return {};
  if (is_delta<Shapes>(lobes[chosen]))
    return sample_delta<Shapes>(lobes[chosen], u_lobe);
  return sample_smooth<Shapes>(chosen, u_lobe, u);
}

// A single direction; probability within the lobe.
inline BsdfSample Bsdf::single(const Lobe &lobe, const glm::vec3 &wi, const glm::vec3 &weight, float probability) const {
  BsdfSample result;
  const bool through = wi.z < 0.0f;
  result.wi = frames[lobe.frame].to_world(wi);
  if (wi.z == 0.0f || !draws_on_side(lobe, through, glm::dot(ng, result.wi)))
    return {};
  result.weight = lobe.color * weight / lobe.probability;
  result.pdf = lobe.probability * probability;
  result.delta = true;
  result.component = component_of(lobe, through);
  if (result.component != Component::Transmission)
    result.share[static_cast<int>(result.component)] = glm::vec3(1.0f);
  result.transmitted = through;
  result.alpha2 = 0.0f;
  return result;
}

template <uint32_t Shapes> BsdfSample Bsdf::sample_delta(const Lobe &lobe, float u) const {
  const glm::vec3 &wo_l = wo_local[lobe.frame];
  if (!(wo_l.z > 0.0f))
    return {};
  if (is<Shapes>(lobe, LobeShape::Microfacet)) {
    const MicrofacetDirection d = microfacet_sample_smooth(lobe, wo_l, u);
    return single(lobe, d.wi, d.weight, d.probability);
  }
  DeltaDirection direction;
  if (is<Shapes>(lobe, LobeShape::Mirror))
    direction = mirror_sample(wo_l);
  else if (is<Shapes>(lobe, LobeShape::Beckmann))
    direction = smooth_coating_sample(lobe, wo_l);
  else if (is<Shapes>(lobe, LobeShape::Dielectric))
    direction = dielectric_sample(lobe, wo_l, u);
  else if (is<Shapes>(lobe, LobeShape::Ashikhmin))
    direction = {reflect_local(wo_l), gloss_delta_weight(lobe, wo_l), 1.0f};
  return single(lobe, direction.wi, glm::vec3(direction.weight), direction.probability);
}

template <uint32_t Shapes> BsdfSample Bsdf::sample_smooth(int chosen, float u_side, glm::vec2 u) const {
  const Lobe &lobe = lobes[chosen];
  const glm::vec3 &wo_l = wo_local[lobe.frame];
  LobeDirection direction;
  bool has_half_vector = false;
  if (is<Shapes>(lobe, LobeShape::Lambert)) {
    direction.wi = lambert_sample(u);
  } else if (is<Shapes>(lobe, LobeShape::Matte)) {
    direction.wi = matte_sample(lobe, u);
  } else if (is<Shapes>(lobe, LobeShape::Sheen)) {
    direction.wi = sheen_sample(lobe, wo_l, u);
  } else if (!(wo_l.z > 0.0f)) {
    return {};
  } else if (is<Shapes>(lobe, LobeShape::Microfacet)) {
    const MicrofacetDirection d = microfacet_sample(lobe, wo_l, u_side, u);
    if (d.delta)
      return single(lobe, d.wi, d.weight, d.probability);
    direction = {d.wi, d.h};
    has_half_vector = true;
  } else {
    // What is left reflects.
    if (is<Shapes>(lobe, LobeShape::Ashikhmin)) {
      direction.wi = gloss_sample(lobe, wo_l, u);
    } else {
      if (is<Shapes>(lobe, LobeShape::Beckmann))
        direction = coating_sample(lobe, wo_l, u);
      else if (is<Shapes>(lobe, LobeShape::Phong))
        direction = phong_sample(lobe, wo_l, u);
      else if (is<Shapes>(lobe, LobeShape::BlinnPhong))
        direction = blinn_phong_sample(lobe, wo_l, u);
      has_half_vector = true;
    }
    // A sampler may aim below the horizon; that light is lost.
    if (!(direction.wi.z > 0.0f))
      return {};
  }
  BsdfSample result;
  result.wi = frames[lobe.frame].to_world(direction.wi);
  Local local;
  turn_to_frames(result.wi, lobe.frame, direction.wi, local);
  const bool through = direction.wi.z < 0.0f;
  if (direction.wi.z == 0.0f || !draws_on_side(lobe, through, local.cos_ng))
    return {};
  // Weigh with the sum over all smooth lobes, whichever was picked; h goes along with all digits of the sampler.
  const BsdfValue value = sum<Shapes>(local, {chosen, has_half_vector, direction.h}, true);
  if (!(value.pdf > 0.0f))
    return {};
  const glm::vec3 f = value.f();
  result.weight = f / value.pdf;
  result.pdf = value.pdf;
  result.component = component_of(lobe, through);
  result.transmitted = through;
  if constexpr (Shapes == shape_bit(LobeShape::Lambert)) {
    result.share[0] = glm::vec3(1.0f);
  } else {
    for (int c = 0; c < 3 && shares; ++c)
      if (f[c] > 0.0f)
        for (int k = 0; k < 2; ++k)
          result.share[k][c] = value.part[k][c] / f[c];
    result.alpha2 = alpha2_of(lobe);
  }
  return result;
}

} // namespace lancer
