// Shadow rays, kept in a queue and traced as a batch: how much of a light's contribution arrives.
#pragma once

#include "integrator/sample.h"
#include "integrator/shading.h"

namespace lancer {

class ShadowQueue {
public:
  ShadowQueue(const Scene &scene, const IntegratorSettings &settings)
      : scene_(scene), opacity_(settings.all_features || (scene.features & kFeatureOpacity)) {}

  // contribution reaches the owner where nothing stands between.
  void push(const Ray &ray, uint32_t owner, const glm::vec3 &contribution) {
    rays_.push_back(ray);
    owners_.push_back(owner);
    contributions_.push_back(contribution);
  }

  // Traces all rays, calls arrive(owner, contribution times transmittance) in the order of pushing, and empties the queue.
  // Returns how many rays it took.
  template <class Arrive> uint64_t trace(Arrive &&arrive) {
    const uint64_t count = opacity_ ? trace_layers() : trace_solid();
    for (size_t i = 0; i < owners_.size(); ++i)
      if (contributions_[i] != glm::vec3(0.0f))
        arrive(owners_[i], contributions_[i]);
    rays_.clear();
    owners_.clear();
    contributions_.clear();
    return count;
  }

private:
  // Everything blocks: any hit answers.
  uint64_t trace_solid();
  // Some surfaces let a share pass: go from hit to hit.
  uint64_t trace_layers();

  const Scene &scene_;
  bool opacity_;
  std::vector<Ray> rays_;
  std::vector<uint32_t> owners_;
  std::vector<glm::vec3> contributions_;
  std::vector<uint8_t> occluded_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> waiting_;
  std::vector<Ray> waiting_rays_;
};

} // namespace lancer
