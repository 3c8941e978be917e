#include "lights/light_set.h"

#include "sampling/color.h"

#include <algorithm>

namespace lancer {

namespace {

// Rough power in normalised units: only the choice of lights depends on it, never the picture.
double power(const Light &light, double scene_radius) {
  constexpr double pi = glm::pi<double>();
  const double e = brightest(light.emission);
  switch (light.kind) {
  case LightKind::Point:
    return 4.0 * pi * e;
  case LightKind::Spot:
    return 2.0 * pi * (1.0 - light.cos_half_angle) * e;
  case LightKind::Sun:
    return pi * scene_radius * scene_radius * e;
  case LightKind::Area:
    return pi * light.area * e;
  }
  return 0.0;
}

void copy(const glm::dvec3 &from, double (&to)[3]) {
  for (int i = 0; i < 3; ++i)
    to[i] = from[i];
}

WideLamp make_wide(const Light &light) {
  WideLamp lamp;
  lamp.kind = uint32_t(light.kind);
  lamp.soft = light.soft_falloff;
  lamp.spot_cosine = light.spot_cosine;
  lamp.ellipse = light.ellipse;
  copy(light.position, lamp.position);
  copy(light.x, lamp.x);
  copy(light.y, lamp.y);
  copy(light.z, lamp.z);
  copy(light.emission, lamp.emission);
  lamp.radius = light.radius;
  lamp.cos_half_angle = light.cos_half_angle;
  lamp.blend_width = light.blend_width;
  lamp.stretch_x = light.stretch_x;
  lamp.stretch_y = light.stretch_y;
  lamp.half_x = light.half_x;
  lamp.half_y = light.half_y;
  lamp.area = light.area;
  lamp.tan_half_spread = light.tan_half_spread;
  lamp.spread_scale = light.spread_scale;
  return lamp;
}

} // namespace

LightSet::LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
                   double radius)
    : lights_(std::move(lights)), emitters_(std::move(emitters)), environment_(std::move(environment)) {
  std::vector<double> powers;
  for (const Light &light : lights_) {
    powers.push_back(power(light, radius));
    wide_lamps_.push_back(make_wide(light));
  }
  for (const Emitter &emitter : emitters_)
    powers.push_back(2.0 * glm::pi<double>() * emitter.weight());
  // Beyond the scene's bounds nothing is lit: what passes through their disk from all directions.
  if (environment_.varies())
    powers.push_back(4.0 * glm::pi<double>() * environment_.mean() * glm::pi<double>() * radius * radius);
  double total = 0.0;
  size_t shining = 0;
  for (double p : powers) {
    total += p;
    shining += p > 0.0;
  }
  // Half of the choice by power, half evenly among the lights that shine: power knows nothing of distance.
  if (total > 0.0) {
    for (double &p : powers)
      p = p > 0.0 ? 0.5 * p / total + 0.5 / double(shining) : 0.0;
    choice_ = WeightedChoice(powers);
  }
  // One that is never chosen is never met either: both techniques know the same lights.
  for (uint32_t i = 0; i < lights_.size(); ++i)
    if (has_extent(lights_[i]) && powers[i] > 0.0)
      with_extent_.push_back(i);
  if (!emitters_.empty()) {
    emitter_of_.assign(instance_count, kNone);
    for (uint32_t i = 0; i < emitters_.size(); ++i)
      emitter_of_[emitters_[i].instance()] = uint32_t(lights_.size()) + i;
  }
}

LightSet::Choice LightSet::choose(float u) const {
  const auto choice = choice_.sample(u);
  return {choice.index, double(choice.pmf)};
}

uint32_t LightSet::hidden_from(uint32_t light) const {
  if (light < lights_.size())
    return lights_[light].hidden_from;
  const size_t emitter = light - lights_.size();
  return emitter < emitters_.size() ? emitters_[emitter].hidden_from() : environment_.hidden_from();
}

size_t LightSet::bytes() const {
  size_t bytes =
      environment_.bytes() + lights_.size() * (sizeof(Light) + sizeof(WideLamp)) + emitter_of_.size() * sizeof(uint32_t);
  for (const Emitter &emitter : emitters_)
    bytes += sizeof(Emitter) + emitter.bytes();
  return bytes;
}

} // namespace lancer
