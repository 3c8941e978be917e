// All lights of a scene: the choice of a light to sample, and the lights that a ray may hit.
#pragma once

#include "lights/emission.h"
#include "lights/environment.h"
#include "lights/light_tree.h"
#include "lights/openings.h"

namespace lancer {

// The choice among some lights: one in the tree of few, then, where it gives the number LightSet::size(), one in that of many.
struct LightTrees {
  BinaryLightTree few;
  LightTree many;

  double probability(const LightQuery &query, uint32_t light, uint32_t number_of_many) const;
};

class LightSet {
public:
  LightSet() = default;
  // Described lights come first, then one light per emitting instance, then the environment where Environment::is_light().
  // receiver_sets: bits of the sets of receivers that there are; openings: see Openings. Throws BuildCancelled.
  LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
           const BuildContext &context = {}, uint64_t receiver_sets = 1, std::vector<Light> openings = {});

  size_t size() const { return lamps_.size() + emitters_.size() + (environment_.is_light() ? 1 : 0); }
  bool empty() const { return size() == 0; }
  const std::vector<Light> &lamps() const { return lamps_; }
  const std::vector<Emitter> &emitters() const { return emitters_; }
  const Environment &environment() const { return environment_; }
  // Valid as long as the set is neither changed nor moved.
  Openings openings() const { return {openings_.data(), uint32_t(openings_.size())}; }
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

  // Whether a light gives no light samples after so many scatterings.
  bool is_spent(uint32_t light, uint32_t scatterings) const {
    return !lit_surfaces_.empty() && lit_surfaces_[light] != 0 && scatterings >= lit_surfaces_[light];
  }

  // The choice of a light is one in the binary tree, then one within the light that this step returns.
  const BinaryLightTree &binary_tree() const { return trees_.few; }
  // In the binary tree, the light number size() represents all lights of wide_tree().
  const LightTree &wide_tree() const { return trees_.many; }

  // Light linking: whether some light reaches not all receivers, or passes blockers.
  bool linked() const { return !links_.empty(); }
  bool passes_blockers() const { return passes_blockers_; }
  LightLinks links(uint32_t light) const { return linked() ? links_[light] : LightLinks{}; }
  // Returns the trees by which a receiver chooses: those of all lights, or of the lights that reach its set.
  const LightTrees &trees(uint32_t receiver_set) const {
    return trees_of_.empty() ? trees_ : linked_trees_[trees_of_[receiver_set]];
  }
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

  void link(const std::vector<DescribedLight> &described, uint64_t receiver_sets, const BuildContext &context);

  std::vector<Light> lamps_;
  // hidden_from() and no_shadow() of all lights. These bits are read more often than the lights' other members; an array of
  // their own stays in the cache.
  std::vector<uint32_t> switches_;
  std::vector<Emitter> emitters_;
  std::vector<uint32_t> always_, emitter_of_;
  // A few lights are all in the tree of few and are chosen as in Cycles. If there are many, the tree of many contains all
  // lights with a position, and is one entry of the tree of few.
  LightTrees trees_;
  std::vector<LightLinks> links_; // of all lights; empty where none is linked
  bool passes_blockers_ = false;
  std::vector<uint32_t> lit_surfaces_; // of all lights; empty where each lights all surfaces
  // The trees of sets of receivers that some light does not reach, and their numbers by set; empty where every light reaches
  // all.
  std::vector<LightTrees> linked_trees_;
  std::vector<uint8_t> trees_of_;
  bool find_ = false;
  double most_before_ = 0.0;
  Environment environment_;
  std::vector<Light> openings_;
};

} // namespace lancer
