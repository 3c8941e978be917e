// Hair as Cycles shows it on meshes: fibres along a tangent, whose light falls on cones about it. Values are f cos(wi) without
// the colour; Cycles multiplies them by no cosine.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"

namespace lancer {

// Reflection and Transmission of the Hair BSDF; the models of the Principled Hair BSDF: Huang's is in huang.h.
enum class Hair : uint8_t { Reflection = 0, Transmission = 1, Chiang = 2, Huang = 3 };
template <class F> bool is_hair(const Lobe<F> &lobe) { return lobe.shape == LobeShape::Hair; }
template <class F> bool is_hair(const Lobe<F> &lobe, Hair variant) {
  return is_hair(lobe) && lobe.variant == static_cast<uint8_t>(variant);
}

inline constexpr float kRight = 0.5f * kPi;
inline constexpr float kSmoothestHair = 0.001f;

// The Hair BSDF: Lorentzian cones along the tangent, and around it a cosine or a Lorentzian. alpha_x and alpha_y: roughness
// along the fibre and around it; b: the unit tangent in the lobe's frame; ior: tilt of the cones.
template <class F>
LANCER_LANE Lobe<F> make_hair(const Vec3<F> &weight, F along, F around, F tilt, const Vec3<F> &tangent, Hair variant) {
  Lobe<F> lobe;
  lobe.shape = LobeShape::Hair;
  lobe.variant = static_cast<uint8_t>(variant);
  lobe.component = variant == Hair::Transmission ? Component::Transmission : Component::Glossy;
  lobe.color = lobe.albedo = weight;
  lobe.alpha_x = min(max(along, F(kSmoothestHair)), F(1.0f));
  lobe.alpha_y = min(max(around, F(kSmoothestHair)), F(1.0f));
  lobe.ior = tilt;
  lobe.b = tangent;
  return lobe;
}

// A direction as seen along a tangent: the angle above the plane across, and the unit direction within that plane.
template <class F> struct Strand {
  F theta;
  Vec3<F> across;
};
template <class F> LANCER_LANE Strand<F> strand(const Vec3<F> &w, const Vec3<F> &tangent) {
  const F along = min(max(dot(w, tangent), F(-1.0f)), F(1.0f));
  const Vec3<F> rest = w - along * tangent;
  const F length = sqrt(dot(rest, rest));
  return {asin(along), select(length > F(0.0f), rest / length, Vec3<F>(F(0.0f)))};
}

// The range of the cones' angle, as arcs of the tangent over the roughness.
template <class F> struct Cones { F low, high; };
template <class F> LANCER_LANE Cones<F> cones(const Lobe<F> &lobe, F theta_o) {
  return {atan((0.5f * (theta_o - kRight) - lobe.ior) / lobe.alpha_x),
          atan((0.5f * (theta_o + kRight) - lobe.ior) / lobe.alpha_x)};
}

// Densities along the fibre and around it, whose product is that of hair_sample().
template <class F> struct HairDensity {
  F along, around;
  F phi, cos_phi;    // turn between both directions
  MaskOf<F> defined; // wi is not along the fibre
};
template <class F> LANCER_LANE HairDensity<F> hair_density(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const Strand<F> o = strand<F>(wo, lobe.b), i = strand<F>(wi, lobe.b);
  HairDensity<F> r;
  r.cos_phi = min(max(dot(o.across, i.across), F(-1.0f)), F(1.0f));
  r.phi = acos(r.cos_phi);
  r.defined = kRight - abs(i.theta) >= 0.001f;
  const Cones<F> range = cones(lobe, o.theta);
  const F t = 0.5f * (i.theta + o.theta) - lobe.ior;
  r.along = lobe.alpha_x / (2.0f * (t * t + lobe.alpha_x * lobe.alpha_x) * (range.high - range.low) * cos(i.theta));
  if (is_hair(lobe, Hair::Reflection)) {
    r.around = cos(0.5f * min(r.phi / lobe.alpha_y, F(kPi))) * 0.25f / lobe.alpha_y;
  } else {
    const F p = kPi - r.phi;
    r.around = lobe.alpha_y / (2.0f * atan(kRight / lobe.alpha_y) * (p * p + lobe.alpha_y * lobe.alpha_y));
  }
  return r;
}

// drew: lanes whose direction the lobe has sampled. Cycles takes those on any side, and weighs reflected ones against light
// samples by a density with the cosine of roughness 1 around the fibre.
template <class F>
LANCER_LANE ColorValue<F> hair_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi, MaskOf<F> drew) {
  const F zero(0.0f);
  const bool reflects = is_hair(lobe, Hair::Reflection);
  const HairDensity<F> density = hair_density(lobe, wo, wi);
  const MaskOf<F> on_side = reflects ? (wi.z >= zero) & (density.cos_phi >= zero) : wi.z < zero;
  F around = density.around;
  if (reflects)
    around = select(drew, cos(0.5f * density.phi) * 0.25f / lobe.alpha_y, around);
  const F value = max(density.along * around, zero);
  return where<F>(density.defined & (drew | on_side), {Vec3<F>(value), value});
}

