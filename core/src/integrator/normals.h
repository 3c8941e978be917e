// The course's first picture: the normal as a colour, the sky where nothing is.
#pragma once

#include "integrator/sample.h"

namespace lancer {

class NormalsIntegrator final : public Integrator {
public:
  NormalsIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), settings_(settings), generator_(camera, settings) {}

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override {
    rays_.clear();
    for (const SampleAddress &address : addresses)
      rays_.push_back(generator_.ray(address, generator_.sampler(address)));
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    counts_.camera += rays_.size();
    for (size_t i = 0; i < rays_.size(); ++i) {
      results[i] = SampleResult{};
      if (!hits_[i].valid()) {
        if (!settings_.film_transparent) {
          results[i].radiance = scene_.lights.world();
          results[i].alpha = 1.0f;
        }
        continue;
      }
      const Surface surface = surface_at(scene_.geometry, scene_.slots, rays_[i], hits_[i]);
      const glm::vec3 albedo =
          surface.material == kNone ? glm::vec3(0.0f) : scene_.materials[surface.material].constant.albedo_color();
      record_first_surface(scene_, surface, albedo, hits_[i].t, results[i]);
      results[i].radiance = 0.5f * surface.ns + 0.5f;
      results[i].alpha = 1.0f;
      if (trace)
        trace->push_back({scene_.normalisation.to_world(surface.p), hits_[i].t / scene_.normalisation.scale, surface.ns,
                          glm::vec3(1.0f), results[i].radiance, surface.instance, surface.primitive, surface.material, 0});
    }
  }
  const char *kernel() const override { return "normals"; }

private:
  const Scene &scene_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

} // namespace lancer
