// The course's recursive ray tracer: direct light of every lamp, mirror reflection and refraction, nothing left to chance.
#pragma once

#include "integrator/course_light.h"
#include "integrator/sample.h"
#include "integrator/shading.h"
#include "integrator/shadow.h"

namespace lancer {

class ClassicIntegrator final : public Integrator {
public:
  ClassicIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), settings_(settings), generator_(camera, settings), shadows_(scene, settings) {}

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  const char *kernel() const override { return "classic"; }

private:
  // A ray of the recursion; all of one depth are traced together.
  struct Branch {
    glm::vec3 weight{1.0f}; // of what it brings back
    uint32_t slot;
    uint32_t depth = 0;
    uint32_t layers = 0; // passed straight through
    bool seen = false;   // the first surface has been recorded
    double passed = 0.0; // t of the camera ray up to its last layer
  };

  void run_part(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  void shade(const Branch &branch, const Ray &ray, const Hit &hit, SampleResult &result, std::vector<PathVertex> *trace);
  void add_direct_light(const Branch &branch, const Surface &surface, const ShadingPoint &point, const glm::dvec3 &eye,
                        const Hit &hit, SampleResult &result);
  void add_reflection_and_refraction(const Branch &branch, const Surface &surface, const ShadingPoint &point);
  void spawn(const Branch &parent, const Surface &surface, const glm::vec3 &direction, const glm::vec3 &weight);

  const Scene &scene_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  ShadowQueue shadows_;
  std::vector<Sampler> samplers_; // per slot
  std::vector<Branch> branches_, next_branches_;
  std::vector<Ray> rays_, next_rays_;
  std::vector<Hit> hits_;
};

} // namespace lancer