template <class F> LANCER_LANE Vec3<F> hair_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const Strand<F> o = strand<F>(wo, lobe.b);
  const Cones<F> range = cones(lobe, o.theta);
  const F t = lobe.alpha_x * tan(range.low + u * (range.high - range.low));
  const F theta = 2.0f * (t + lobe.ior) - o.theta;
  const F phi = is_hair(lobe, Hair::Reflection) ? 2.0f * asin(1.0f - 2.0f * v) * lobe.alpha_y
                                                : kPi + lobe.alpha_y * tan(2.0f * atan(kRight / lobe.alpha_y) * (v - 0.5f));
  // A direction along the fibre has no plane: any does.
  const MaskOf<F> aligned = dot(o.across, o.across) == F(0.0f);
  const Vec3<F> across = select(aligned, Frame<F>(lobe.b).t, o.across), beside = cross(across, lobe.b);
  return cos(theta) * (cos(phi) * across - sin(phi) * beside) + sin(theta) * lobe.b;
}

// The Principled Hair BSDF of Chiang, Bitterli, Tappan and Burley 2016: light reflected, through the fibre, reflected within it
// once, and the rest. Its frame has the tangent as t and the normal of the plane of tangent and wo as n. alpha_x and alpha_y:
// variance along the fibre and scale around it; energy: variance of the first reflection; ior; shininess: tilt of the scales;
// f0: absorption; lowest: sine of the offset from the fibre's axis.
inline constexpr int kHairParts = 4;

template <class F> LANCER_LANE F power20(F x) {
  const F x2 = x * x, x4 = x2 * x2, x8 = x4 * x4;
  return x8 * x8 * x4;
}
template <class F> LANCER_LANE F hair_variance(F roughness) {
  const F root = 0.726f * roughness + 0.812f * (roughness * roughness) + 3.7f * power20(roughness);
  return root * root;
}

// ng: in the lobe's frame, on the side of wo.
template <class F>
LANCER_LANE Lobe<F> make_chiang(const Vec3<F> &weight, F along, F around, F first, F ior, F tilt, const Vec3<F> &absorption,
                                const Vec3<F> &ng, Rules rules) {
  const auto rough = [](F x) __attribute__((always_inline)) { return min(max(x, F(kSmoothestHair)), F(1.0f)); };
  const F u = rough(along), v = rough(around);
  Lobe<F> lobe;
  lobe.shape = LobeShape::Hair;
  lobe.variant = static_cast<uint8_t>(Hair::Chiang);
  lobe.rules = rules;
  lobe.component = Component::Glossy;
  lobe.color = weight;
  lobe.alpha_x = hair_variance(u);
  lobe.alpha_y = (0.265f * v + 1.194f * (v * v) + 5.372f * (power20(v) * v * v)) * 0.626657069f; // sqrt(pi / 8)
  lobe.energy = hair_variance(rough(first * u));
  lobe.ior = ior;
  lobe.shininess = -tilt;
  lobe.f0 = absorption;
  // The frame's t, n and -b are the axes X, Y and Z of the model; the offset is a sine about X.
  lobe.lowest = min(max(-cross(ng, Vec3<F>(F(1.0f), F(0.0f), F(0.0f))).y, F(-1.0f)), F(1.0f));
  return lobe;
}

template <class F> LANCER_LANE F cosine_of(F sine) { return sqrt(max((1.0f - sine) * (1.0f + sine), F(0.0f))); }

// Sine and cosine of an angle above the plane across a fibre.
template <class F> struct Slant { F sine, cosine; };
// by: sine and cosine of the angle to add.
template <class F> LANCER_LANE Slant<F> tilted(const Slant<F> &slant, F sin_by, F cos_by) {
  return {slant.sine * cos_by + slant.cosine * sin_by, abs(slant.cosine * cos_by - slant.sine * sin_by)};
}
// Whether the scales tilt wi instead of wo: before Blender 4.2.
template <class F> bool tilts_wi(const Lobe<F> &lobe) { return lobe.rules == Rules::Blender3; }

