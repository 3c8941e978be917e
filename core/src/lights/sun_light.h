// A sun: parallel light, or a disk of the sky.
#pragma once

#include "lights/point_light.h"

namespace lancer {

// Radiance that gives the sun's irradiance at normal incidence: E = pi L sin^2(half angle).
inline glm::vec3 sun_radiance(const Light &light) {
  const double x = light.one_minus_cos_sun, sin2 = x * (2.0 - x);
  return glm::vec3(light.emission / (glm::pi<double>() * sin2));
}

inline LightSample sample_sun(const Light &light, const glm::vec2 &u) {
  LightSample sample;
  sample.distance = std::numeric_limits<double>::infinity();
  if (light.one_minus_cos_sun == 0.0) {
    sample.wi = light.z;
    sample.radiance = glm::vec3(light.emission);
    sample.pdf = 1.0;
    sample.delta = true;
    return sample;
  }
  sample.wi = cone_direction(light.z, light.x, light.y, light.one_minus_cos_sun, u);
  sample.radiance = sun_radiance(light);
  sample.pdf = 1.0 / (glm::two_pi<double>() * light.one_minus_cos_sun);
  return sample;
}

inline LightHit meet_sun(const Light &light, const glm::dvec3 &wi) {
  LightHit hit;
  // |wi - z|^2 = 2 (1 - cos): no cancellation however small the sun.
  const glm::dvec3 apart = wi - light.z;
  if (light.one_minus_cos_sun == 0.0 || !(0.5 * glm::dot(apart, apart) <= light.one_minus_cos_sun))
    return hit;
  hit.radiance = sun_radiance(light);
  hit.pdf = 1.0 / (glm::two_pi<double>() * light.one_minus_cos_sun);
  hit.distance = std::numeric_limits<double>::infinity();
  return hit;
}

} // namespace lancer
