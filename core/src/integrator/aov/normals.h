// The course's first picture: the normal as a colour, and the sky.
#pragma once

#include "integrator/aov/first_surface.h"
#include "integrator/aov/surface_extras.h"
#include "integrator/aov/vectors.h"
#include "integrator/sample.h"
#include "integrator/stages/camera.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/shading_queues.h"
#include "integrator/stages/surface.h"

#include <algorithm>

namespace lancer {

class NormalsIntegrator final : public Integrator {
public:
  NormalsIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), camera_(camera), settings_(settings), generator_(camera, scene.motion, settings),
        surfaces_(scene, camera, settings), queues_(scene), passes_(settings), vectors_(scene, camera, settings),
        sky_values_(scene.world.program.value_count()) {}

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override {
    extras_.begin(addresses.size(), settings_.extras());
    rays_.clear();
    samples_.clear();
    generator_.start(addresses, passes_.wanted(), results, [&](uint32_t sample, const Sampler &) -> Ray & {
      samples_.push_back(sample);
      return rays_.emplace_back();
    });
    hits_.resize(rays_.size());
    scene_.accelerator->closest_hit(rays_, hits_);
    counts_.camera += rays_.size();
    queues_.begin();
    for (size_t i = 0; i < rays_.size(); ++i)
      if (hits_[i].valid())
        queues_.add(i, hits_[i]);
      else
        miss(rays_[i], results[samples_[i]]);
    vertices_ += queues_.size();
    queues_.each([&](std::span<const ShadingQueues::Queued> met) {
      for (const ShadingQueues::Queued &one : met) {
        number_[surfaces_.add(rays_[one.number], hits_[one.number], *one.material)] = one.number;
        if (surfaces_.full())
          show_block(results, trace);
      }
      show_block(results, trace);
    });
  }
  const char *name() const override { return "normals"; }

private:
  void miss(const Ray &ray, SampleResult &result) {
    if (settings_.film_transparent)
      result.alpha = 0.0f;
    else if (!(scene_.world.hidden_from & RayKind::Camera))
      result.radiance = scene_.lights.environment().radiance(glm::normalize(ray.d), sky_values_, &camera_, &ray.o,
                                                             {.kinds = RayKind::Camera});
    add_sky_guides(begin_guides(settings_, passes_.guides()), result);
    vectors_.record_sky(ray.d, result);
  }

  void show_block(std::span<SampleResult> results, std::vector<PathVertex> *trace) {
    if (surfaces_.count() == 0)
      return;
    surfaces_.find();
    surfaces_.ask_nodes(
        [&](uint32_t lane) { return View{.wo = get(surfaces_.surfaces().wo, lane), .path = {.kinds = RayKind::Camera}}; },
        settings_.extras().has_outputs());
    surfaces_.build_lobes();
    // This picture shows every surface as opaque.
    surfaces_.make_opaque();
    surfaces_.describe();
    for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
      show(lane, samples_[number_[lane]], results, trace);
    surfaces_.clear();
  }

  void show(uint32_t lane, uint32_t sample, std::span<SampleResult> results, std::vector<PathVertex> *trace) {
    SampleResult &result = results[sample];
    const Surface surface = surfaces_.surface(lane);
    const double t = surfaces_.hit(lane).t;
    record_place(scene_, surface, surfaces_.material(lane), t, result);
    record_first_surface(scene_, settings_, surface, get(surfaces_.means().normal, lane), result);
    vectors_.record(surface, result);
    record_seen(scene_, camera_, settings_, passes_, surface, surfaces_, lane, glm::vec3(1.0f), result);
    add_mattes(scene_, settings_.extras(), sample, surface.instance, surfaces_.material(lane), 1.0f, extras_);
    add_outputs(settings_.extras(), sample, surfaces_, lane, extras_);
    DenoisingGuides guides = begin_guides(settings_, passes_.guides());
    if (guides.open)
      add_denoising_guides(scene_, camera_, surfaces_.mixture(lane), get(surfaces_.surfaces().wo, lane), glm::vec3(0.0f),
                           surfaces_.distance(lane), guides, result);
    result.radiance = 0.5f * surface.ns + 0.5f;
    if (trace)
      trace->push_back({scene_.normalisation.to_world(surface.p), t / scene_.normalisation.scale, surface.ns, glm::vec3(1.0f),
                        result.radiance, surface.instance, surface.primitive, surface.material, 0});
  }

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  CameraStage generator_;
  SurfaceStage surfaces_;
  ShadingQueues queues_;
  LightPasses passes_;
  Vectors vectors_;
  std::vector<glm::vec4> sky_values_; // of the world's nodes
  uint32_t number_[kBlockLanes];      // number of the ray of each lane of the block
  std::vector<uint32_t> samples_;     // rays_[i] belongs to results[samples_[i]]
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

} // namespace lancer
