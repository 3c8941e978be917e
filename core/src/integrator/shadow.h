// Shadow rays, kept in a queue and traced as a batch: how much of a light's contribution arrives.
#pragma once

#include "integrator/light_passes.h"
#include "integrator/sample.h"
#include "integrator/shading.h"

namespace lancer {

class ShadowQueue {
public:
  ShadowQueue(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), shader_(scene, &camera), deepest_(settings.transparent_shadows),
        layers_(settings.all_features || (scene.features & kFeatureTransparency)) {}

  // contribution reaches the waiting sum where nothing stands between. passed: surfaces that the path already passed straight
  // through; they count against the same limit.
  void push(const Ray &ray, const WaitingLight &waiting, const glm::vec3 &contribution, uint32_t passed = 0) {
    push(waiting, contribution, passed) = ray;
  }
  // The same; the ray is written where it stands.
  Ray &push(const WaitingLight &light, const glm::vec3 &contribution, uint32_t passed = 0) {
    Waiting &waiting = waiting_.emplace_back();
    waiting.light = light;
    waiting.contribution = contribution;
    waiting.passed = passed;
    return rays_.emplace_back();
  }

  // Light that nothing can stop.
  void push_lit(const WaitingLight &waiting, const glm::vec3 &contribution) {
    Ray &ray = push(waiting, contribution);
    ray.tmax = ray.tmin;
  }

  // Traces all rays, calls arrive(waiting, contribution times transmittance) in the order of pushing, and empties the queue.
  // Returns how many rays it took.
  template <class Arrive> uint64_t trace(Arrive &&arrive) {
    const uint64_t count = layers_ ? trace_layers() : trace_solid();
    for (const Waiting &waiting : waiting_)
      if (waiting.contribution != glm::vec3(0.0f))
        arrive(waiting.light, waiting.contribution);
    rays_.clear();
    waiting_.clear();
    return count;
  }

private:
  struct Waiting {
    WaitingLight light;
    glm::vec3 contribution; // what arrives of it
    uint32_t passed;        // surfaces on the way so far
  };

  // Everything blocks: any hit answers.
  uint64_t trace_solid();
  // Some surfaces let a share pass: go from hit to hit.
  uint64_t trace_layers();

  const Scene &scene_;
  Shader shader_;
  uint32_t deepest_; // surfaces that a ray may pass
  bool layers_;
  std::vector<Ray> rays_;
  std::vector<Waiting> waiting_;
  std::vector<uint8_t> occluded_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> under_way_;
  std::vector<Ray> under_way_rays_;
};

} // namespace lancer
