// Area lights: a rectangle or an ellipse that emits to its front side.
#pragma once

#include "lights/light_lanes.h"
#include "sampling/spherical_rectangle.h"

namespace lancer {

// Largest distance before the lamp at which a shadow ray may end, in units of Light::plane_tolerance. At grazing angles this
// bound keeps the gap small enough that it hides no visible occluder.
inline constexpr double kMostTolerances = 64.0;

// Returns the length of a shadow ray towards a lamp at distance t. cosine: between the ray and the lamp's axis. The ray ends so
// far before the lamp that a face in the lamp's own plane, such as the ceiling around it, does not occlude the lamp by
// rounding.
template <class D> LANCER_LANE D area_end(D t, D cosine, D plane_tolerance) {
  return max(t - min(plane_tolerance / cosine, D(kMostTolerances) * plane_tolerance), D(0.5) * t);
}

// The members of area lights that the formulas read, each loaded once.
template <class F> struct AreaNumbers {
  using D = DoubleOf<F>;
  Double3Of<F> position, x, y, z, emission;
  D half_x, half_y, area, tan_half_spread, spread_scale, plane_tolerance;
  MaskOf<F> ellipse, narrowed;

  // which: the lanes whose light is an area light.
  template <class Lights>
  LANCER_LANE AreaNumbers(const Lights &light, MaskOf<F> which)
      : position(light[&Light::position]), x(light[&Light::x]), y(light[&Light::y]), z(light[&Light::z]),
        emission(light[&Light::emission]), half_x(light[&Light::half_x]), half_y(light[&Light::half_y]),
        area(light[&Light::area]), tan_half_spread(light[&Light::tan_half_spread]), spread_scale(light[&Light::spread_scale]),
        plane_tolerance(light[&Light::plane_tolerance]), ellipse(light[&Light::ellipse]),
        narrowed(which & (spread_scale != D(0.0))) {}
};

// Returns the radiance towards a direction whose cosine with the light's axis is given. The spread narrows the light like a
// honeycomb grid in front of it.
template <class F> LANCER_LANE Vector3<F> area_radiance(const AreaNumbers<F> &light, DoubleOf<F> cosine) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0);
  const Vector3<F> whole = narrow(light.emission);
  if (!any(light.narrowed))
    return whole;
  const D tangent = sqrt(max(zero, (one - cosine) * (one + cosine))) / cosine;
  const D share = max(light.tan_half_spread - tangent, zero) * light.spread_scale;
  return select(light.narrowed, narrow(light.emission * share), whole);
}

// The part of an area light from which light reaches a point within the spread; only this part is sampled. low and high bound a
// rectangle in units of the half lengths; an ellipse is sampled whole.
template <class F> struct AreaPart {
  Vector2<DoubleOf<F>> low, high;
  MaskOf<F> ellipse;
  DoubleOf<F> area; // of the part, in normalised units; 0: no light arrives
};

template <class F> LANCER_LANE AreaPart<F> area_part(const AreaNumbers<F> &light, const Double3Of<F> &p) {
  using D = DoubleOf<F>;
  const D zero(0.0), one(1.0), least(-1.0);
  AreaPart<F> part{{least, least}, {one, one}, light.ellipse, light.area};
  if (!any(light.narrowed))
    return part;
  // Light arrives from within a circle around the foot of the perpendicular from p.
  const Double3Of<F> v = p - light.position;
  const D radius = -dot(v, light.z) * light.tan_half_spread, half_x = light.half_x, half_y = light.half_y;
  const D foot_x = dot(v, light.x) / half_x, foot_y = dot(v, light.y) / half_y;
  const D low_x = max(foot_x - radius / half_x, least), low_y = max(foot_y - radius / half_y, least);
  const D high_x = min(foot_x + radius / half_x, one), high_y = min(foot_y + radius / half_y, one);
  const D area = max(high_x - low_x, zero) * max(high_y - low_y, zero) * half_x * half_y;
  const MaskOf<F> smaller = light.narrowed & (area < light.area);
  part.low = {select(smaller, low_x, part.low.x), select(smaller, low_y, part.low.y)};
  part.high = {select(smaller, high_x, part.high.x), select(smaller, high_y, part.high.y)};
  part.area = select(smaller, area, part.area);
  part.ellipse = part.ellipse & !smaller;
  return part;
}

// A lamp whose diagonal is below kLeastDiagonal times its distance is sampled uniformly in area: its distance and cosine vary
// little over it. The same holds for a lamp whose solid angle is below kLeastSolidAngle, where the computed solid angle is
// mostly rounding error.
inline constexpr double kLeastDiagonal = 1e-2, kLeastSolidAngle = 1e-9;