// The parts of a fibre's light: their shares of light and of samples, and their places.
template <class F> struct Fibre {
  Vec3<F> share[kHairParts];
  F chance[kHairParts];
  F sin_o[kHairParts], cos_o[kHairParts]; // of wo along the fibre, tilted by the scales from Blender 4.2 on
  F sin_tilt[3], cos_tilt[3];             // of the tilt
  F turn[kHairParts - 1];                 // around the fibre
  F phi;                                  // of wo
};
template <class F> LANCER_LANE Fibre<F> fibre(const Lobe<F> &lobe, const Vec3<F> &wo) {
  using V = Vec3<F>;
  const F one(1.0f);
  Fibre<F> r;
  const F sin_o = min(max(wo.x, -one), one), cos_o = cosine_of(sin_o);
  r.phi = atan2(-wo.y, wo.z);
  // An index below 1 may reflect all light: the cosine within the fibre is at least 1e-4.
  const F cos_t = max(cosine_of(sin_o / lobe.ior), F(1e-4f));
  const F sin_gamma = lobe.lowest, cos_gamma = cosine_of(sin_gamma), gamma_o = asin(sin_gamma);
  const F bent = sin_gamma * cos_o / sqrt(max(lobe.ior * lobe.ior - sin_o * sin_o, F(1e-12f)));
  const F sin_gamma_t = min(max(bent, -one), one), gamma_t = asin(sin_gamma_t);
  const F way = -2.0f * cosine_of(sin_gamma_t) / cos_t;
  const V t(exp(lobe.f0.x * way), exp(lobe.f0.y * way), exp(lobe.f0.z * way));
  const F f = fresnel_dielectric(cos_o * cos_gamma, lobe.ior), g = one - f;
  r.share[0] = V(f);
  r.share[1] = g * g * t;
  r.share[2] = r.share[1] * t * f;
  const V kept = t * f, rest = V(one) - kept;
  r.share[3] = r.share[2] * V(quotient(kept.x, rest.x), quotient(kept.y, rest.y), quotient(kept.z, rest.z));
  // Samples are shared by luminance, on which the weights against light samples depend.
  const V luminance(0.2126f, 0.7152f, 0.0722f);
  F all(0.0f);
  for (const V &share : r.share)
    all += dot(share, luminance);
  for (int p = 0; p < kHairParts; ++p)
    r.chance[p] = quotient(dot(r.share[p], luminance), all);
  // The scales tilt the parts by -2, 1 and 4 times their angle.
  const F sin1 = sin(lobe.shininess), cos1 = cosine_of(sin1), sin2 = 2.0f * sin1 * cos1, cos2 = cos1 * cos1 - sin1 * sin1,
          sin4 = 2.0f * sin2 * cos2, cos4 = cos2 * cos2 - sin2 * sin2;
  const F sines[3] = {-sin2, sin1, sin4}, cosines[3] = {cos2, cos1, cos4};
  for (int p = 0; p < 3; ++p) {
    r.sin_tilt[p] = sines[p];
    r.cos_tilt[p] = cosines[p];
    const Slant<F> o = tilted<F>({sin_o, cos_o}, sines[p], cosines[p]);
    r.sin_o[p] = tilts_wi(lobe) ? sin_o : o.sine;
    r.cos_o[p] = tilts_wi(lobe) ? cos_o : o.cosine;
    r.turn[p] = 2.0f * float(p) * gamma_t - 2.0f * gamma_o + float(p) * kPi;
  }
  r.sin_o[3] = sin_o;
  r.cos_o[3] = cos_o;
  return r;
}

template <class F> LANCER_LANE F part_variance(const Lobe<F> &lobe, int part) {
  return part == 0 ? lobe.energy : (part == 1 ? 0.25f : 4.0f) * lobe.alpha_x;
}

// log of the modified Bessel function of the first kind and order 0, less x, for x >= 0.
template <class F> LANCER_LANE F log_bessel_less(F x) {
  const F y = 0.25f * min(x, F(12.0f)) * min(x, F(12.0f));
  F sum(1.0f), term(1.0f);
  for (int i = 1; i < 10; ++i) {
    term = term * y / float(i * i);
    sum += term;
  }
  const F far = 0.5f * (1.0f / (8.0f * x) - 1.8378771f - log(max(x, F(1.0f))));
  return select(x > 12.0f, far, log(sum) - x);
}

// Density of directions along the fibre, per sine. The exponent is written in differences of the sines and cosines, so that no
// large terms cancel where the variance is small.
template <class F> LANCER_LANE F along_fibre(F sin_i, F cos_i, F sin_o, F cos_o, F variance) {
  const F inverse = 1.0f / variance, sum = sin_i + sin_o, apart = cos_i - cos_o;
  const F exponent = log_bessel_less(cos_i * cos_o * inverse) - 0.5f * (sum * sum + apart * apart) * inverse;
  return exp(exponent) * inverse / (-expm1(-2.0f * inverse));
}

