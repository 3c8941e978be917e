// The Principled Hair BSDF of Huang, Hullin and Hanika 2022 as Cycles shows it on meshes: a fibre of elliptic section, whose
// tilted scales have rough facets, seen as a whole. Light is reflected, passes through, is reflected within once, or leaves
// after further reflections. This file has the fibre's surface and the ways of light within it.
#pragma once

#include "bsdf/albedo_tables.h"
#include "bsdf/hair.h"
#include "bsdf/microfacet_eval.h"

namespace lancer {

// The frame is that of Chiang's fibre: x along the fibre, y towards the viewer across it, z across both. The ellipse has the
// axis alpha_y along y and 1 along z. alpha_x: alpha of the facets; ior; b: sine and cosine of the tilt of the scales; f0:
// absorption; f90: factors of the light that is reflected, passes, and is reflected within once; lowest: the place of the hit
// across the fibre, which only the albedo knows.
template <class F>
LANCER_LANE Lobe<F> make_huang(const Vec3<F> &weight, F alpha, F aspect, F ior, F tilt, const Vec3<F> &absorption,
                               const Vec3<F> &factors, const Vec3<F> &ns, Rules rules) {
  using V = Vec3<F>;
  Lobe<F> lobe;
  lobe.shape = LobeShape::Hair;
  lobe.variant = static_cast<uint8_t>(Hair::Huang);
  lobe.rules = rules;
  lobe.component = Component::Glossy;
  lobe.color = select(black(factors), V(F(0.0f)), weight);
  lobe.alpha_x = min(max(alpha, F(kSmoothestHair)), F(1.0f));
  lobe.alpha_y = aspect;
  lobe.ior = ior;
  lobe.b = V(sin(-tilt), cos(tilt), F(0.0f));
  lobe.f0 = absorption;
  lobe.f90 = factors;
  lobe.lowest = -ns.z;
  return lobe;
}

// A place on the ellipse, by the angle from y towards z that a circle of the same width has there.
template <class F> struct FibrePlace {
  F sine, cosine;        // of that angle
  F arc;                 // length of the ellipse per angle
  Vec3<F> normal, scale; // of the ellipse, and of the scale there
};

// sin_tilt: from outside that of the lobe, and its negative as seen from within, where sine and cosine are those of the
// opposite place, so that the normal points into the fibre.
template <class F> LANCER_LANE FibrePlace<F> fibre_place(const Lobe<F> &lobe, F sine, F cosine, F sin_tilt) {
  const F zero(0.0f), across = lobe.alpha_y * sine, arc = sqrt(across * across + cosine * cosine);
  const MaskOf<F> round = arc > zero; // else the end of a flat ellipse
  const F y = select(round, cosine / arc, zero), z = select(round, across / arc, sine);
  return {sine, cosine, arc, {zero, y, z}, {sin_tilt, lobe.b.y * y, lobe.b.y * z}};
}

// The way of light through the fibre from a place, along w or against it.
template <class F> struct Chord {
  F sine, cosine; // of the angle at its end, half a turn on for light that enters
  F length;
};
template <class F> LANCER_LANE Chord<F> chord(const Lobe<F> &lobe, const FibrePlace<F> &from, const Vec3<F> &w) {
  // Scaled to a circle, a chord ends where the direction mirrors its start.
  const F z = lobe.alpha_y * w.z, scaled = sqrt(z * z + w.y * w.y), rise = sqrt(w.y * w.y + w.z * w.z);
  const MaskOf<F> crosses = scaled > F(0.0f);
  const F sine = select(crosses, z / scaled, from.sine), cosine = select(crosses, w.y / scaled, from.cosine);
  const F along = sine * from.sine + cosine * from.cosine, y = lobe.alpha_y * cosine;
  return {2.0f * along * sine - from.sine, 2.0f * along * cosine - from.cosine,
          2.0f * abs(along) * sqrt(sine * sine + y * y) / max(rise, F(1e-6f))};
}
template <class F> LANCER_LANE Vec3<F> faded_along(const Lobe<F> &lobe, F length) {
  return {exp(-lobe.f0.x * length), exp(-lobe.f0.y * length), exp(-lobe.f0.z * length)};
}

// The facets of scales, of GGX.

template <class F> LANCER_LANE F huang_lambda(const Lobe<F> &lobe, F cosine) {
  const F tan2 = max((1.0f - cosine) * (1.0f + cosine) / (cosine * cosine), F(0.0f));
  return 0.5f * (sqrt(1.0f + lobe.alpha_x * lobe.alpha_x * tan2) - 1.0f);
}
// Returns the share of facets visible from both directions, and that among those visible from the first. cos_i, cos_o: cosines
// to the scale.
template <class F> LANCER_LANE F both_seen(const Lobe<F> &lobe, F cos_i, F cos_o) {
  return 1.0f / (1.0f + huang_lambda(lobe, cos_i) + huang_lambda(lobe, cos_o));
}
template <class F> LANCER_LANE F second_seen(const Lobe<F> &lobe, F cos_i, F cos_o) {
  const F first = 1.0f + huang_lambda(lobe, cos_i);
  return first / (first + huang_lambda(lobe, cos_o));
}
// A sum of squares loses no digit for small roughness.
template <class F> LANCER_LANE F huang_d(const Lobe<F> &lobe, const Vec3<F> &scale, const Vec3<F> &h) {
  const Vec3<F> aside = cross(scale, h);
  const F cosine = dot(scale, h), alpha2 = lobe.alpha_x * lobe.alpha_x,
          length2 = dot(aside, aside) + alpha2 * (cosine * cosine);
  return kInvPi * alpha2 / (length2 * length2);
}
template <class F> LANCER_LANE Vec3<F> visible_facet(const Lobe<F> &lobe, const Vec3<F> &w, const Vec3<F> &scale, F u, F v) {
  const Frame<F> frame(scale);
  return frame.to_world(ggx_sample_visible(frame.to_local(w), lobe.alpha_x, lobe.alpha_x, u, v));
}
// Returns the factor that adds multiple scattering between facets, as of glass. ior: as seen from the side of the cosine.
template <class F> LANCER_LANE F huang_energy(const Lobe<F> &lobe, F cosine, F ior) {
  return 1.0f / glass_albedo(sqrt(lobe.alpha_x), cosine, ior);
}

template <class V> LANCER_LANE auto are_above(const V &w, const V &n, const V &h) {
  return (dot(w, h) > 0.0f) & (dot(w, n) > 0.0f);
}
// Whether a direction sees a facet at a place: from above the facet, its scale, and the ellipse.
template <class F> LANCER_LANE MaskOf<F> sees(const Vec3<F> &w, const FibrePlace<F> &place, const Vec3<F> &h) {
  return are_above(w, place.normal, h) & (dot(w, place.scale) > 0.0f);
}

// Refracts at a facet seen from w; beyond: index there over that of w's side. Points away from w.
template <class F> LANCER_LANE Vec3<F> refract_at(const Vec3<F> &w, const Vec3<F> &h, F beyond, F cos_t) {
  return normalize((dot(w, h) / beyond - cos_t) * h - w / beyond);
}

// Light that enters at a facet of a place, and goes on to the second one.
template <class F> struct FibreEntry {
  Vec3<F> h, t; // the facet, and the direction within
  F reflected, transmitted;
  FibrePlace<F> second;
  Vec3<F> faded; // share of light that reaches the second place
};
template <class F>
LANCER_LANE FibreEntry<F> enter_fibre(const Lobe<F> &lobe, const Vec3<F> &wo, const FibrePlace<F> &first, F u, F v) {
  FibreEntry<F> r;
  r.h = visible_facet(lobe, wo, first.scale, u, v);
  const Fresnel<F> boundary = fresnel(dot(wo, r.h), lobe.ior);
  r.reflected = boundary.reflectance;
  r.transmitted = boundary.transmittance;
  r.t = refract_at(wo, r.h, lobe.ior, boundary.cos_t);
  const Chord<F> way = chord(lobe, first, r.t);
  r.second = fibre_place(lobe, way.sine, way.cosine, -lobe.b.x);
  r.faded = faded_along(lobe, way.length);
  return r;
}

// Light that a facet of the second place reflects to the third.
template <class F> struct FibreBounce {
  Vec3<F> h, back; // the facet, and the way back from the third place
  Fresnel<F> boundary;
  FibrePlace<F> third;
  Vec3<F> faded;
};
template <class F> LANCER_LANE FibreBounce<F> bounce_within(const Lobe<F> &lobe, const FibreEntry<F> &entry, F u, F v) {
  FibreBounce<F> r;
  r.h = visible_facet(lobe, -entry.t, entry.second.scale, u, v);
  r.boundary = fresnel(-dot(entry.t, r.h), 1.0f / lobe.ior);
  r.back = reflect_about(entry.t, r.h);
  const Chord<F> way = chord(lobe, entry.second, r.back);
  r.third = fibre_place(lobe, -way.sine, -way.cosine, -lobe.b.x);
  r.faded = faded_along(lobe, way.length);
  return r;
}

// The passes' colour, as Cycles estimates it: that of a smooth round fibre.
template <class F> LANCER_LANE Vec3<F> huang_albedo(const Lobe<F> &lobe, const Vec3<F> &wo) {
  const F h = lobe.lowest;
  const Fresnel<F> boundary = fresnel(abs(wo.y * cosine_of(h) + wo.z * h), lobe.ior);
  const F f = boundary.reflectance, sine = wo.x / lobe.ior;
  const Vec3<F> left = faded_along(lobe, 2.0f * boundary.cos_t / max(cosine_of(sine) * cosine_of(sine), F(1e-6f)));
  const auto share = [&](F a) __attribute__((always_inline)) { return quotient(a - 2.0f * f * a + f, 1.0f - f * a); };
  return lobe.color * Vec3<F>(share(left.x), share(left.y), share(left.z));
}

} // namespace lancer
