// Path tracing: global illumination with next-event estimation, multiple importance sampling and Russian roulette.
#pragma once

#include "integrator/sample.h"
#include "integrator/shading.h"
#include "integrator/shadow.h"

namespace lancer {

// Lobes: bits of the lobe kinds that the kernel knows; Opacity: whether surfaces may let light pass straight on.
template <uint32_t Lobes, bool Opacity> class PathIntegrator final : public Integrator {
public:
  PathIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const char *kernel)
      : scene_(scene), settings_(settings), generator_(camera, settings), shadows_(scene, settings), kernel_(kernel) {}

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  const char *kernel() const override { return kernel_; }

private:
  struct Path {
    Sampler sampler;
    glm::vec3 beta{1.0f};
    glm::dvec3 from{0.0}; // last scattering point
    double pdf = 0.0;     // of the BSDF sample that made the ray; 0 after the camera or a single direction
    uint32_t slot;        // of its result
    uint32_t scatterings = 0;
    uint32_t layers = 0; // passed straight through since the last scattering
    bool seen = false;   // the first surface has been recorded
    double passed = 0.0; // length of the way since the last scattering, through layers
    double depth = 0.0;  // t of the camera ray up to its last layer
  };

  void generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  void shade(std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void miss(const Path &path, SampleResult &result);
  void add_lights_met(const Path &path, const Ray &ray, double t, SampleResult &result);
  void add_emission(const Path &path, const Surface &surface, const Material &material, SampleResult &result);
  void sample_light(const Path &path, const Surface &surface, const ShadingPoint &point);
  bool scatter(Path &path, const Surface &surface, const ShadingPoint &point, Ray &next) const;
  bool survives(Path &path) const;
  void add(const Path &path, SampleResult &result, const glm::vec3 &radiance, uint32_t scatterings);

  const Scene &scene_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  ShadowQueue shadows_;
  const char *kernel_;
  // The queue: paths_[i] travels along rays_[i].
  std::vector<Path> paths_, next_paths_;
  std::vector<Ray> rays_, next_rays_;
  std::vector<Hit> hits_;
  std::vector<glm::vec3> indirect_; // per slot, kept back until the path ends
};

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

} // namespace lancer
