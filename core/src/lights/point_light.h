// Point and spot lights: a true point, a disk that faces the shaded point, or a ball.
#pragma once

#include "lights/light.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace lancer {

// Share of the intensity that a spot sends towards -wi: 0 outside the cone, a smooth step over its blended rim; where asked
// for, it falls with the cosine to the axis too.
inline double spot_attenuation(const Light &light, const glm::dvec3 &wi) {
  if (light.kind != LightKind::Spot)
    return 1.0;
  double cosine = glm::dot(wi, light.z);
  if (light.stretch_x != 1.0 || light.stretch_y != 1.0) {
    // Look at the direction where the cone is round.
    const double x = glm::dot(wi, light.x) / light.stretch_x, y = glm::dot(wi, light.y) / light.stretch_y;
    cosine /= std::sqrt(x * x + y * y + cosine * cosine);
  }
  const double inside = cosine - light.cos_half_angle;
  if (!(inside > 0.0))
    return 0.0;
  const double tilted = light.spot_cosine ? std::max(cosine, 0.0) : 1.0;
  if (inside >= light.blend_width)
    return tilted;
  const double t = inside / light.blend_width;
  return tilted * t * t * (3.0 - 2.0 * t);
}

// A disk that is smaller than a float direction can tell is a point: its radiance would leave float's range before that.
inline bool is_true_point(const Light &light, double distance) { return light.radius <= distance * 0x1p-24; }

// Radiance of the disk or ball: intensity over its projected area. Within the ball there is no cone.
inline glm::vec3 round_radiance(const Light &light, const glm::dvec3 &wi, bool within = false) {
  const double scale = (within ? 1.0 : spot_attenuation(light, wi)) / (glm::pi<double>() * light.radius * light.radius);
  return glm::vec3(light.emission * scale);
}

// Any two unit vectors that complete unit n to a right-handed frame (Duff et al. 2017).
inline void complete_frame(const glm::dvec3 &n, glm::dvec3 &s, glm::dvec3 &t) {
  const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
  s = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  t = {b, sign + n.y * n.y * a, -n.y};
}

inline LightSample sample_true_point(const Light &light, const glm::dvec3 &to_light, double distance) {
  LightSample sample;
  sample.target = light.position;
  sample.wi = to_light / distance;
  sample.distance = distance;
  sample.radiance = glm::vec3(light.emission * (spot_attenuation(light, sample.wi) / (distance * distance)));
  sample.pdf = 1.0;
  sample.delta = true;
  return sample;
}

inline LightSample sample_disk(const Light &light, const glm::dvec3 &p, const glm::dvec3 &to_light, double distance,
                               const glm::vec2 &u) {
  // Take a uniform point of the disk whose axis runs through p.
  const glm::dvec3 axis = to_light / distance;
  glm::dvec3 s, t;
  complete_frame(axis, s, t);
  const glm::dvec2 d = glm::dvec2(warp_disk(u)) * light.radius;
  LightSample sample;
  sample.target = light.position + d.x * s + d.y * t;
  const glm::dvec3 v = sample.target - p;
  sample.distance = glm::length(v);
  sample.wi = v / sample.distance;
  // Turn area into solid angle.
  const double cosine = glm::dot(sample.wi, axis);
  sample.pdf = sample.distance * sample.distance / (cosine * glm::pi<double>() * light.radius * light.radius);
  sample.radiance = round_radiance(light, sample.wi);
  return sample;
}

// 1 - cos of the half angle of a ball, and cos^2 of it, without cancellation (numerics A.9).
inline double one_minus_cos_ball(double radius, double distance) {
  const double ratio = radius / distance, sin2 = ratio * ratio;
  const double cos2 = (distance - radius) * (distance + radius) / (distance * distance);
  return sin2 / (1.0 + std::sqrt(std::max(0.0, cos2)));
}

