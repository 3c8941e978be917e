// The course's first picture: the normal as a colour, the sky where nothing is.
#pragma once

#include "integrator/first_surface.h"
#include "integrator/light_passes.h"
#include "integrator/sample.h"

namespace lancer {

class NormalsIntegrator final : public Integrator {
public:
  NormalsIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), settings_(settings), generator_(camera, settings), shader_(scene, &camera) {}

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override {
    rays_.clear();
    for (const SampleAddress &address : addresses) {
      rays_.push_back(generator_.ray(address, generator_.sampler(address)));
      rays_.back().kinds = LANCER_RAY_CAMERA;
    }
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    counts_.camera += rays_.size();
    for (size_t i = 0; i < rays_.size(); ++i) {
      const Ray &ray = rays_[i];
      results[i] = SampleResult(LightPasses(settings_).wanted());
      // Outside a panorama's picture there is no direction to look in: it is black, and as solid as Cycles has it.
      results[i].alpha = ray.tmax < 0.0 ? 1.0f : 0.0f;
      if (ray.tmax < 0.0)
        continue;
      if (!hits_[i].valid()) {
        if (!settings_.film_transparent) {
          results[i].radiance = scene_.lights.environment().radiance(glm::normalize(ray.d), shader_.values());
          results[i].alpha = 1.0f;
        }
        continue;
      }
      const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hits_[i]);
      shader_.shade(surface, {.wo = glm::vec3(-glm::normalize(ray.d)), .camera_ray = true}, point_);
      record_first_surface(scene_, settings_, surface, point_, hits_[i].t, results[i]);
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
  Shader shader_;
  Shaded point_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

} // namespace lancer
