// The recursive ray tracer: direct light of every lamp, mirror reflection and refraction, without random choices.
#pragma once

#include "compile/scene.h"
#include "integrator/aov/first_surface.h"
#include "integrator/aov/vectors.h"
#include "integrator/stages/camera.h"
#include "integrator/stages/light.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/shading_queues.h"
#include "integrator/stages/shadow.h"
#include "integrator/stages/surface.h"
#include "scene/surface.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lancer {

// Shares of light that are mirrored and transmitted, and their directions.
struct alignas(64) BranchBlock {
  Floats reflected[3], refracted[3], mirrored[3], through[3];
  uint32_t mirrors = 0, refracts = 0; // bits of lanes: the direction is on its proper side of the surface
};

// One lamp's irradiance at normal incidence.
struct alignas(64) IrradianceBlock {
  Floats irradiance[3];
  uint32_t there = 0; // bits of lanes that have a sample
};

struct ClassicKernel {
  // Computes the mirrored and the transmitted share and their directions.
  void (*branch)(const LobeBlock &lobes, BranchBlock &branches);
  // Computes the light of samples of one light without occlusion, and without the branch's weight. hidden_from: RayKind
  // bits of the rays that do not see the light.
  void (*illuminate)(const SurfaceBlock &surfaces, const LobeBlock &lobes, const LightSamples &samples,
                     const ClassicLight &light, uint32_t hidden_from, LitBlock &lit, IrradianceBlock &irradiance);
  // Computes the members of LitBlock that shadow rays need, for samples on the viewer's side of the surface.
  void (*aim)(const SurfaceBlock &surfaces, const LobeBlock &lobes, const LightSamples &samples, LitBlock &lit);
};
LANCER_DECLARE_KERNEL(ClassicKernel, classic_kernel)

// The light of a batch's rays: add() may be called in any order; of() returns the light of each ray for a sum in the order of
// the rays.
class LightByRay {
public:
  void begin(size_t rays) {
    found_.clear();
    ends_.assign(rays + 1, 0u);
  }
  void add(uint32_t ray, const glm::vec3 &light) {
    found_.push_back({ray, light});
    ++ends_[ray + 1];
  }
  // Call after the last add().
  void sort() {
    for (size_t i = 1; i < ends_.size(); ++i)
      ends_[i] += ends_[i - 1];
    sorted_.resize(found_.size());
    // The start of each ray's light becomes its end.
    for (const Found &found : found_)
      sorted_[ends_[found.ray]++] = found.light;
  }
  // Returns the light added for a ray, in the order of add().
  std::span<const glm::vec3> of(size_t ray) const {
    const uint32_t begin = ray == 0 ? 0 : ends_[ray - 1];
    return std::span(sorted_).subspan(begin, ends_[ray] - begin);
  }
  bool empty() const { return found_.empty(); }

private:
  struct Found {
    uint32_t ray;
    glm::vec3 light;
  };

  std::vector<Found> found_;
  std::vector<uint32_t> ends_;
  std::vector<glm::vec3> sorted_;
};

// Flat shading as in the course's texts: one colour for each polygon, computed at its centre.

inline bool is_flat(const Instance &instance) { return instance.kind == ShapeKind::Mesh && instance.shading == Shading::Flat; }

// Returns the surface at the centre of the hit polygon, with the polygon's normal. The instance must satisfy is_flat().
// time: of the ray.
Surface surface_at_center(const Scene &scene, const Hit &hit, float time);

