// The course's first picture: the normal as a colour, the sky where nothing is.
#pragma once

#include "integrator/aov/first_surface.h"
#include "integrator/sample.h"
#include "integrator/stages/camera_rays.h"
#include "integrator/stages/light_passes.h"

#include <algorithm>

namespace lancer {

class NormalsIntegrator final : public Integrator {
public:
  NormalsIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), camera_(camera), settings_(settings), generator_(camera, settings), shader_(scene, &camera),
        passes_(settings) {}

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override {
    rays_.clear();
    slots_.clear();
    generator_.start(addresses, passes_.wanted(), results, [&](uint32_t slot, const Sampler &) -> Ray & {
      slots_.push_back(slot);
      return rays_.emplace_back();
    });
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    counts_.camera += rays_.size();
    vertices_.narrow += size_t(std::ranges::count_if(hits_, [](const Hit &hit) { return hit.valid(); }));
    for (size_t i = 0; i < rays_.size(); ++i) {
      const Ray &ray = rays_[i];
      SampleResult &result = results[slots_[i]];
      if (!hits_[i].valid()) {
        miss(ray, result);
        add_sky_guides(begin_guides(settings_, passes_.features()), result);
        continue;
      }
      const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hits_[i]);
      shader_.shade(surface, {.wo = glm::vec3(-glm::normalize(ray.d)), .path = {.kinds = LANCER_RAY_CAMERA}}, point_);
      // This picture shows every surface whole.
      point_.transmittance = glm::vec3(0.0f);
      record_first_surface(scene_, settings_, surface, point_, hits_[i].t, result);
      record_seen(scene_, camera_, settings_, passes_, surface, point_, glm::vec3(1.0f), result);
      DenoisingGuides features = begin_guides(settings_, passes_.features());
      if (features.open)
        add_denoising_guides(scene_, camera_, mix(point_.bsdf, point_.transmittance, features.blended), point_.bsdf.wo,
                             point_.transmittance, hits_[i].t * glm::length(ray.d), features, result);
      result.radiance = 0.5f * surface.ns + 0.5f;
      if (trace)
        trace->push_back({scene_.normalisation.to_world(surface.p), hits_[i].t / scene_.normalisation.scale, surface.ns,
                          glm::vec3(1.0f), result.radiance, surface.instance, surface.primitive, surface.material, 0});
    }
  }
  const char *kernel() const override { return "normals"; }

private:
  void miss(const Ray &ray, SampleResult &result) {
    if (settings_.film_transparent)
      result.alpha = 0.0f;
    else if (!(scene_.world.hidden_from & LANCER_RAY_CAMERA))
      result.radiance = scene_.lights.environment().radiance(glm::normalize(ray.d), shader_.values(), &camera_, &ray.o,
                                                             {.kinds = LANCER_RAY_CAMERA});
  }

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  Shader shader_;
  LightPasses passes_;
  Shaded point_;
  std::vector<uint32_t> slots_; // rays_[i] is of results[slots_[i]]
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

} // namespace lancer
