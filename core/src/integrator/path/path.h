// Path tracing: global illumination with next-event estimation, multiple importance sampling and Russian roulette.
#pragma once

#include "integrator/path/path_film.h"
#include "integrator/path/path_state.h"
#include "integrator/stages/camera.h"
#include "integrator/stages/hit.h"
#include "integrator/stages/light.h"
#include "integrator/stages/linked_lights.h"
#include "integrator/stages/met_lights.h"
#include "integrator/stages/node_rays.h"
#include "integrator/stages/occlusion.h"
#include "integrator/stages/scatter.h"
#include "integrator/stages/shading_queues.h"
#include "integrator/stages/shadow.h"
#include "integrator/stages/surface.h"
#include "integrator/stages/texels.h"
#include "integrator/stages/texture_prefetch.h"
#include "integrator/stages/walk.h"

#include <algorithm>
#include <optional>

namespace lancer {

class PathIntegrator final : public Integrator {
public:
  PathIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), settings_(settings), spread_at_eye_(camera), width_at_eye_(PixelCone(camera).base),
        camera_(camera, scene.motion, settings), film_(scene, camera, settings), hit_(scene, camera), met_(scene, camera),
        haunted_(changes_paths(settings)), guesses_(settings.fast_bounces > 0),
        catches_(settings.catchers && (scene.features & kFeatureCatchers)), queues_(scene), textures_(scene),
        surface_(scene, camera, settings), light_(scene, &camera), occlusion_(scene, settings),
        ambient_(scene, settings.fast_distance), shadow_(scene, camera, settings), last_bounces_(settings.max_bounces) {
    if (std::ranges::any_of(scene.materials, [](const MaterialView &material) { return material.program.looks_around; }))
      surface_.look_by(node_rays_.emplace(scene).functions());
    if (scene.lights.passes_blockers())
      linked_.emplace(scene, camera);
    if (scene.features & kFeatureSubsurface) {
      surface_.walk_below();
      walk_.emplace(scene);
    }
    for (size_t i = 0; i < scene.materials.size() && settings.filter_glossy > 0.0f; ++i)
      filtered_materials_.push_back(has_facets(scene.materials[i]));
    if (settings.bake)
      texels_.emplace(scene, camera, settings);
    PathIntegrator::set_splits(settings.splits);
  }

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  void set_splits(const Splits &splits) override {
    // A vertex takes one light and one path, unless its sample splits.
    std::fill_n(lights_, kBlockLanes, 1.0);
    std::fill_n(paths_, kBlockLanes, 1.0);
    settings_.splits = splits;
    film_.set_splits(splits);
  }
  const char *name() const override { return "path"; }

private:
  // Paths on their way: paths[i] goes along rays[i]. Its last scattering is from[i]; where it has passed surfaces since, the
  // ray starts at the last of them.
  struct Queue {
    std::vector<Path> paths;
    std::vector<Ray> rays;
    std::vector<Scattering> from;

    void clear() {
      paths.clear();
      rays.clear();
      from.clear();
    }
  };

  // Whether limits of kinds of bounces, or of caustics, or a filter change paths at surfaces.
  static bool changes_paths(const IntegratorSettings &settings) {
    const uint32_t least = std::min({settings.diffuse_bounces, settings.glossy_bounces, settings.transmission_bounces});
    return least < settings.max_bounces || settings.no_reflections || settings.no_refractions || settings.filter_glossy > 0.0f;
  }

  void start(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  void find_hits();
  void shade();
  void shade_queued();
  void add_lamps();
  void add_linked_lights();
  void send_ghosts();
  void send_ghost(size_t path, Ghost cause);
  void send_pair(size_t path);
  void follow_guess(size_t path, double tmax);
  void send_among_catchers();
  void add_environment();
  template <class Arrive> void add_environment(std::span<const size_t> paths, Arrive &&arrive);
  void put_in_lane(size_t number, const MaterialView &material);
  void shade_block();
  void leave();
  void cut_holdouts();
  void cut_transparency();
  void add_emission(uint32_t lane);
  void split();
  void light();
  LightPath<float> asking_path(uint32_t lane) const;
  void send_shadow(uint32_t lane);
  void go_on();
  void look_around(uint32_t lane);
  void add_ambient(uint32_t lanes);
  void pass_straight(uint32_t lane);
  glm::vec3 portal_weight(uint32_t lane, const Portal &portal) const;
  glm::vec3 straight_weight(uint32_t lane) const;
  bool has_portal(uint32_t lane) const;
  const Portal *choose_portal(uint32_t lane, Path &path) const;
  void enter_portal(uint32_t lane, const Portal &portal, Ray &ray) const;
  void scatter(uint32_t lane, uint32_t branch);
  Path &branch_off(std::vector<Path> &paths, uint32_t lane, uint32_t branch) const;
  void enter(uint32_t lane, uint32_t branch);

  // Returns the throughput from the environment.
  glm::vec3 seen_beta(const Path &path) const { return path.beta * (path.is_fast(settings_) ? settings_.fast_factor : 1.0f); }
  const Path &path_of(uint32_t lane) const { return queue_.paths[path_[lane]]; }

  const Scene &scene_;
  IntegratorSettings settings_;
  PixelSpread spread_at_eye_;
  double width_at_eye_; // of a pixel
  // The stages, in the order of a bounce.
  CameraStage camera_;
  std::optional<TexelStage> texels_; // of a bake, in place of the camera and its first hits
  bool at_texels_ = false;
  PathFilm film_;
  HitStage hit_;
  MetLights met_;
  std::optional<LinkedLights> linked_;   // if some light passes blockers
  const bool haunted_;                   // limits of kinds of bounces or caustics, or a filter, change paths
  const bool guesses_;                   // Fast GI ends paths
  std::vector<bool> filtered_materials_; // a filter may change their lobes; empty without one
  const bool catches_;                   // paths may meet shadow catchers
  ShadingQueues queues_;
  TexturePrefetch textures_;
  std::optional<SceneNodeRays> node_rays_; // if a node looks around
  SurfaceStage surface_;
  NumberStage numbers_;
  LightStage light_;
  ScatterStage scatter_;
  OcclusionStage occlusion_, ambient_; // of the pass, and of the ambient light
  ShadowStage shadow_;
  std::optional<WalkStage> walk_; // if light enters some surface
  LastBounces last_bounces_;

  Queue queue_, next_;
  // Paths that have entered a surface: path i takes walk i.
  std::vector<Path> below_;
  std::vector<Walk> walks_;
  std::vector<Hit> hits_;      // of the queue
  std::vector<uint32_t> left_; // surfaces that each path may still pass
  std::vector<size_t> missed_; // numbers of the paths that see the environment
  std::vector<size_t> behind_; // and of those whose shadow catcher shows the environment to its pass
  // The block, by lane.
  size_t path_[kBlockLanes];     // of the path
  uint32_t leader_[kBlockLanes]; // number of the leader among the branches
  Floats beta_[3] = {};
  Doubles lights_, paths_; // sampled at the vertex
  // Bits of its lanes.
  uint32_t ends_ = 0;            // the vertex scatters no light
  uint32_t nothing_ = 0;         // a hole in the picture
  uint32_t splitting_ = 0;       // the sample splits
  uint32_t occlusion_asked_ = 0; // the pass of ambient occlusion asks
};

} // namespace lancer
