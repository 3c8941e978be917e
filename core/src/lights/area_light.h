// Area lights: a rectangle or an ellipse that shines to its front.
#pragma once

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

inline LightSample sample_area(const Light &light, const glm::dvec3 &p, const glm::vec2 &u) {
  LightSample sample;
  if (!(light.area > 0.0))
    return sample;
  const glm::dvec2 d = light.ellipse ? glm::dvec2(warp_disk(u)) : 2.0 * glm::dvec2(u) - 1.0;
  sample.target = light.position + d.x * light.half_x * light.x + d.y * light.half_y * light.y;
  const glm::dvec3 v = sample.target - p;
  sample.distance = glm::length(v);
  if (!(sample.distance > 0.0))
    return sample;
  sample.wi = v / sample.distance;
  const double cosine = glm::dot(sample.wi, light.z);
  if (!(cosine > 0.0))
    return sample;
  sample.pdf = sample.distance * sample.distance / (cosine * light.area);
  sample.radiance = area_radiance(light, cosine);
  return sample;
}

inline LightHit meet_area(const Light &light, const glm::dvec3 &o, const glm::dvec3 &wi) {
  LightHit hit;
  const double cosine = glm::dot(wi, light.z), t = glm::dot(light.position - o, light.z) / cosine;
  if (!(cosine > 0.0) || !(t > 0.0) || !(light.area > 0.0))
    return hit;
  const glm::dvec3 at = o + t * wi - light.position;
  const double x = glm::dot(at, light.x) / light.half_x, y = glm::dot(at, light.y) / light.half_y;
  const bool inside = light.ellipse ? x * x + y * y <= 1.0 : std::abs(x) <= 1.0 && std::abs(y) <= 1.0;
  if (!inside)
    return hit;
  hit.radiance = area_radiance(light, cosine);
  hit.pdf = t * t / (cosine * light.area);
  hit.distance = t;
  return hit;
}

} // namespace lancer
