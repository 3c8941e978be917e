// Path tracing: global illumination with next-event estimation, multiple importance sampling and Russian roulette.
#pragma once

#include "integrator/aov/first_surface.h"
#include "integrator/path/last_bounces.h"
#include "integrator/sample.h"
#include "integrator/stages/camera_rays.h"
#include "integrator/stages/crossings.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/shading.h"
#include "integrator/stages/shading_queues.h"
#include "integrator/stages/shadow.h"
#include "integrator/stages/surface_stage.h"
#include "integrator/stages/texture_prefetch.h"
#include "nodes/light_path.h"

#include <algorithm>

namespace lancer {

class PathIntegrator final : public Integrator {
public:
  PathIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), camera_(camera), settings_(settings), generator_(camera, settings), shader_(scene, &camera),
        shadows_(scene, camera, settings), textures_(scene), cone_(camera), passes_(settings),
        surfaces_(scene, camera, settings), block_(surfaces_.block), lanes_(surfaces_.kernel), clear_(scene.geometry),
        any_clear_((scene.features & kFeatureTransparency) && !passes_.features() &&
                   std::ranges::find(scene.perforated_instances, 1) != scene.perforated_instances.end()),
        occlusion_reach_(settings.occlusion_distance > 0.0 ? settings.occlusion_distance * scene.normalisation.scale
                                                           : std::numeric_limits<double>::infinity()),
        last_bounces_(settings.max_bounces), queues_(scene), world_values_(scene.world.program.nodes.size()) {
    if (scene.lights.environment().is_light())
      sky_ = scene.lights.environment().map();
    world_nodes_.scene = shader_.node_scene();
    world_nodes_.surface = false;
    // What shadow rays pass, or do not see, other rays meet.
    block_.next_rays_look = !(scene.features & (kFeatureTransparency | kFeatureVisibility));
  }

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  const char *kernel() const override { return "path"; }

private:
  // By VertexDimension.
  using VertexNumbers = std::array<float, kVertexStride>;

  struct Path {
    Path(const Sampler &numbers, uint32_t result) : sampler(numbers), slot(result) {}

    Sampler sampler;
    glm::vec3 beta{1.0f};
    glm::dvec3 from{0.0};   // last scattering point
    glm::vec3 normal{0.0f}; // there, and whether light may come through: what light samples are chosen by
    bool transmits = false;
    double pdf = 0.0; // of the BSDF sample that made the ray; 0 after the camera or a single direction
    uint32_t slot;    // of its result
    uint32_t scatterings = 0;
    uint32_t kinds = LANCER_RAY_CAMERA; // of the ray
    uint32_t layers = 0;                // passed straight through since the last scattering
    uint32_t passed_through = 0;        // and in all
    PathStory story;                    // for nodes that ask
    bool in_view = true;                // what it meets is still the picture itself: nothing reflected, no glass that counts
    bool last = false;                  // the next surface ends it
    double passed = 0.0;                // length of the way since the last scattering, through layers
    double length = 0.0;                // of the whole way

    // How many layers it may still pass straight through: limit in all, but one at least. Beyond them the next surface shows
    // its own light only.
    uint32_t crossings_left(uint32_t limit) const {
      return last ? 0u : std::min(std::max(limit, passed_through + 1) - passed_through, kMaxCrossings - 1 - layers);
    }
    void count_crossings(uint32_t count, uint32_t limit) {
      layers += count;
      passed_through += count;
      last = passed_through >= limit;
    }
    // pass: share of the paths here that pass straight on.
    bool chooses_to_pass(float pass) const {
      const uint32_t dimension = kDimensionOpacity + 2 * (scatterings * kMaxCrossings + layers);
      return pass > 0.0f && (pass >= 1.0f || sampler.get1(dimension) < pass);
    }
  };

  // What nodes see of a path whose ray is so long, in normalised units: from where it may meet something.
  LightPath<float> light_path(const Path &path, double length) const {
    return path.story.told(float(length / scene_.normalisation.scale), path.scatterings, path.passed_through);
  }

  // The same where a vertex asks for light: it counts as a scattering, as in Cycles.
  LightPath<float> asking_path(const Path &path) const {
    LightPath<float> asking = path.story.told(0.0f, path.scatterings + 1, path.passed_through);
    asking.kinds = 0;
    return asking;
  }

  // What only passes beside the picture ask of a sample: it stays in its place while the path moves on.
  struct Record {
    double depth = 0.0;     // t of the camera ray up to its last layer
    bool seen = false;      // the first surface has been recorded
    float occlusion = 0.0f; // what the next ray takes from the pass of ambient occlusion if it is blocked
  };