class ClassicIntegrator final : public Integrator {
public:
  ClassicIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  const char *name() const override { return "classic"; }

private:
  // A ray of the recursion; all rays of one depth are traced together.
  struct Branch {
    glm::vec3 weight{1.0f}; // throughput
    uint32_t sample = 0;
    uint32_t depth = 0;
    uint32_t kinds = RayKind::Camera; // of the ray
    uint32_t crossings = 0;           // transparent surfaces passed
    bool seen = false;                // the first surface has been recorded
    double passed = 0.0;              // t of the camera ray up to its last crossing
    DenoisingGuides guides{};
  };
  // Results of shading a ray's vertex, kept until its light is summed: vertices are shaded in the order of their code, but a
  // pixel's sum has the order of the rays.
  struct Vertex {
    bool nothing = false; // a hole in the picture
    bool mirrors = false, refracts = false;
    uint32_t instance = kNone, primitive = kNone;
    glm::dvec3 p{0.0}; // shaded place; members as in Surface
    double offset = 0.0;
    float time = kMiddleTime;
    glm::vec3 ng{0.0f};
    glm::vec3 emission{0.0f}, ambient{0.0f}, transmittance{0.0f}; // ambient: Ka
    glm::vec3 reflected{0.0f}, refracted{0.0f}, mirrored{0.0f}, through{0.0f};
  };
  // Results of shading a vertex that the denoising guides read.
  struct GuidesOf {
    Mixture<float> mixture;
    glm::vec3 wo{0.0f};
  };

  bool run_part(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  void shade(std::span<SampleResult> results);
  void put_in_lane(size_t number, const MaterialView &material, std::span<SampleResult> results);
  void put_number(uint32_t lane, size_t number, const MaterialView &material);
  void shade_block(std::span<SampleResult> results);
  void cut_holdouts(std::span<SampleResult> results);
  void record(std::span<SampleResult> results);
  void store_vertex(uint32_t lane);
  void sample(uint32_t number, const Doubles (&p)[3], const Floats (&ng)[3]);
  void illuminate(uint32_t number);
  glm::vec3 own_light(uint32_t number, uint32_t lane, float share) const;
  void light_block();
  void light_corners();
  void move_to_corner(uint32_t corner);
  void send_shadow(uint32_t number, uint32_t lane, const glm::vec3 &light);
  void gather(size_t number, SampleResult &result, std::vector<PathVertex> *trace);
  void trace_vertex(size_t number, const SampleResult &result, std::vector<PathVertex> &trace) const;
  void miss(const Branch &branch, const glm::dvec3 &eye, const glm::vec3 &direction, SampleResult &result);
  void add(const Branch &branch, const glm::vec3 &light, bool environment, SampleResult &result);
  void branch_out(size_t number, SampleResult &result);
  void spawn(Branch child, const Vertex &vertex, const glm::vec3 &direction, const glm::vec3 &weight, uint32_t kind,
             SampleResult &result);
  void push(const Branch &branch, Ray ray);
  glm::dvec3 view_of(const Branch &branch, const Ray &ray, const glm::dvec3 &p) const;
  glm::vec2 light_numbers(const Branch &branch, uint32_t light) const;
  const Branch &branch_of(uint32_t lane) const { return branches_[number_[lane]]; }

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  CameraStage generator_;
  LightStage light_;
  ShadowStage shadows_;
  LightPasses passes_;
  Vectors vectors_;
  ShadingQueues queues_;
  SurfaceStage surfaces_;
  const ClassicKernel &kernel_;
  VertexNumbers numbers_{};
  BranchBlock branched_{};
  LitBlock lit_block_{};
  IrradianceBlock irradiance_{};
  glm::vec3 ambient_; // ambient light for Ka
  ExtraLayout layout_;
  uint32_t first_ = 0;   // number of the part's first sample in the batch
  bool only_combined_;   // no other pass is requested
  bool corners_ = false; // the block's vertices are lit at the corners of their triangles
  bool crowded_ = false; // batches are rendered in small parts
  // By lane of the block.
  uint32_t number_[kBlockLanes]; // of the ray
  Hit lit_at_[kBlockLanes];      // the shaded place, where it differs from the hit
  // By light, corner and lane.
  struct CornerLight {
    glm::vec3 light{0.0f}, own{0.0f};
  };
  std::vector<CornerLight> corner_light_;
  std::vector<glm::vec4> sky_values_;   // of the world's nodes
  LightByRay own_light_, shadow_light_; // of lamps without occlusion, by Ka; of shadow rays
  std::vector<Sampler> samplers_;       // by number of the sample in the batch
  std::vector<Branch> branches_, next_branches_;
  std::vector<Ray> rays_, next_rays_;
  std::vector<Hit> hits_;
  std::vector<Vertex> lit_; // per ray
  std::vector<GuidesOf> guides_;
};

} // namespace lancer
