// Toon shading: light of constant brightness from a cone of directions about the normal or the mirrored direction, with an edge
// that fades linearly with the angle. Local frame; values are f cos(wi) without the colour, as in Cycles: the cosine has no
// effect on them.
#pragma once

#include "bsdf/lobe.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"

namespace lancer {

enum class Toon : uint8_t { Diffuse = 0, Glossy = 1 };

// size and smooth: of 0 ... 1. alpha_x: the angle of full brightness; alpha_y: that of the edge; energy: the sampled angle;
// shininess: 1 - cos of that.
template <class F> LANCER_LANE Lobe<F> make_toon(const Vec3<F> &weight, F size, F smooth, Toon variant, Rules rules) {
  constexpr float right = 0.5f * kPi;
  Lobe<F> lobe;
  lobe.shape = LobeShape::Toon;
  lobe.variant = static_cast<uint8_t>(variant);
  lobe.component = variant == Toon::Glossy ? Component::Glossy : Component::Diffuse;
  lobe.rules = rules;
  // Cycles 3 has no least size: a cone without any width is black.
  lobe.alpha_x = right * min(max(size, F(rules == Rules::Blender3 ? 0.0f : 1e-5f)), F(1.0f));
  lobe.alpha_y = right * clamp01(smooth);
  lobe.energy = min(lobe.alpha_x + lobe.alpha_y, F(right));
  const F half = sin(0.5f * lobe.energy);
  lobe.shininess = 2.0f * half * half;
  lobe.color = lobe.albedo = select(lobe.energy > 0.0f, weight, Vec3<F>(F(0.0f)));
  return lobe;
}

// Returns the brightness at an angle to the axis.
template <class F> LANCER_LANE F toon_brightness(const Lobe<F> &lobe, F angle) {
  const F zero(0.0f), one(1.0f);
  const F faded = select(lobe.alpha_y > zero, one - (angle - lobe.alpha_x) / lobe.alpha_y, zero);
  return select(angle < lobe.alpha_x, one, max(faded, zero));
}

template <class F> LANCER_LANE Vec3<F> toon_axis(const Lobe<F> &lobe, const Vec3<F> &wo) {
  const F zero(0.0f);
  return lobe.variant == static_cast<uint8_t>(Toon::Glossy) ? reflect_local(wo) : Vec3<F>(zero, zero, F(1.0f));
}

// drew: lanes whose direction the lobe has sampled, in which Cycles 3 takes the brightness at another angle.
template <class F>
LANCER_LANE ColorValue<F> toon_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, MaskOf<F> drew) {
  const Vec3<F> axis = toon_axis(lobe, wo), apart = wi - axis, along = wi + axis;
  // The chord keeps the digits of a small angle.
  const F chord2 = dot(apart, apart), angle = 2.0f * atan2(sqrt(chord2), sqrt(dot(along, along)));
  F seen = angle;
  if (lobe.rules == Rules::Blender3)
    seen = select(drew, lobe.energy * (1.0f - min(0.5f * chord2 / lobe.shininess, F(1.0f))), angle);
  MaskOf<F> there = (angle < lobe.energy) & (wi.z >= F(0.0f));
  if (lobe.variant == static_cast<uint8_t>(Toon::Glossy)) {
    // Cycles 3 takes directions beyond a right angle to the mirrored one as being there.
    if (lobe.rules == Rules::Blender3) {
      constexpr float right = 0.5f * kPi;
      seen = select(drew, seen, min(angle, F(right)));
      there = drew | (seen < lobe.energy) | (lobe.energy >= right);
    }
    there = there & (wo.z > F(0.0f)) & (wi.z > F(0.0f));
  }
  const F pdf = warp_cone_pdf(lobe.shininess);
  return where<F>(there, {Vec3<F>(pdf * toon_brightness(lobe, seen)), pdf});
}

template <class F> LANCER_LANE Vec3<F> toon_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const Vec3<F> cone = warp_cone(u, v, lobe.shininess);
  return lobe.variant == static_cast<uint8_t>(Toon::Glossy) ? Frame<F>(toon_axis(lobe, wo)).to_world(cone) : cone;
}

} // namespace lancer
