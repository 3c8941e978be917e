// Shadow rays, queued and traced as a batch: they determine the part of each light contribution that arrives.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/crossings.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/shading.h"

#include <algorithm>

namespace lancer {

class ShadowQueue {
public:
  ShadowQueue(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), shader_(scene, &camera), deepest_(settings.transparent_shadows),
        any_clear_(settings.all_features || (scene.features & kFeatureTransparency)),
        asks_light_path_(std::ranges::any_of(
            scene.materials, [](const Material &m) { return m.transmittance.varies() && m.program.asks_light_path; })),
        crossings_(scene.geometry) {}

  // Queues a contribution; trace() multiplies it by the ray's transmittance. passed: the number of surfaces that the path has
  // already passed straight through; they count against the same limit.
  void push(const Ray &ray, const WaitingLight &waiting, const glm::vec3 &contribution, uint32_t passed = 0) {
    rays_.push_back(ray);
    waiting_.push_back({waiting, contribution, passed});
  }
  // Queues a contribution without shares. Returns the ray for the caller to write in place: a copy would stall on the pending
  // stores of its members.
  Ray &push(uint32_t slot, uint32_t place, const glm::vec3 &contribution, bool indirect = false, uint32_t passed = 0) {
    Waiting &waiting = waiting_.emplace_back();
    waiting.light.slot = slot;
    waiting.light.place = place;
    waiting.light.indirect = indirect;
    waiting.contribution = contribution;
    waiting.passed = passed;
    return rays_.emplace_back();
  }
  // Sets the shares by component of the last pushed light.
  void set_shares(const glm::vec3 (&share)[2]) {
    waiting_.back().light.share[0] = share[0];
    waiting_.back().light.share[1] = share[1];
  }

  // Whether a surface may read the Light Path of a shadow ray, which set_light_path() sets for the last pushed ray.
  bool asks_light_path() const { return asks_light_path_; }
  void set_light_path(const LightPath<float> &path) {
    light_paths_.resize(rays_.size(), shadow_path());
    light_paths_.back() = path;
    light_paths_.back().kinds = LANCER_RAY_SHADOW;
  }

  // Queues light that nothing occludes.
  void push_lit(const WaitingLight &waiting, const glm::vec3 &contribution) {
    Ray ray;
    ray.tmax = ray.tmin;
    push(ray, waiting, contribution);
  }

  // Traces all rays, calls arrive(waiting, contribution times transmittance) in the order of pushing, and empties the queue.
  // Returns the number of rays.
  template <class Arrive> uint64_t trace(Arrive &&arrive) {
    const uint64_t count = any_clear_ ? trace_clear() : trace_solid();
    for (const Waiting &waiting : waiting_)
      if (waiting.contribution != glm::vec3(0.0f))
        arrive(waiting.light, waiting.contribution);
    rays_.clear();
    waiting_.clear();
    light_paths_.clear();
    return count;
  }

private:
  struct Waiting {
    WaitingLight light;
    glm::vec3 contribution{0.0f}; // arriving part of the light
    uint32_t passed = 0;          // surfaces passed so far
  };

  static LightPath<float> shadow_path() { return {.kinds = LANCER_RAY_SHADOW}; }
  // Traces rays where all surfaces are opaque: any hit occludes.
  uint64_t trace_solid();
  // Traces rays where some surfaces transmit light.
  uint64_t trace_clear();
  // Whether a hit surface occludes a ray; keeps the surface's transmittance if not.
  bool stops(size_t ray, const Hit &hit);

  const Scene &scene_;
  Shader shader_;
  uint32_t deepest_; // surfaces that a ray may pass
  bool any_clear_, asks_light_path_;
  Crossings crossings_; // that the rays have passed
  std::vector<Ray> rays_;
  std::vector<Waiting> waiting_;
  std::vector<LightPath<float>> light_paths_; // by ray, up to the last one that was set
  std::vector<uint8_t> occluded_;
};

} // namespace lancer
