// All lights of a scene: which one to ask, and which ones a ray runs into.
#pragma once

#include "lights/emitter.h"
#include "lights/environment.h"
#include "lights/wide_lamp.h"

namespace lancer {

class LightSet {
public:
  LightSet() = default;
  // Lights as described come first, then one per emitting instance, then the environment where it varies. radius: of the
  // scene's bounds, normalised.
  LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
           double radius);

  size_t size() const { return lights_.size() + emitters_.size() + (environment_.varies() ? 1 : 0); }
  bool empty() const { return size() == 0; }
  const std::vector<Light> &lights() const { return lights_; }
  const std::vector<Emitter> &emitters() const { return emitters_; }
  const Environment &environment() const { return environment_; }
  // The environment's number among the lights; only where it varies.
  uint32_t environment_light() const { return uint32_t(lights_.size() + emitters_.size()); }
  // Bits LANCER_RAY_* of the rays that do not see a light, and whether nothing stands in its way.
  uint32_t hidden_from(uint32_t light) const;
  bool no_shadow(uint32_t light) const { return light < lights_.size() && lights_[light].no_shadow; }

  struct Choice {
    uint32_t light;
    double probability;
  };
  // Chooses a light by its power, mixed with an even choice so that no light is forgotten. The set is not empty.
  Choice choose(float u) const;
  double probability(uint32_t light) const { return choice_.size() > 0 ? double(choice_.pmf(light)) : 0.0; }

  // The numbers of a light for kernels that sample it; null where only the general code does.
  const WideLamp *wide_lamp(uint32_t light) const {
    return light < lights_.size() && lights_[light].kind != LightKind::Sun ? &wide_lamps_[light] : nullptr;
  }

  // The emitter of an instance, as a light's number; kNone if it has none.
  uint32_t emitter_light(uint32_t instance) const { return emitter_of_.empty() ? kNone : emitter_of_[instance]; }
  // Lights as described that a ray can run into.
  const std::vector<uint32_t> &with_extent() const { return with_extent_; }
  size_t bytes() const;

private:
  std::vector<Light> lights_;
  std::vector<WideLamp> wide_lamps_;
  std::vector<Emitter> emitters_;
  std::vector<uint32_t> with_extent_, emitter_of_;
  WeightedChoice choice_;
  Environment environment_;
};

} // namespace lancer
