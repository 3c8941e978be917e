// Path tracing: global illumination with next-event estimation, multiple importance sampling and Russian roulette.
#pragma once

#include "integrator/path/last_bounces.h"
#include "integrator/path/path_film.h"
#include "integrator/path/path_state.h"
#include "integrator/stages/camera_rays.h"
#include "integrator/stages/crossings.h"
#include "integrator/stages/light_stage.h"
#include "integrator/stages/shading.h"
#include "integrator/stages/shading_queues.h"
#include "integrator/stages/shadow.h"
#include "integrator/stages/surface_stage.h"
#include "integrator/stages/texture_prefetch.h"

#include <algorithm>

namespace lancer {

class PathIntegrator final : public Integrator {
public:
  PathIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), camera_(camera), settings_(settings), generator_(camera, settings), shader_(scene, &camera),
        shadows_(scene, camera, settings), textures_(scene), cone_(camera), surfaces_(scene, camera, settings),
        block_(surfaces_.block), lanes_(surfaces_.kernel), lights_(scene, camera, surfaces_), film_(scene, camera, settings),
        passes_(film_.passes), clear_(scene.geometry),
        any_clear_((scene.features & kFeatureTransparency) && !passes_.features() &&
                   std::ranges::find(scene.perforated_instances, 1) != scene.perforated_instances.end()),
        occlusion_reach_(settings.occlusion_distance > 0.0 ? settings.occlusion_distance * scene.normalisation.scale
                                                           : std::numeric_limits<double>::infinity()),
        last_bounces_(settings.max_bounces), queues_(scene) {
    // Fill the defaults: a vertex takes one light and one path. Next rays can replace occlusion rays only if occlusion rays
    // meet the same surfaces as next rays.
    std::fill_n(block_.lights, kBlockLanes, 1.0);
    std::fill_n(block_.paths, kBlockLanes, 1.0);
    block_.next_rays_look = !(scene.features & (kFeatureTransparency | kFeatureVisibility));
  }

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  void set_splits(const Splits &splits) override {
    settings_.splits = splits;
    film_.set_splits(splits);
  }
  const char *kernel() const override { return "path"; }

private:
  // Random numbers of a vertex, as bits.
  static constexpr uint32_t kLightNumbers = 3u << kVertexLight | 1u << kVertexLightChoice | 1u << kVertexLightDigits;
  static constexpr uint32_t kPathNumbers = 3u << kVertexBsdf | 1u << kVertexLobe | 1u << kVertexRoulette;

  // A vertex that waits for the others of its block.
  struct Waiting {
    size_t number;          // of its path
    uint32_t leader;        // number of the leader among the branches
    bool ends;              // the vertex scatters no light
    bool nothing;           // a hole in the picture
    Mixture<float> mixture; // of its lobes, while the path looks for the surface of the denoising guides
  };

  void generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  // Finding hits.
  void find_hits();
  bool is_there(size_t ray, const Hit &hit);
  void pass_clear(size_t number);
  // Shading hits.
  void shade();
  void put_in_lane(size_t number, const Material &material);
  void shade_block();
  void split();
  void draw_numbers(uint32_t wanted, uint32_t count, uint32_t number);
  void ask_nodes();
  void cut_holes();
  void record_surfaces();
  void take_emission(uint32_t lane);
  void ask_lights();
  void go_on();
  bool passes_straight(uint32_t lane);
  void scatter_lane(uint32_t lane, uint32_t number);
  // Adding light.
  void add_emission(const Path &path, const Surface &surface, const glm::vec3 &emission);
  void miss(size_t number);
  void add_missed();
  void add_lights_met();
  void add_met(size_t first, uint32_t met, uint32_t number);
  void add_light_met(size_t i, uint32_t number);
  template <class Chosen> void add_light_met(size_t i, uint32_t number, const LightHit &met, const Chosen &chosen);
  double way_end(size_t i) const; // returns the distance from the last scattering to the end of the ray
  void send_shadow_of(uint32_t lane);
  void look_around(uint32_t lane);
  void send_occlusion_ray(uint32_t lane, const glm::vec3 &wi, const glm::vec3 &weight);
  void count_occluded();
  // Continuing paths.
  glm::vec3 recorded_opacity(uint32_t lane) const;
  bool stays_in_view(uint32_t lane) const;
  void pass_straight_on(Path &path, const Surface &surface, const Ray &ray, double t, const glm::vec3 &weight);
  static bool survives(uint32_t scatterings, float u, float sharers, glm::vec3 &beta);
  View view_of(const Path &path, const Ray &ray, double t) const;
  void keep_vertex(const Path &path, const Surface &surface, double t);

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  Shader shader_;
  ShadowQueue shadows_;
  TexturePrefetch textures_;
  PixelCone cone_;
  SurfaceStage surfaces_;
  VertexBlock &block_;
  const VertexKernel &lanes_;
  LightStage lights_;
  PathFilm film_;
  const LightPasses &passes_;
  Crossings clear_;        // absent surfaces on the rays
  bool any_clear_;         // rays pass absent surfaces in one traversal; not with denoising guides, which sum the distances
                           // between surfaces
  double occlusion_reach_; // normalised units
  SegmentBlock segments_{};
  MetLight met_light_{};
  Waiting waiting_[kBlockLanes];
  bool one_bounce_ = true;     // all lanes of the block have the same bounce
  uint32_t splitting_ = 0;     // bits of the lanes whose samples split
  size_t missed_[kBlockLanes]; // numbers of paths
  uint32_t missed_count_ = 0;
  // The queue: paths_[i] travels along rays_[i].
  std::vector<Path> paths_, next_paths_;
  std::vector<Ray> rays_, next_rays_;
  std::vector<Hit> hits_;
  std::vector<PathVertex> *trace_ = nullptr; // of a batch whose vertices are recorded
  LastBounces last_bounces_;
  ShadingQueues queues_; // paths by the class of the hit material
  Shaded clear_point_;   // of an absent surface
};

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

} // namespace lancer
