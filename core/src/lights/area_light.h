// Area lights: a rectangle, a parallelogram or an ellipse that emits to its front side.
#pragma once

#include "lights/light.h"
#include "sampling/warp.h"

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
  D half_x, half_y, skew, area, tan_half_spread, spread_scale, plane_tolerance;
  MaskOf<F> ellipse, narrowed, skewed;

  // which: the lanes whose light is an area light.
  template <class Lights>
  LANCER_LANE AreaNumbers(const Lights &light, MaskOf<F> which)
      : position(light[&Light::position]), x(light[&Light::x]), y(light[&Light::y]), z(light[&Light::z]),
        emission(light[&Light::emission]), half_x(light[&Light::half_x]), half_y(light[&Light::half_y]),
        skew(light[&Light::skew]), area(light[&Light::area]), tan_half_spread(light[&Light::tan_half_spread]),
        spread_scale(light[&Light::spread_scale]), plane_tolerance(light[&Light::plane_tolerance]),
        ellipse(light[&Light::ellipse]), narrowed(which & (spread_scale != D(0.0))), skewed(which & (skew != D(0.0))) {}

  // Returns the coordinates of the foot of the perpendicular from a point, along the sides of a parallelogram, in units of the
  // half lengths. v: from the middle to the point.
  LANCER_LANE Vector2<D> place(const Double3Of<F> &v) const {
    const D along = dot(v, x), b = dot(v, y) / half_y, a = along / half_x;
    return {any(skewed) ? select(skewed, (along - b * skew) / half_x, a) : a, b};
  }
  // Returns the offset along x of a place in those coordinates.
  LANCER_LANE D along_x(const Vector2<D> &at) const {
    const D along = at.x * half_x;
    return any(skewed) ? select(skewed, along + at.y * skew, along) : along;
  }
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
  const Vector2<D> foot = light.place(v);
  // The coordinate along x changes fastest perpendicular to the parallelogram's other side.
  const D lean = light.skew / half_y, reach_y = radius / half_y;
  const D reach_x = select(light.skewed, radius * sqrt(one + lean * lean) / half_x, radius / half_x);
  const D low_x = max(foot.x - reach_x, least), low_y = max(foot.y - reach_y, least);
  const D high_x = min(foot.x + reach_x, one), high_y = min(foot.y + reach_y, one);
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
// A parallelogram whose solid angle exceeds this bound fills the hemisphere up to rounding, where the directions of its
// triangles are undefined.
inline constexpr double kMostSolidAngle = 6.28;

// Returns the part of a parallelogram that is sampled, in the light's axes. v: from the point to the light's middle.
template <class F>
LANCER_LANE SphericalParallelogram<DoubleOf<F>> see_skewed(const AreaNumbers<F> &light, const AreaPart<F> &part,
                                                           const Double3Of<F> &v) {
  using D = DoubleOf<F>;
  const D zero(0.0), length_x = part.high.x - part.low.x, length_y = part.high.y - part.low.y;
  const Double3Of<F> corner(dot(v, light.x) + light.along_x(part.low), dot(v, light.y) + part.low.y * light.half_y,
                            dot(v, light.z));
  return {corner, Double3Of<F>(length_x * light.half_x, zero, zero),
          Double3Of<F>(length_y * light.skew, length_y * light.half_y, zero)};
}

// A rectangle, or the part of it that is sampled, seen from a point.
template <class F> struct SeenArea {
  DoubleOf<F> x, y; // the lamp's middle along its axes, relative to the point
  SphericalRectangle<DoubleOf<F>> rectangle;
  DoubleOf<F> solid_angle;
  MaskOf<F> by_angle; // lanes that sample by solid angle instead of area

  // Returns the density per solid angle. distance, cosine: to the sampled place, and there with the lamp's axis.
  LANCER_LANE DoubleOf<F> pdf(const DoubleOf<F> &distance, const DoubleOf<F> &cosine, const DoubleOf<F> &area) const {
    return select(by_angle, DoubleOf<F>(1.0) / solid_angle, distance * distance / (cosine * area));
  }
};

template <class F>
LANCER_LANE SeenArea<F> see_area(const AreaNumbers<F> &light, const AreaPart<F> &part, const Double3Of<F> &p) {
  using D = DoubleOf<F>;
  const Double3Of<F> v = light.position - p;
  const D x = dot(v, light.x), y = dot(v, light.y), z = dot(v, light.z);
  const SphericalRectangle<D> rectangle({x + part.low.x * light.half_x, y + part.low.y * light.half_y},
                                        {x + part.high.x * light.half_x, y + part.high.y * light.half_y}, z);
  D solid_angle = rectangle.solid_angle, widest = light.half_x;
  if (any(light.skewed)) {
    const D skewed_angle = see_skewed(light, part, v).solid_angle;
    solid_angle = select(light.skewed, select(skewed_angle < D(kMostSolidAngle), skewed_angle, D(0.0)), solid_angle);
    widest = select(light.skewed, light.half_x + abs(light.skew), widest);
  }
  const D diagonal2 = D(4.0) * (widest * widest + light.half_y * light.half_y);
  const MaskOf<F> near = diagonal2 > D(kLeastDiagonal * kLeastDiagonal) * dot(v, v);
  const MaskOf<F> seen = (z > D(0.0)) & (solid_angle > D(kLeastSolidAngle));
  return {x, y, rectangle, solid_angle, MaskOf<F>(near & seen & !part.ellipse)};
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
  const MaskOf<F> skewed_by_angle = seen.by_angle & light.skewed;
  if (any(skewed_by_angle)) {
    const Double3Of<F> middle = light.position - p, direction = see_skewed(light, part, middle).sample(du, dv);
    const D reach = dot(middle, light.z) / direction.z;
    const D b = (direction.y * reach - seen.y) / light.half_y,
            a = (direction.x * reach - seen.x - b * light.skew) / light.half_x;
    x = select(skewed_by_angle, min(max(a, part.low.x), part.high.x), x);
    y = select(skewed_by_angle, min(max(b, part.low.y), part.high.y), y);
  }
  const Double3Of<F> to_light = light.position + light.along_x({x, y}) * light.x + y * light.half_y * light.y - p;
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
  const auto [x, y] = light.place(at);
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
