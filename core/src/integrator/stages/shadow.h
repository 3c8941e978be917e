// Shadow rays, queued and traced as a batch: they determine the part of each light contribution that arrives.
//
// In: contributions with their rays, Light Paths and numbers of crossings, from integrators and the occlusion stage. Out: the
// contributions times the transmittance of the surfaces on the way, in the order of pushing. Rays are in the normalised world.
// Callers: PATH, CLASSIC, the occlusion stage.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/hit.h"
#include "integrator/stages/light.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/shader.h"

#include <algorithm>

namespace lancer {

// Writes the ray from a lane to its light sample in place.
void write_shadow_ray(const Scene &scene, const SurfaceStage &surfaces, uint32_t lane, const LightSamples &samples,
                      const LitBlock &lit, Ray &ray);

class ShadowStage final : HitFilter {
public:
  ShadowStage(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : HitFilter((scene.linked_blockers.empty() ? scene.transparent_instances : scene.linked_blockers).data()), scene_(scene),
        shader_(scene, &camera), deepest_(settings.transparent_shadows),
        any_clear_(settings.all_features() || (scene.features & kFeatureTransparency) || !scene.linked_blockers.empty()),
        asks_light_path_(std::ranges::any_of(scene.materials,
                                             [](const MaterialView &m) {
                                               return (m.program.asks_light_path || m.program.mipmapped) &&
                                                      (m.transmittance.varies() || m.has_sheets);
                                             })),
        crossings_(scene.geometry) {}

  // Queues a contribution; trace() multiplies it by the ray's transmittance. passed: the number of surfaces that the path has
  // already passed straight through; they count against the same limit (CLASSIC: 0). links: of the light.
  void push(const Ray &ray, const WaitingLight &waiting, const glm::vec3 &contribution, uint32_t passed = 0,
            const LightLinks &links = {}) {
    rays_.push_back(ray);
    waiting_.push_back({waiting, contribution, passed, links});
  }
  // Queues a contribution, calls fill(waiting) and returns the ray, for the caller to write both in place: a copy would stall
  // on the pending stores of their members.
  template <class Fill> Ray &push(const glm::vec3 &contribution, uint32_t passed, const LightLinks &links, Fill &&fill) {
    Waiting &waiting = waiting_.emplace_back();
    waiting.contribution = contribution;
    waiting.passed = passed;
    waiting.links = links;
    fill(waiting.light);
    return rays_.emplace_back();
  }

  // Whether a surface may read the Light Path of a shadow ray, which set_light_path() sets for the last pushed ray.
  bool asks_light_path() const { return asks_light_path_; }
  void set_light_path(const LightPath<float> &path) {
    light_paths_.resize(rays_.size(), shadow_path());
    light_paths_.back() = path;
    light_paths_.back().kinds = RayKind::Shadow;
  }

  // Empties the ray of light that nothing occludes.
  static void leave_out(Ray &ray) { ray.tmax = ray.tmin; }

  // Traces all rays, calls arrive(waiting, contribution times transmittance) in the order of pushing where light arrives, and
  // empties the queue. Returns the number of rays, also of those that nothing occludes.
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
    LightLinks links;             // of the light
  };

  static LightPath<float> shadow_path() { return {.kinds = RayKind::Shadow}; }
  // Traces rays where all surfaces are opaque: any hit occludes.
  uint64_t trace_solid();
  // Traces rays where some surfaces transmit light.
  uint64_t trace_clear();
  // Whether a hit surface occludes a ray; keeps the surface's transmittance if not.
  bool counts(size_t ray, const Hit &hit) override;

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
