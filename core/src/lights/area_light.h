// Area lights: a rectangle or an ellipse that shines to its front.
#pragma once

#include "lights/light_lanes.h"

namespace lancer {

// At grazing directions a way ends at most this many times Light::apart before the lamp: nothing visible stands in between.
inline constexpr double kMostAparts = 64.0;

// How long the way is that ends before the lamp, of one that is t long and meets its axis under this cosine: rounding then puts
// no face of the lamp's own plane, such as the ceiling that it is set into, before the lamp.
template <class D> LANCER_LANE D area_end(D t, D cosine, D apart) {
  return max(t - min(apart / cosine, D(kMostAparts) * apart), D(0.5) * t);
}

// Radiance towards a direction whose cosine with the light's axis is given; narrowed by spread like a honeycomb in front.
template <template <class> class L, class F>
LANCER_LANE Vector3<F> area_radiance(const L<F> &light, DoubleOf<F> cosine, MaskOf<F> which) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0), scale = light[&Light::spread_scale];
  const Double3Of<F> emission = light[&Light::emission];
  const MaskOf<F> narrowed = which & (scale != zero);
  if (!any(narrowed))
    return narrow(emission);
  const D tangent = sqrt(max(zero, (one - cosine) * (one + cosine))) / cosine;
  const D share = max(light[&Light::tan_half_spread] - tangent, zero) * scale;
  return select(narrowed, narrow(emission * share), narrow(emission));
}

// The part of an area light that is worth sampling from a point: where its spread lets light reach the point. A rectangle in
// units of the half lengths, or all of the ellipse.
template <class F> struct AreaPart {
  Vector2<DoubleOf<F>> low, high;
  MaskOf<F> ellipse;
  DoubleOf<F> area; // of it, normalised units; 0: nothing arrives
};

template <template <class> class L, class F>
LANCER_LANE AreaPart<F> area_part(const L<F> &light, const Double3Of<F> &p, MaskOf<F> which) {
  using D = DoubleOf<F>;
  const D zero(0.0), one(1.0), least(-1.0), whole = light[&Light::area];
  AreaPart<F> part{{least, least}, {one, one}, light[&Light::ellipse], whole};
  const MaskOf<F> narrowed = which & (light[&Light::spread_scale] != zero);
  if (!any(narrowed))
    return part;
  // Light arrives from within a circle around the foot of p.
  const Double3Of<F> v = p - light[&Light::position];
  const D radius = -dot(v, light[&Light::z]) * light[&Light::tan_half_spread];
  const D half_x = light[&Light::half_x], half_y = light[&Light::half_y];
  const D foot_x = dot(v, light[&Light::x]) / half_x, foot_y = dot(v, light[&Light::y]) / half_y;
  const D low_x = max(foot_x - radius / half_x, least), low_y = max(foot_y - radius / half_y, least);
  const D high_x = min(foot_x + radius / half_x, one), high_y = min(foot_y + radius / half_y, one);
  const D area = max(high_x - low_x, zero) * max(high_y - low_y, zero) * half_x * half_y;
  const MaskOf<F> smaller = narrowed & (area < whole);
  part.low = {select(smaller, low_x, part.low.x), select(smaller, low_y, part.low.y)};
  part.high = {select(smaller, high_x, part.high.x), select(smaller, high_y, part.high.y)};
  part.area = select(smaller, area, part.area);
  part.ellipse = part.ellipse & !smaller;
  return part;
}

// disk: warp_disk(u, v).
template <template <class> class L, class F>
LANCER_LANE void sample_area(const L<F> &light, const Double3Of<F> &p, F u, F v, const Vector2<F> &disk, MaskOf<F> which,
                             LightSampleLanes<F> &sample) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0), du = widen(u), dv = widen(v);
  const AreaPart<F> part = area_part(light, p, which);
  const D x = select(part.ellipse, widen(disk.x), part.low.x * (one - du) + part.high.x * du);
  const D y = select(part.ellipse, widen(disk.y), part.low.y * (one - dv) + part.high.y * dv);
  const Double3Of<F> axis_x = light[&Light::x], axis_y = light[&Light::y];
  const Double3Of<F> to_light =
      light[&Light::position] + x * light[&Light::half_x] * axis_x + y * light[&Light::half_y] * axis_y - p;
  const D distance = sqrt(dot(to_light, to_light));
  const Double3Of<F> wi = to_light / distance;
  const D cosine = dot(wi, light[&Light::z]);
  // A rectangle around what is lit of an ellipse may reach beyond it.
  const MaskOf<F> beside = light[&Light::ellipse] & !part.ellipse & !(x * x + y * y <= one);
  const MaskOf<F> valid = which & (part.area > zero) & (distance > zero) & (cosine > zero) & !beside;
  sample.target = select(which, p + area_end(distance, cosine, light[&Light::apart]) * wi, sample.target);
  sample.wi = select(which, wi, sample.wi);
  sample.distance = select(which, distance, sample.distance);
  sample.radiance = select(which, area_radiance(light, cosine, which), sample.radiance);
  sample.pdf = select(valid, distance * distance / (cosine * part.area), sample.pdf);
}

// Where ways from o along unit wi meet what sampling would choose of the light.
template <class F> struct AreaMeeting {
  MaskOf<F> met;
  DoubleOf<F> t, cosine, area;
};
template <template <class> class L, class F>
LANCER_LANE AreaMeeting<F> find_area(const L<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0);
  const Double3Of<F> position = light[&Light::position], z = light[&Light::z];
  const D cosine = dot(wi, z), t = dot(position - o, z) / cosine;
  const Double3Of<F> at = o + t * wi - position;
  const D x = dot(at, light[&Light::x]) / light[&Light::half_x], y = dot(at, light[&Light::y]) / light[&Light::half_y];
  const MaskOf<F> front = (cosine > zero) & (t > zero) & (light[&Light::area] > zero);
  const MaskOf<F> ellipse = light[&Light::ellipse];
  const MaskOf<F> on_rectangle = (abs(x) <= one) & (abs(y) <= one), on_ellipse = x * x + y * y <= one;
  const MaskOf<F> on = (ellipse & on_ellipse) | (on_rectangle & !ellipse);
  const AreaPart<F> part = area_part(light, o, front);
  const MaskOf<F> within = (part.low.x <= x) & (part.low.y <= y) & (x <= part.high.x) & (y <= part.high.y);
  const MaskOf<F> met = front & on & within;
  return {met, t, cosine, part.area};
}

template <template <class> class L, class F>
LANCER_LANE LightHitLanes<F> meet_area(const L<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi) {
  const AreaMeeting<F> at = find_area(light, o, wi);
  return {area_radiance(light, at.cosine, at.met), select(at.met, at.t * at.t / (at.cosine * at.area), DoubleOf<F>(0.0)),
          area_end(at.t, at.cosine, light[&Light::apart])};
}

} // namespace lancer
