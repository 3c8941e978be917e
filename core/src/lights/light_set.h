// All lights of a scene: which one to ask, and which ones a ray runs into.
#pragma once

#include "lights/emitter.h"
#include "lights/environment.h"
#include "lights/light_tree.h"

namespace lancer {

class LightSet {
public:
  LightSet() = default;
  // Lights as described come first, then one per emitting instance, then the environment where it varies. Throws
  // BuildCancelled.
  LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
           const BuildContext &context = {});

  size_t size() const { return lights_.size() + emitters_.size() + (environment_.is_light() ? 1 : 0); }
  bool empty() const { return size() == 0; }
  const std::vector<Light> &lights() const { return lights_; }
  const std::vector<Emitter> &emitters() const { return emitters_; }
  const Environment &environment() const { return environment_; }
  // Whether nothing of a light can arrive on this side of a surface; lamps and the environment are not looked at.
  bool behind(uint32_t light, const glm::dvec3 &p, const glm::vec3 &n) const {
    const size_t emitter = light - lights_.size();
    return emitter < emitters_.size() && emitters_[emitter].bounds().behind(p, glm::dvec3(n));
  }
  // Whether any surface shows light that is hidden from these rays.
  static bool lit_by(uint32_t hidden_from) {
    return (~hidden_from & (LANCER_RAY_DIFFUSE | LANCER_RAY_GLOSSY | LANCER_RAY_TRANSMISSION)) != 0;
  }
  // The environment's number among the lights; only where it varies.
  uint32_t environment_light() const { return uint32_t(lights_.size() + emitters_.size()); }
  // Bits LANCER_RAY_* of the rays that do not see a light, and whether nothing stands in its way.
  uint32_t hidden_from(uint32_t light) const { return switches_[light] & ~kNoShadow; }
  bool no_shadow(uint32_t light) const { return switches_[light] & kNoShadow; }

  struct Choice {
    uint32_t light = 0, face = 0; // face: of an emitter
    double probability = 0.0;     // 0: nothing to ask
  };
  // Chooses a light, and a face of it, by what the point may get from each. u in [0, 1); the set is not empty.
  Choice choose(const Geometry &geometry, const LightQuery &query, double u) const;
  // The same in two steps, for kernels that do the first: among the few, then, with what is left of u, within the one chosen.
  const BinaryLightTree &binary_tree() const { return binary_tree_; }
  // The one that stands for all of wide_tree() has the number size().
  const LightTree &wide_tree() const { return wide_tree_; }
  Choice choose_within(const Geometry &geometry, const LightQuery &query, LightChoice light) const;
  // Whether the second step changes nothing.
  bool decided(uint32_t few_number) const {
    return few_number < lights_.size() || (few_number >= lights_.size() + emitters_.size() && few_number < size());
  }
  // With which choose() returns this light; of an emitter, this face of it.
  double probability(const LightQuery &query, uint32_t light) const;
  double probability(const Geometry &geometry, const LightQuery &query, const Emitter &emitter, uint32_t face) const;

  // The emitter of an instance; null if it has none.
  const Emitter *emitter_of(uint32_t instance) const {
    return emitter_of_.empty() || emitter_of_[instance] == kNone ? nullptr : &emitters_[emitter_of_[instance]];
  }
  // Whether a ray can run into a light as described.
  bool any_on_the_way() const { return !always_.empty() || find_; }
  // How far before a lamp a way to it may end.
  double most_before() const { return most_before_; }
  // A few, each to be asked about every ray.
  const std::vector<uint32_t> &always_on_the_way() const { return always_; }
  // Whether there are others, which the tree of many finds.
  bool finds() const { return find_; }
  size_t bytes() const;

private:
  static constexpr uint32_t kNoShadow = 1u << 31;

  std::vector<Light> lights_;
  // hidden_from() and no_shadow() of all: asked for more lights than anything else, they stay in the cache.
  std::vector<uint32_t> switches_;
  std::vector<Emitter> emitters_;
  std::vector<uint32_t> always_, emitter_of_;
  // Few lights are chosen from as in Cycles; of many, those with a place are one of the few.
  BinaryLightTree binary_tree_;
  LightTree wide_tree_;
  bool find_ = false;
  double most_before_ = 0.0;
  Environment environment_;
};

} // namespace lancer
