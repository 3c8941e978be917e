// All lights of a scene: which one to ask, and which ones a ray runs into.
#pragma once

#include "lights/emitter.h"

namespace lancer {

class LightSet {
public:
  LightSet() = default;
  // Lights as described come first, then one per emitting instance. radius: of the scene's bounds, normalised.
  LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, const glm::vec3 &world,
           double radius);

  size_t size() const { return lights_.size() + emitters_.size(); }
  bool empty() const { return size() == 0; }
  const std::vector<Light> &lights() const { return lights_; }
  const std::vector<Emitter> &emitters() const { return emitters_; }
  // Radiance from beyond everything.
  const glm::vec3 &world() const { return world_; }

  struct Choice {
    uint32_t light;
    double probability;
  };
  // Chooses a light by its power, mixed with an even choice so that no light is forgotten. The set is not empty.
  Choice choose(float u) const;
  double probability(uint32_t light) const { return choice_.pmf(light); }

  // The emitter of an instance, as a light's number; kNone if it has none.
  uint32_t emitter_light(uint32_t instance) const { return emitter_of_.empty() ? kNone : emitter_of_[instance]; }
  // Lights as described that a ray can run into.
  const std::vector<uint32_t> &with_extent() const { return with_extent_; }
  size_t bytes() const;

private:
  std::vector<Light> lights_;
  std::vector<Emitter> emitters_;
  std::vector<uint32_t> with_extent_, emitter_of_;
  Distribution choice_;
  glm::vec3 world_{0.0f};
};

} // namespace lancer
