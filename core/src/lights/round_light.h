// Point and spot lights: a true point, a disk that faces the shaded point, or a ball.
#pragma once

#include "lights/light.h"
#include "sampling/warp.h"

#include <numbers>

namespace lancer {

// Returns the share of the intensity that a spot sends towards -wi: 0 outside the cone, a smooth step over its blended rim.
// With spot_cosine it is multiplied by the cosine to the axis.
template <template <class> class L, class F>
LANCER_LANE DoubleOf<F> spot_attenuation(const L<F> &light, const Double3Of<F> &wi, MaskOf<F> spot) {
  using D = DoubleOf<F>;
  const D one(1.0), zero(0.0);
  if (!any(spot))
    return one;
  D cosine = dot(wi, light[&Light::z]);
  const MaskOf<F> stretched = light[&Light::stretched];
  if (any(stretched & spot)) {
    // Map the direction to a space in which the cone is round.
    const D x = dot(wi, light[&Light::x]) / light[&Light::stretch_x], y = dot(wi, light[&Light::y]) / light[&Light::stretch_y];
    cosine = select(stretched, cosine / sqrt(x * x + y * y + cosine * cosine), cosine);
  }
  const D inside = cosine - light[&Light::cos_half_angle], blend = light[&Light::blend_width];
  const D tilted = select(light[&Light::spot_cosine], max(cosine, zero), one);
  const D t = inside / blend;
  const D value = select(inside >= blend, tilted, tilted * t * t * (D(3.0) - D(2.0) * t));
  return select(spot, select(inside > zero, value, zero), one);
}

// Whether a disk is smaller than the rounding of a float direction. Such a disk is sampled as a point: the radiance of a
// smaller disk would exceed the range of float.
template <class D> LANCER_LANE auto is_true_point(D radius, D distance) { return radius <= distance * D(0x1p-24); }

// Unit vectors that complete unit n to a right-handed frame (Duff et al. 2017).
template <class D> struct FrameAxes { Vector3<D> s, t; };
template <class D> LANCER_LANE FrameAxes<D> complete_frame(const Vector3<D> &n) {
  const D one(1.0), side = sign(n.z), a = D(-1.0) / (side + n.z), b = n.x * n.y * a;
  return {{one + side * n.x * n.x * a, side * b, -side * n.x}, {b, side + n.y * n.y * a, -n.y}};
}

// Returns 1 - cos of the half angle of a ball, without cancellation (core/README.md, "Numerics").
template <class D> LANCER_LANE D one_minus_cos_ball(D radius, D distance) {
  const D ratio = radius / distance, sin2 = ratio * ratio;
  const D cos2 = (distance - radius) * (distance + radius) / (distance * distance);
  return sin2 / (D(1.0) + sqrt(max(D(0.0), cos2)));
}

// Maps a point of the unit disk to a uniform direction around the unit axis with 1 - cos <= cone; the map is continuous.
template <class D>
LANCER_LANE Vector3<D> cone_direction(const Vector3<D> &axis, const FrameAxes<D> &frame, D cone, const Vector2<D> &disk) {
  const D one(1.0), r2 = min(one, disk.x * disk.x + disk.y * disk.y), x = r2 * cone;
  // sin^2 = x (2 - x), along the direction of the disk point.
  const D spread = sqrt(cone * (D(2.0) - x));
  return normalize((one - x) * axis + disk.x * spread * frame.s + disk.y * spread * frame.t);
}

// Returns half the length of a chord whose distance from the ball's centre is closest.
template <class D> LANCER_LANE D half_chord(D radius, D closest) {
  return sqrt(max(D(0.0), (radius - closest) * (radius + closest)));
}
template <class D> LANCER_LANE D length_of(const Vector3<D> &v) { return sqrt(dot(v, v)); }

// Returns the density of directions to a ball; inside the ball it is uniform over the sphere.
template <class D, class M> LANCER_LANE D ball_pdf(D cone, M inside) {
  return select(inside, D(0.25 * std::numbers::inv_pi), D(1.0) / (D(2.0 * std::numbers::pi) * cone));
}
template <class D> LANCER_LANE D disk_pdf(D t, D cosine, D radius) {
  return t * t / (cosine * D(std::numbers::pi) * radius * radius);
}

template <template <class> class L, class F>
LANCER_LANE void sample_round(const L<F> &light, const Double3Of<F> &p, F u, F v, const Vector2<F> &warped, MaskOf<F> which,
                              MaskOf<F> spot, LightSampleLanes<F> &sample) {
  using D = DoubleOf<F>;
  using D3 = Double3Of<F>;
  using M = MaskOf<F>;
  const D one(1.0), radius = light[&Light::radius];
  const D3 position = light[&Light::position], to_light = position - p;
  const D distance = length_of(to_light);
  const D3 axis = to_light / distance;
  const M point = which & is_true_point(radius, distance), soft = light[&Light::soft_falloff];
  const M disk = which & soft & !point, ball = which & !soft & !point, inside = ball & !(distance > radius);
  D3 target = position, wi = axis;
  D length = distance, pdf = one;
  const FrameAxes<D> frame = complete_frame(axis);
  const Vector2<D> place{widen(warped.x), widen(warped.y)};
  if (any(disk)) {
    // Take a uniform point of the disk whose axis runs through p.
    const D3 at = position + place.x * radius * frame.s + place.y * radius * frame.t, to = at - p;
    const D t = length_of(to);
    const D3 direction = to / t;
    target = select(disk, at, target);
    wi = select(disk, direction, wi);
    length = select(disk, t, length);
    // Convert the density from area to solid angle.
    pdf = select(disk, disk_pdf(t, dot(direction, axis), radius), pdf);
  }
  if (any(ball)) {
    // Take a uniform direction of the cone that the ball subtends; the middle of the unit square maps to the cone's axis.
    // Inside the ball, directions are uniform over the sphere.
    const D cone = one_minus_cos_ball(radius, distance);
    D3 direction = cone_direction(axis, frame, cone, place);
    if (any(inside))
      direction = select(inside, widen(warp_sphere(u, v)), direction);
    // End on the ball's surface: on its near side from outside, on its far side from inside.
    const D along = dot(to_light, direction), half = half_chord(radius, length_of(along * direction - to_light));
    const D reach = select(inside, along + half, max(along - half, D(0.5) * along));
    target = select(ball, p + reach * direction, target);
    wi = select(ball, direction, wi);
    length = select(ball, reach, length);
    pdf = select(ball, ball_pdf(cone, inside), pdf);
  }
  const D attenuation = select(inside, one, spot_attenuation(light, wi, spot & which));
  // Divide the intensity by the squared distance for a point, otherwise by the projected area. Inside the ball, ignore a spot's
  // cone.
  const D per_area = attenuation / select(point, distance * distance, D(std::numbers::pi) * radius * radius);
  sample.target = select(which, target, sample.target);
  sample.wi = select(which, wi, sample.wi);
  sample.distance = select(which, length, sample.distance);
  sample.radiance = select(which, narrow(light[&Light::emission] * per_area), sample.radiance);
  sample.pdf = select(which & (distance > D(0.0)), pdf, sample.pdf);
  sample.delta = sample.delta | point;
}

// The places where rays from o along unit wi hit the disk that faces o, or the ball: its near side from outside, its far side
// from inside.
template <class F> struct RoundMeeting {
  MaskOf<F> met, inside;
  DoubleOf<F> distance; // of the centre
  DoubleOf<F> cosine;   // of disks
  DoubleOf<F> t;
};
template <template <class> class L, class F>
LANCER_LANE RoundMeeting<F> find_round(const L<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi) {
  using D = DoubleOf<F>;
  using M = MaskOf<F>;
  const D zero(0.0), radius = light[&Light::radius];
  const Double3Of<F> to_light = light[&Light::position] - o;
  const D distance = length_of(to_light), along = dot(to_light, wi), cosine = along / distance;
  const M able = (distance > zero) & !is_true_point(radius, distance), soft = light[&Light::soft_falloff];
  const M ball = !soft, inside = ball & (distance <= radius);
  RoundMeeting<F> at{able, inside, distance, cosine, distance / cosine};
  const Double3Of<F> closest = select(soft, at.t, along) * wi - to_light;
  const D miss = length_of(closest);
  at.met = able & ((soft & (cosine > zero) & (miss <= radius)) | inside | (ball & (along > zero) & (miss < radius)));
  if (any(ball)) {
    const D half = half_chord(radius, miss);
    at.t = select(soft, at.t, select(inside, along + half, along - half));
  }
  return at;
}

template <template <class> class L, class F>
LANCER_LANE LightHitLanes<F> meet_round(const L<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi, MaskOf<F> spot) {
  using D = DoubleOf<F>;
  const RoundMeeting<F> at = find_round(light, o, wi);
  const D one(1.0), radius = light[&Light::radius];
  const D pdf = select(light[&Light::soft_falloff], disk_pdf(at.t, at.cosine, radius),
                       ball_pdf(one_minus_cos_ball(radius, at.distance), at.inside));
  const D attenuation = select(at.inside, one, spot_attenuation(light, wi, spot));
  const D per_area = attenuation / (D(std::numbers::pi) * radius * radius);
  return {narrow(light[&Light::emission] * per_area), select(at.met, pdf, D(0.0)), at.t};
}

} // namespace lancer
