// A sun: parallel light, or a disk of the sky, even or flat.
#pragma once

#include "lights/point_light.h"

namespace lancer {

// The disk towards the direction whose cosine to the middle is given. The sun's irradiance is that at normal incidence.
struct SunDisk {
  glm::vec3 radiance{0.0f};
  double pdf = 0.0;
};

inline SunDisk sun_disk(const Light &light, double cosine) {
  if (light.flat_radius == 0.0) {
    // E = pi L sin^2(half angle).
    const double x = light.one_minus_cos_sun, sin2 = x * (2.0 - x);
    return {glm::vec3(light.emission / (glm::pi<double>() * sin2)), 1.0 / (glm::two_pi<double>() * x)};
  }
  // At distance 1 every part of the flat disk gives as much light as it is large: per solid angle 1 / cos^3. Its mean cosine
  // is 2 / (sqrt(1 + r^2) + 1).
  const double r2 = light.flat_radius * light.flat_radius;
  const double pdf = 1.0 / (glm::pi<double>() * r2 * cosine * cosine * cosine);
  return {glm::vec3(light.emission * (0.5 * (std::sqrt(1.0 + r2) + 1.0) * pdf)), pdf};
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
  if (light.flat_radius == 0.0) {
    sample.wi = cone_direction(light.z, light.x, light.y, light.one_minus_cos_sun, u);
  } else {
    const glm::dvec2 d = light.flat_radius * glm::dvec2(warp_disk(u));
    sample.wi = glm::normalize(light.z + d.x * light.x + d.y * light.y);
  }
  const SunDisk disk = sun_disk(light, glm::dot(sample.wi, light.z));
  sample.radiance = disk.radiance;
  sample.pdf = disk.pdf;
  return sample;
}

inline LightHit meet_sun(const Light &light, const glm::dvec3 &wi) {
  LightHit hit;
  // |wi - z|^2 = 2 (1 - cos): no cancellation however small the sun.
  const glm::dvec3 apart = wi - light.z;
  const double one_minus_cos = 0.5 * glm::dot(apart, apart);
  if (light.one_minus_cos_sun == 0.0 || !(one_minus_cos <= light.one_minus_cos_sun))
    return hit;
  const SunDisk disk = sun_disk(light, 1.0 - one_minus_cos);
  hit.radiance = disk.radiance;
  hit.pdf = disk.pdf;
  hit.distance = std::numeric_limits<double>::infinity();
  return hit;
}

} // namespace lancer