// A rectangle, or the part of it that is sampled, seen from a point.
template <class F> struct SeenArea {
  DoubleOf<F> x, y; // the lamp's middle along its axes, relative to the point
  SphericalRectangle<DoubleOf<F>> rectangle;
  MaskOf<F> by_angle; // lanes that sample by solid angle instead of area

  // Returns the density per solid angle. distance, cosine: to the sampled place, and there with the lamp's axis.
  LANCER_LANE DoubleOf<F> pdf(const DoubleOf<F> &distance, const DoubleOf<F> &cosine, const DoubleOf<F> &area) const {
    return select(by_angle, DoubleOf<F>(1.0) / rectangle.solid_angle, distance * distance / (cosine * area));
  }
};

template <class F>
LANCER_LANE SeenArea<F> see_area(const AreaNumbers<F> &light, const AreaPart<F> &part, const Double3Of<F> &p) {
  using D = DoubleOf<F>;
  const Double3Of<F> v = light.position - p;
  const D x = dot(v, light.x), y = dot(v, light.y), z = dot(v, light.z);
  const SphericalRectangle<D> rectangle({x + part.low.x * light.half_x, y + part.low.y * light.half_y},
                                        {x + part.high.x * light.half_x, y + part.high.y * light.half_y}, z);
  const D diagonal2 = D(4.0) * (light.half_x * light.half_x + light.half_y * light.half_y);
  const MaskOf<F> near = diagonal2 > D(kLeastDiagonal * kLeastDiagonal) * dot(v, v);
  const MaskOf<F> seen = (z > D(0.0)) & (rectangle.solid_angle > D(kLeastSolidAngle));
  return {x, y, rectangle, MaskOf<F>(near & seen & !part.ellipse)};
}

// disk: warp_disk(u, v).
template <class F>
LANCER_LANE void sample_area(const AreaNumbers<F> &light, const Double3Of<F> &p, F u, F v, const Vector2<F> &disk,
                             MaskOf<F> which, LightSampleLanes<F> &sample) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0), du = widen(u), dv = widen(v);
  const AreaPart<F> part = area_part(light, p);
  D x = select(part.ellipse, widen(disk.x), part.low.x * (one - du) + part.high.x * du);
  D y = select(part.ellipse, widen(disk.y), part.low.y * (one - dv) + part.high.y * dv);
  const SeenArea<F> seen = see_area(light, part, p);
  if (any(seen.by_angle)) {
    const Vector2<D> at = seen.rectangle.sample(du, dv);
    x = select(seen.by_angle, (at.x - seen.x) / light.half_x, x);
    y = select(seen.by_angle, (at.y - seen.y) / light.half_y, y);
  }
  const Double3Of<F> to_light = light.position + x * light.half_x * light.x + y * light.half_y * light.y - p;
  const D distance = sqrt(dot(to_light, to_light));
  const Double3Of<F> wi = to_light / distance;
  const D cosine = dot(wi, light.z);
  // The rectangle around the lit part of an ellipse may extend beyond the ellipse.
  const MaskOf<F> beside = light.ellipse & !part.ellipse & !(x * x + y * y <= one);
  const MaskOf<F> valid = which & (part.area > zero) & (distance > zero) & (cosine > zero) & !beside;
  sample.target = select(which, p + area_end(distance, cosine, light.plane_tolerance) * wi, sample.target);
  sample.wi = select(which, wi, sample.wi);
  sample.distance = select(which, distance, sample.distance);
  sample.radiance = select(which, area_radiance(light, cosine), sample.radiance);
  sample.pdf = select(valid, seen.pdf(distance, cosine, part.area), sample.pdf);
}

// The places where rays from o along unit wi hit the part of the light that sampling uses.
template <class F> struct AreaMeeting {
  MaskOf<F> met;
  DoubleOf<F> t, cosine;
  AreaPart<F> part;
};
template <class F>
LANCER_LANE AreaMeeting<F> find_area(const AreaNumbers<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0);
  const D cosine = dot(wi, light.z), t = dot(light.position - o, light.z) / cosine;
  const Double3Of<F> at = o + t * wi - light.position;
  const D x = dot(at, light.x) / light.half_x, y = dot(at, light.y) / light.half_y;
  const MaskOf<F> front = (cosine > zero) & (t > zero) & (light.area > zero);
  const MaskOf<F> on_rectangle = (abs(x) <= one) & (abs(y) <= one), on_ellipse = x * x + y * y <= one;
  const MaskOf<F> on = (light.ellipse & on_ellipse) | (on_rectangle & !light.ellipse);
  const AreaPart<F> part = area_part(light, o);
  const MaskOf<F> within = (part.low.x <= x) & (part.low.y <= y) & (x <= part.high.x) & (y <= part.high.y);
  const MaskOf<F> met = front & on & within;
  return {met, t, cosine, part};
}

template <class F>
LANCER_LANE LightHitLanes<F> meet_area(const AreaNumbers<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi) {
  const AreaMeeting<F> at = find_area(light, o, wi);
  const DoubleOf<F> pdf = see_area(light, at.part, o).pdf(at.t, at.cosine, at.part.area);
  return {area_radiance(light, at.cosine), select(at.met, pdf, DoubleOf<F>(0.0)),
          area_end(at.t, at.cosine, light.plane_tolerance)};
}

} // namespace lancer
