// Area lights: a rectangle or an ellipse that shines to its front.
#pragma once

#include "lights/area_end.h"
#include "lights/light.h"
#include "sampling/warp.h"

#include <cmath>

namespace lancer {

// Radiance towards a direction whose cosine with the light's axis is given; narrowed by spread like a honeycomb in front.
inline glm::vec3 area_radiance(const Light &light, double cosine) {
  if (light.spread_scale == 0.0)
    return glm::vec3(light.emission);
  const double tangent = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine))) / cosine;
  return glm::vec3(light.emission * (std::max(light.tan_half_spread - tangent, 0.0) * light.spread_scale));
}

// The part of an area light that is worth sampling from a point: where its spread lets light reach the point. A rectangle in
// units of the half lengths, or all of the ellipse.
struct AreaPart {
  glm::dvec2 low{-1.0}, high{1.0};
  bool ellipse = false;
  double area = 0.0; // of it, normalised units; 0: nothing arrives
};

inline AreaPart area_part(const Light &light, const glm::dvec3 &p) {
  AreaPart part;
  part.ellipse = light.ellipse;
  part.area = light.area;
  if (light.spread_scale == 0.0)
    return part;
  // Light arrives from within a circle around the foot of p.
  const glm::dvec3 v = p - light.position;
  const double radius = -glm::dot(v, light.z) * light.tan_half_spread;
  const glm::dvec2 half(light.half_x, light.half_y), foot = glm::dvec2(glm::dot(v, light.x), glm::dot(v, light.y)) / half;
  const glm::dvec2 low = glm::max(foot - radius / half, -1.0), high = glm::min(foot + radius / half, 1.0);
  const double area = glm::max(high.x - low.x, 0.0) * glm::max(high.y - low.y, 0.0) * half.x * half.y;
  if (!(area < light.area))
    return part;
  return {low, high, false, area};
}

inline bool on_area(const Light &light, double x, double y) {
  return light.ellipse ? x * x + y * y <= 1.0 : std::abs(x) <= 1.0 && std::abs(y) <= 1.0;
}

inline LightSample sample_area(const Light &light, const glm::dvec3 &p, const glm::vec2 &u) {
  LightSample sample;
  const AreaPart part = area_part(light, p);
  if (!(part.area > 0.0))
    return sample;
  const glm::dvec2 d = part.ellipse ? glm::dvec2(warp_disk(u)) : glm::mix(part.low, part.high, glm::dvec2(u));
  const glm::dvec3 at = light.position + d.x * light.half_x * light.x + d.y * light.half_y * light.y, v = at - p;
  sample.distance = glm::length(v);
  if (!(sample.distance > 0.0))
    return sample;
  sample.wi = v / sample.distance;
  const double cosine = glm::dot(sample.wi, light.z);
  if (!(cosine > 0.0) || (light.ellipse && !part.ellipse && !on_area(light, d.x, d.y)))
    return sample;
  sample.target = p + area_end(sample.distance, cosine, light.apart) * sample.wi;
  sample.pdf = sample.distance * sample.distance / (cosine * part.area);
  sample.radiance = area_radiance(light, cosine);
  return sample;
}

inline LightHit meet_area(const Light &light, const glm::dvec3 &o, const glm::dvec3 &wi) {
  LightHit hit;
  const double cosine = glm::dot(wi, light.z), t = glm::dot(light.position - o, light.z) / cosine;
  if (!(cosine > 0.0) || !(t > 0.0) || !(light.area > 0.0))
    return hit;
  const glm::dvec3 at = o + t * wi - light.position;
  const glm::dvec2 d(glm::dot(at, light.x) / light.half_x, glm::dot(at, light.y) / light.half_y);
  const AreaPart part = area_part(light, o);
  const bool inside = glm::all(glm::lessThanEqual(part.low, d)) && glm::all(glm::lessThanEqual(d, part.high));
  if (!on_area(light, d.x, d.y) || !inside)
    return hit;
  hit.radiance = area_radiance(light, cosine);
  hit.pdf = t * t / (cosine * part.area);
  hit.distance = area_end(t, cosine, light.apart);
  return hit;
}

} // namespace lancer