  // Of the light that came by the first scattering: what is diffuse, glossy.
  struct Shares {
    glm::vec3 of[2];
  };

  // A vertex that waits for the others of its block.
  struct Waiting {
    size_t number; // of its path
    bool ends;     // nothing is scattered there any more
    bool nothing;  // a hole, behind which nothing is seen
    LightSet::Choice choice;
    bool far;               // the light has no end
    Mixture<float> mixture; // of its lobes, where passes for denoising are open
  };

  // As the last scattering asked for light.
  static LightQuery query(const Path &path) { return LightQuery(path.from, path.normal, path.transmits); }
  void generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  void put_in_lane(size_t number, const Material &material);
  void draw_numbers();
  void ask_nodes();
  void cut_holes(std::span<SampleResult> results);
  void record_surfaces(std::span<SampleResult> results);
  LightQuery query(uint32_t lane) const;
  LightSet::Choice choose_light(uint32_t lane) const;
  void choose_of_many();
  void ask_lights();
  void ask_by_hand(uint32_t lane);
  void send_shadow_of(uint32_t lane);
  void leave_lane(uint32_t lane, SampleResult &result);
  void shade_block(std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void shade(std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void find_hits(std::span<SampleResult> results, std::vector<PathVertex> *trace);
  bool is_there(size_t ray, const Hit &hit);
  void pass_clear(size_t number, std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void miss(size_t number, std::span<SampleResult> results);
  void ask_world(const VertexBlock::Doubles (&wi)[3], uint32_t lanes);
  glm::vec3 sky_in_lane(uint32_t lane) const; // what it gave
  void add_environment(const Path &path, double pdf, const glm::vec3 &radiance, SampleResult &result);
  void add_missed(std::span<SampleResult> results);
  void ask_sky(uint32_t lanes);
  void add_lights_met(std::span<SampleResult> results);
  void add_light_met(size_t i, uint32_t number, std::span<SampleResult> results);
  double way_end(size_t i) const; // distance from the last scattering to where the ray ends
  void add_emission(const Path &path, const Surface &surface, const glm::vec3 &emission, SampleResult &result);
  View view_of(const Path &path, const Ray &ray, double t) const;
  void keep_vertex(const Path &path, const Surface &surface, double t, const SampleResult &result,
                   std::vector<PathVertex> &trace) const;
  void record(const Path &path, const Surface &surface, const Material &material, const glm::vec3 &normal,
              const glm::vec3 &opacity, double t, SampleResult &result);
  void look_around(uint32_t lane, SampleResult &result);
  void send_occlusion_ray(uint32_t lane, const glm::vec3 &wi, const glm::vec3 &weight);
  void count_occluded(std::span<SampleResult> results);
  bool stays_in_view(uint32_t lane) const;
  void pass_straight_on(Path &path, const Surface &surface, const Ray &ray, double t, const glm::vec3 &weight);
  static bool survives(uint32_t scatterings, float u, glm::vec3 &beta);
  void add(const Path &path, SampleResult &result, const glm::vec3 &radiance, bool environment);

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  Shader shader_;
  ShadowQueue shadows_;
  TexturePrefetch textures_;
  PixelCone cone_;
  LightPasses passes_;
  SurfaceStage surfaces_;
  VertexBlock &block_;
  const VertexKernel &lanes_;
  bool only_combined_ = true; // no other pass is asked for: records stay as they are
  Crossings clear_;           // surfaces on the way of which nothing is there
  bool any_clear_;            // they are passed together; not where passes for denoising add up the ways between them
  double occlusion_reach_;    // normalised units
  SegmentBlock segments_{};
  Waiting waiting_[kBlockLanes];
  uint32_t first_sample_ = 0; // of the block's first lane
  DirectionTable sky_;
  SkyBlock misses_{}, sky_samples_{};
  size_t missed_[kBlockLanes]; // numbers of paths
  uint32_t missed_count_ = 0;
  // The queue: paths_[i] travels along rays_[i].
  std::vector<Path> paths_, next_paths_;
  std::vector<Ray> rays_, next_rays_;
  std::vector<Hit> hits_;
  std::vector<glm::vec3> indirect_;     // per slot, kept back until the path ends
  std::vector<Record> records_;         // per slot, like what follows
  std::vector<Shares> shares_;          // where passes are by component, once the path has left what the camera sees
  std::vector<DenoisingGuides> guides_; // where passes for denoising are asked for
  LastBounces last_bounces_;
  ShadingQueues queues_; // paths by the class of the material that they have met
  NodeBlock world_nodes_;
  std::vector<NodeLanes> world_values_;
  Shaded clear_point_; // of a surface of which nothing is there
};

std::unique_ptr<Integrator> make_path(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

} // namespace lancer