// A uniform direction around unit axis with 1 - cos <= cone: concentric, so that neighbours stay neighbours.
inline glm::dvec3 cone_direction(const glm::dvec3 &axis, const glm::dvec3 &s, const glm::dvec3 &t, double cone,
                                 const glm::vec2 &u) {
  const glm::dvec2 d(warp_disk(u));
  const double r2 = std::min(1.0, glm::dot(d, d)), x = r2 * cone;
  // sin^2 = x (2 - x), spread over the disk's own direction d / |d|.
  const glm::dvec2 across = d * std::sqrt(cone * (2.0 - x));
  return glm::normalize((1.0 - x) * axis + across.x * s + across.y * t);
}

inline LightSample sample_ball(const Light &light, const glm::dvec3 &to_light, double distance, const glm::vec2 &u,
                               const glm::dvec3 &p) {
  LightSample sample;
  if (distance <= light.radius) {
    // Inside the ball, light comes from everywhere.
    sample.wi = glm::dvec3(warp_sphere(u));
    sample.pdf = 0.25 * glm::one_over_pi<double>();
  } else {
    // Take a uniform direction of the cone that the ball fills; the middle of the square is its axis.
    const double cone = one_minus_cos_ball(light.radius, distance);
    const glm::dvec3 axis = to_light / distance;
    glm::dvec3 s, t;
    complete_frame(axis, s, t);
    sample.wi = cone_direction(axis, s, t, cone, u);
    sample.pdf = 1.0 / (glm::two_pi<double>() * cone);
  }
  // Go to the ball's surface: its near side from outside, its far side from inside.
  const double along = glm::dot(to_light, sample.wi);
  const glm::dvec3 closest = along * sample.wi - to_light;
  const double half = std::sqrt(std::max(0.0, (light.radius - glm::length(closest)) * (light.radius + glm::length(closest))));
  sample.distance = distance <= light.radius ? along + half : std::max(along - half, 0.5 * along);
  sample.target = p + sample.distance * sample.wi;
  sample.radiance = round_radiance(light, sample.wi, distance <= light.radius);
  return sample;
}

inline LightSample sample_point(const Light &light, const glm::dvec3 &p, const glm::vec2 &u) {
  const glm::dvec3 to_light = light.position - p;
  const double distance = glm::length(to_light);
  if (!(distance > 0.0))
    return {};
  if (is_true_point(light, distance))
    return sample_true_point(light, to_light, distance);
  if (light.soft_falloff)
    return sample_disk(light, p, to_light, distance, u);
  return sample_ball(light, to_light, distance, u, p);
}

inline LightHit meet_point(const Light &light, const glm::dvec3 &o, const glm::dvec3 &wi) {
  LightHit hit;
  const glm::dvec3 to_light = light.position - o;
  const double distance = glm::length(to_light), along = glm::dot(to_light, wi);
  if (!(distance > 0.0) || is_true_point(light, distance))
    return hit;
  if (light.soft_falloff) {
    // Meet the plane of the disk that faces o.
    const double cosine = along / distance, t = distance / cosine;
    if (!(cosine > 0.0) || !(glm::length(t * wi - to_light) <= light.radius))
      return hit;
    hit.pdf = t * t / (cosine * glm::pi<double>() * light.radius * light.radius);
    hit.distance = t;
  } else {
    // Meet the ball where sampling would: on its near side from outside, on its far side from inside.
    const double closest = glm::length(along * wi - to_light);
    const bool inside = distance <= light.radius;
    if (!inside && (!(along > 0.0) || !(closest < light.radius)))
      return hit;
    const double half = std::sqrt(std::max(0.0, (light.radius - closest) * (light.radius + closest)));
    hit.pdf =
        inside ? 0.25 * glm::one_over_pi<double>() : 1.0 / (glm::two_pi<double>() * one_minus_cos_ball(light.radius, distance));
    hit.distance = inside ? along + half : along - half;
  }
  hit.radiance = round_radiance(light, wi, !light.soft_falloff && distance <= light.radius);
  return hit;
}

} // namespace lancer