// The logistic distribution, cut at half a turn.
template <class F> LANCER_LANE F logistic_below(F x, F scale) { return 1.0f / (1.0f + exp(min(-x / scale, F(88.0f)))); }
template <class F> LANCER_LANE F around_fibre(F angle, F scale) {
  const F turns = (angle + kPi) / (2.0f * kPi);
  const F wrapped = abs((turns - floor(turns)) * (2.0f * kPi) - kPi);
  const F fall = exp(-wrapped / scale);
  return fall / (scale * ((1.0f + fall) * (1.0f + fall))) / (1.0f - 2.0f * logistic_below(F(-kPi), scale));
}

template <class F> LANCER_LANE ColorValue<F> chiang_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const Fibre<F> r = fibre(lobe, wo);
  const F sin_i = min(max(wi.x, F(-1.0f)), F(1.0f)), cos_i = cosine_of(sin_i);
  const F phi = atan2(-wi.y, wi.z) - r.phi;
  ColorValue<F> value;
  for (int p = 0; p < kHairParts; ++p) {
    Slant<F> i{sin_i, cos_i};
    if (p < 3 && tilts_wi(lobe))
      i = tilted<F>(i, -r.sin_tilt[p], r.cos_tilt[p]);
    const F along = along_fibre(i.sine, i.cosine, r.sin_o[p], r.cos_o[p], part_variance(lobe, p));
    const F around = p < 3 ? around_fibre(phi - r.turn[p < 3 ? p : 0], lobe.alpha_y) : F(0.5f * kInvPi);
    value.f += r.share[p] * (along * around);
    value.pdf += r.chance[p] * (along * around);
  }
  return value;
}

// u_part: chooses the part; its remainder samples along the fibre. reflected: lanes of the first part.
template <class F>
LANCER_LANE Vec3<F> chiang_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u_part, F u, F v, MaskOf<F> &reflected) {
  const Fibre<F> r = fibre(lobe, wo);
  const F one(1.0f);
  F sin_o = r.sin_o[3], cos_o = r.cos_o[3], variance = part_variance(lobe, 3), chance = r.chance[3], left = u_part;
  F turn = 2.0f * kPi * u, sin_tilt(0.0f), cos_tilt(1.0f);
  const F low = logistic_below(F(-kPi), lobe.alpha_y);
  const F across = -lobe.alpha_y * log(max(one / (u * (one - 2.0f * low) + low) - one, F(1e-30f)));
  const F swing = min(max(across, F(-kPi)), F(kPi));
  MaskOf<F> open = uniform<F>(true);
  reflected = uniform<F>(false);
  for (int p = 0; p < 3; ++p) {
    const MaskOf<F> here = open & (left < r.chance[p]);
    sin_o = select(here, r.sin_o[p], sin_o);
    cos_o = select(here, r.cos_o[p], cos_o);
    variance = select(here, part_variance(lobe, p), variance);
    chance = select(here, r.chance[p], chance);
    turn = select(here, r.turn[p] + swing, turn);
    sin_tilt = select(here, r.sin_tilt[p], sin_tilt);
    cos_tilt = select(here, r.cos_tilt[p], cos_tilt);
    if (p == 0)
      reflected = here;
    open = open & !here;
    left = select(open, left - r.chance[p], left);
  }
  const F rest = max(select(chance > F(0.0f), clamp01(left / chance), F(0.0f)), F(1e-5f));
  // 1 minus the sine about the opposite direction keeps its digits where the variance is small.
  const F fall = -variance * log(rest + (one - rest) * exp(-2.0f / variance));
  const F aside = sqrt(max(fall * (2.0f - fall), F(0.0f)));
  const F along = (fall - one) * sin_o + aside * sin_cos_turn(v).cos * cos_o;
  F sin_i = min(max(along, -one), one), cos_i = cosine_of(sin_i);
  if (tilts_wi(lobe)) {
    const Slant<F> i = tilted<F>({sin_i, cos_i}, sin_tilt, cos_tilt);
    sin_i = i.sine;
    cos_i = i.cosine;
  }
  const F phi = r.phi + turn;
  return {sin_i, -cos_i * sin(phi), cos_i * cos(phi)};
}

// The passes' colour, as Cycles estimates it.
template <class F> LANCER_LANE Vec3<F> chiang_albedo(const Lobe<F> &lobe, const Vec3<F> &wo) {
  const F x = lobe.alpha_x;
  const F scale = ((((0.245f * x + 5.574f) * x - 10.73f) * x + 2.532f) * x - 0.215f) * x + 5.969f;
  const F f = fresnel_dielectric(cosine_of(wo.x) * cosine_of(lobe.lowest), lobe.ior);
  // Cycles before 4.0 leaves out the reflection.
  const F added = lobe.rules == Rules::Blender3 ? F(0.0f) : f;
  const auto kept = [&](F absorption) __attribute__((always_inline)) { return exp(-sqrt(absorption) * scale) + added; };
  return lobe.color * Vec3<F>(kept(lobe.f0.x), kept(lobe.f0.y), kept(lobe.f0.z));
}

} // namespace lancer
