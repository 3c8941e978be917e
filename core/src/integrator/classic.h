// The course's recursive ray tracer: direct light of every lamp, mirror reflection and refraction, nothing left to chance.
#pragma once

#include "integrator/camera_rays.h"
#include "integrator/course_kernel.h"
#include "integrator/course_light.h"
#include "integrator/course_materials.h"
#include "integrator/denoising_features.h"
#include "integrator/light_passes.h"
#include "integrator/sample.h"
#include "integrator/scene_lights.h"
#include "integrator/shading.h"
#include "integrator/shadow.h"

namespace lancer {

// What the course's kernels work on.
struct ClassicLanes {
  explicit ClassicLanes(const Scene &scene);

  const CourseKernel &kernel;
  std::vector<WideCourse> materials; // by number
  std::vector<CourseLamp> lamps;     // by number
  CourseBlock block;
  std::vector<CourseLit> lit;         // by lamp
  uint32_t material_of[kCourseLanes]; // number
  std::vector<uint8_t> known;         // of the rays that fill the block: it took them
};

class ClassicIntegrator final : public Integrator {
public:
  ClassicIntegrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), camera_(camera), settings_(settings), generator_(camera, settings), shader_(scene, &camera),
        shadows_(scene, camera, settings), cone_(camera), passes_(settings), ambient_(ambient_light(scene, camera)) {
    // Kernels make the picture and what the first surface says, nothing else.
    if (!settings.all_features && !settings.environment_reflections && !passes_.wanted() && !passes_.mist() &&
        !passes_.features())
      lanes_ = std::make_unique<ClassicLanes>(scene);
  }

  void run(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace) override;
  const char *kernel() const override { return "classic"; }

private:
  // A ray of the recursion; all of one depth are traced together.
  struct Branch {
    glm::vec3 weight{1.0f}; // of what it brings back
    uint32_t slot = 0;
    uint32_t depth = 0;
    uint32_t kinds = LANCER_RAY_CAMERA; // of the ray
    uint32_t layers = 0;                // passed straight through
    bool seen = false;                  // the first surface has been recorded
    double passed = 0.0;                // t of the camera ray up to its last layer
    DenoisingFeatures features{};
  };

  bool run_part(std::span<const SampleAddress> addresses, std::span<SampleResult> results, std::vector<PathVertex> *trace);
  void generate(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  void shade(const Branch &branch, const Ray &ray, const Hit &hit, SampleResult &result, std::vector<PathVertex> *trace);
  void shade_lanes(std::span<SampleResult> results);
  const WideCourse *for_lanes(const Hit &hit) const;
  void put_in_lane(size_t number, const WideCourse &material);
  void light_lanes(size_t begin, size_t end);
  void sample_lamp(uint32_t number, const Branch &branch, uint32_t lane, CourseLit &lit);
  void send_shadow(uint32_t number, uint32_t lane, const Branch &branch, const Hit &hit);
  void add_own_light(uint32_t lane, const Branch &branch, const Material &material, SampleResult &result);
  Surface surface_of(uint32_t lane, const Hit &hit) const;
  void leave_lane(uint32_t lane, const Branch &branch, const Hit &hit, SampleResult &result);
  void miss(const Branch &branch, const glm::dvec3 &eye, const glm::vec3 &direction, SampleResult &result);
  void record(Branch &branch, const Surface &surface, double t, SampleResult &result);
  void add(const Branch &branch, const glm::vec3 &light, bool environment, SampleResult &result);
  void add_direct_light(const Branch &branch, const Surface &surface, const Ray &ray, const Hit &hit, SampleResult &result);
  void branch_out(const Branch &branch, const Surface &surface, const Surface &met, const Ray &ray, const Hit &hit,
                  SampleResult &result);
  void spawn(Branch child, const Surface &surface, const glm::vec3 &direction, const glm::vec3 &weight, uint32_t kind,
             SampleResult &result);
  void push(const Branch &branch, Ray ray);
  glm::dvec3 view_of(const Branch &branch, const Ray &ray, const glm::dvec3 &p) const;
  glm::vec2 lamp_numbers(const Branch &branch, uint32_t light) const;

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  RayGenerator generator_;
  Shader shader_;
  ShadowQueue shadows_;
  PixelCone cone_;
  LightPasses passes_;
  glm::vec3 ambient_;                   // light from everywhere, for Ka
  std::unique_ptr<ClassicLanes> lanes_; // null: surfaces are shaded one by one
  Shaded point_;                        // of the surface at hand
  Shaded corners_[3];                   // of its triangle, under Gouraud shading
  bool crowded_ = false;                // batches are done in small parts
  std::vector<Sampler> samplers_;       // per slot
  std::vector<Branch> branches_, next_branches_;
  std::vector<Ray> rays_, next_rays_;
  std::vector<Hit> hits_;
};

} // namespace lancer
