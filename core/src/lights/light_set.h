// All lights of a scene: the choice of a light to sample, and the lights that a ray may hit.
#pragma once

#include "lights/emission.h"
#include "lights/environment.h"
#include "lights/light_tree.h"

namespace lancer {

class LightSet {
public:
  LightSet() = default;
  // Described lights come first, then one light per emitting instance, then the environment where Environment::is_light().
  // Throws BuildCancelled.
  LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
           const BuildContext &context = {});

  size_t size() const { return lamps_.size() + emitters_.size() + (environment_.is_light() ? 1 : 0); }
  bool empty() const { return size() == 0; }
  const std::vector<Light> &lamps() const { return lamps_; }
  const std::vector<Emitter> &emitters() const { return emitters_; }
  const Environment &environment() const { return environment_; }
  // Whether no light of an emitter can arrive on this side of a surface; returns false for lamps and the environment.
  bool behind(uint32_t light, const glm::dvec3 &p, const glm::vec3 &n) const {
    const size_t emitter = light - lamps_.size();
    return emitter < emitters_.size() && emitters_[emitter].bounds().behind(p, glm::dvec3(n));
  }
  // Whether a light that is hidden from these rays still lights some surface.
  static bool lit_by(uint32_t hidden_from) {
    return (~hidden_from & (RayKind::Diffuse | RayKind::Glossy | RayKind::Transmission)) != 0;
  }
  // The environment's number among the lights; valid only where the environment is a light.
  uint32_t environment_light() const { return uint32_t(lamps_.size() + emitters_.size()); }
  // Return the RayKind bits of the rays that do not see a light, and whether nothing occludes it.
  uint32_t hidden_from(uint32_t light) const { return switches_[light] & ~kNoShadow; }
  bool no_shadow(uint32_t light) const { return switches_[light] & kNoShadow; }
  // Returns the group of a light, 1 being the first; 0 = none.
  uint32_t group_of(const GeometryView &geometry, uint32_t light) const {
    if (light < lamps_.size())
      return lamps_[light].light_group;
    const size_t emitter = light - lamps_.size();
    return emitter < emitters_.size() ? geometry.instances[emitters_[emitter].instance()].light_group
                                      : environment_.light_group();
  }

  // The choice of a light is one in the binary tree, then one within the light that this step returns.
  const BinaryLightTree &binary_tree() const { return binary_tree_; }
  // In the binary tree, the light number size() represents all lights of wide_tree().
  const LightTree &wide_tree() const { return wide_tree_; }
  // Return the probability with which the choice returns this light, or at a time this face of an emitter.
  double probability(const LightQuery &query, uint32_t light) const;
  double probability(const GeometryView &geometry, const LightQuery &query, const Emitter &emitter, float time,
                     uint32_t face) const;

  // Returns the emitter of an instance; null if the instance has none.
  const Emitter *emitter_of(uint32_t instance) const {
    return emitter_of_.empty() || emitter_of_[instance] == kNone ? nullptr : &emitters_[emitter_of_[instance]];
  }
  // Whether a ray can hit a described light.
  bool any_on_the_way() const { return !always_.empty() || find_; }
  // Returns the largest distance before a lamp at which a shadow ray may end.
  double most_before() const { return most_before_; }
  // A few lights, each of which is tested against every ray.
  const std::vector<uint32_t> &always_on_the_way() const { return always_; }
  // Whether there are other lights that a ray may hit, which wide_tree() finds.
  bool finds() const { return find_; }
  size_t bytes() const;

private:
  static constexpr uint32_t kNoShadow = 1u << 31;

  std::vector<Light> lamps_;
  // hidden_from() and no_shadow() of all lights. These bits are read more often than the lights' other members; an array of
  // their own stays in the cache.
  std::vector<uint32_t> switches_;
  std::vector<Emitter> emitters_;
  std::vector<uint32_t> always_, emitter_of_;
  // A few lights are all in binary_tree_ and are chosen as in Cycles. If there are many, wide_tree_ contains all lights with a
  // position, and is one entry of binary_tree_.
  BinaryLightTree binary_tree_;
  LightTree wide_tree_;
  bool find_ = false;
  double most_before_ = 0.0;
  Environment environment_;
};

} // namespace lancer
