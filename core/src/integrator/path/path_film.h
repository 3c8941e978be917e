// The results of a batch of paths, with the indirect light that waits for clamping and the passes of the surfaces that the
// camera sees.
#pragma once

#include "integrator/aov/first_surface.h"
#include "integrator/aov/surface_extras.h"
#include "integrator/aov/vectors.h"
#include "integrator/path/catcher_film.h"
#include "integrator/path/path_state.h"
#include "integrator/sample.h"
#include "integrator/stages/hit.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/occlusion.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lancer {

class PathFilm {
public:
  PathFilm(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : passes(settings), scene_(scene), camera_(camera), settings_(settings), layout_(settings.extras()), catchers_(layout_),
        shader_(scene, &camera), cone_(camera), vectors_(scene, camera, settings),
        sky_values_(scene.world.program.value_count()) {}
  void set_splits(const Splits &splits) { settings_.splits = splits; }

  // Begins the next batch, whose results and extras are written to the given places. trace: receives the vertices; may be null.
  void begin(std::span<const SampleAddress> addresses, std::span<SampleResult> results, Extras &extras,
             std::vector<PathVertex> *trace);
  // Adds the indirect light to the results, clamped where the settings request it.
  void end();
  // Return the light gathered so far by a path, or by all paths of a sample.
  glm::vec3 gathered(const Path &path) const {
    const glm::vec3 before = path.split ? before_splitting(path.sample) : glm::vec3(0.0f);
    return results_[path.sample].radiance + before + indirect_[sum(path)];
  }
  glm::vec3 gathered(uint32_t sample) const {
    glm::vec3 sum = results_[sample].radiance;
    for (uint32_t i = 0; i < sums(); ++i)
      sum += indirect_[sample * sums() + i];
    return sum;
  }
  // Returns the number of the sum of indirect light that a path adds to, among its sample's sums.
  uint32_t sum_of(const Path &path) const { return path.split ? path.branch : sums() - 1; }

  // Adds light that a path transports to the camera: as seen directly while the path is in the camera's view, then as direct
  // light, and after a second scattering as indirect. environment: the light is the world's, which a transparent film hides.
  // group: of the light, 0 = none.
  void add(const Path &path, const glm::vec3 &radiance, bool environment, uint32_t group);
  // Fills the record of a lane's light sample that waits for its shadow ray. share: LitBlock::share; chosen: the light.
  void fill(WaitingLight &light, const Path &path, const Floats (&share)[2][3], uint32_t lane, uint32_t chosen) const;
  // Returns the record of light on the way of a path's ray. group: of the light.
  WaitingLight waiting(const Path &path, uint32_t group) const;
  // Adds the part of a light sample's contribution that its shadow ray transmits.
  void add_lit(const WaitingLight &waiting, const glm::vec3 &light);
  // Whether a path that hits this instance goes on as two, see CatcherFilm.
  bool splits_at(const Path &path, const Instance &instance) const {
    return catchers_.keeps() && instance.catcher && !instance.holdout && path.in_view && !path.caught && !path.of_catchers &&
           path.ghost == Ghost::None;
  }
  // Keeps the picture without the shadow catcher that a path meets.
  void meet_catcher(const Path &path) {
    catchers_.meet(path.sample, results_[path.sample], gathered(path.sample), mean(path.beta), *extras_);
  }
  // Adds the environment behind a shadow catcher to its pass alone.
  void add_behind(const Path &path, const glm::vec3 &radiance) {
    passes.add_seen(results_[path.sample], path.beta * radiance, true);
  }
  // Subtracts a share from the alpha of a sample.
  void cut(const Path &path, float share) { results_[path.sample].alpha -= share; }

  // Whether passes read a surface that ends a path.
  bool reads_end(const Path &path) const { return !only_combined_ && (trace_ || wants_guides(path) || wants_outputs(path)); }
  // Whether outputs of the surface that a path meets are wanted.
  bool wants_outputs(const Path &path) const { return layout_.has_outputs() && awaits_surface(path); }
  // Adds the outputs of a lane's surface, and those of the world where a path of the camera leaves the scene.
  void add_outputs(const Path &path, const SurfaceStage &surfaces, uint32_t lane) {
    lancer::add_outputs(layout_, path.sample, surfaces, lane, *extras_);
  }
  void add_sky_outputs(const Path &path, const Ray &ray, const glm::dvec3 &eye) {
    lancer::add_sky_outputs(scene_, camera_, settings_, path.sample, glm::normalize(ray.d), eye, path.light_path(0.0, 0.0),
                            sky_values_, *extras_);
  }
  // Fills the passes of a block's surfaces that the camera sees. number: of each lane's path; ends, nothing: bits of lanes that
  // scatter no light, and where a hole has left nothing. Returns the lanes that ask for ambient occlusion.
  uint32_t record(SurfaceStage &surfaces, std::span<const Path> paths, const size_t (&number)[kBlockLanes], uint32_t ends,
                  uint32_t nothing);
  // Counts the absent surfaces that ray `number` of the stage has passed before its hit, as if its path had passed them one by
  // one. Where the path reaches its limit, the hit becomes that surface.
  void pass_absent(Path &path, const Ray &ray, HitStage &stage, size_t number, Hit &hit);
  // Whether the first surface is still to come.
  bool awaits_surface(const Path &path) const {
    return path.in_view && path.leads && !only_combined_ && !records_[path.sample].seen;
  }
  // Records that a path passes straight through a surface at t.
  void pass_on(const Path &path, double t) {
    if (!only_combined_ && path.leads)
      records_[path.sample].depth += t;
  }
  // Subtracts the share of a transparent film from the alpha of a path that hits nothing. Returns whether picture or passes
  // show the environment there.
  bool miss(const Path &path, const Ray &ray);

  // Whether a path stays in the camera's view by its lane's next ray: the view continues through clear glass.
  bool stays_in_view(const ScatterBlock &next, uint32_t lane) const {
    return (next.transmitted >> lane & 1) && !(next.diffuse >> lane & 1) && settings_.clear_glass(next.alpha2[lane]);
  }
  // Sets the shares of `next`, into which `path` is scattered. The shares of the first scattering are kept; share:
  // ScatterBlock::share.
  void set_shares(const Path &path, const Path &next, const Floats (&share)[2][3], uint32_t lane);

  // Whether a path still looks for the surface of the denoising guides.
  bool wants_guides(const Path &path) const { return passes.guides() && path.leads && guides_[path.sample].open; }
  // distance: from the last surface, normalised units.
  void add_guides(const Path &path, const Mixture<float> &mixture, const glm::vec3 &wo, const glm::vec3 &transmittance,
                  double distance) {
    guides_[path.sample].scattered = path.scatterings > 0;
    add_denoising_guides(scene_, camera_, mixture, wo, transmittance, distance, guides_[path.sample], results_[path.sample]);
  }

  // Ambient occlusion: adds the open share, and keeps what the next ray takes from it.
  void add_open(const Path &path, const OcclusionStage::Open &open);
  // Subtracts the weight of each occluded next ray from the ambient occlusion of its first surface.
  void count_occluded(std::span<const Path> paths, std::span<const Ray> rays, std::span<const Hit> hits,
                      const OcclusionStage &occlusion);

  const LightPasses passes;
  Energy energy; // of the batch; changes of samples are complete at the end

private:
  // Sums of a sample: one for each of its paths and, if there are several, another one for the light found before the split.
  uint32_t sums() const { return settings_.splits.paths > 1 ? settings_.splits.paths + 1 : 1; }
  uint32_t sum(const Path &path) const { return path.sample * sums() + sum_of(path); }
  glm::vec3 before_splitting(uint32_t sample) const {
    return sums() > 1 ? indirect_[(sample + 1) * sums() - 1] : glm::vec3(0.0f);
  }
  // Sums of indirect light of a sample: one for each of its paths, and the light found before a split.
  using IndirectSums = std::span<glm::vec3>;
  IndirectSums indirect(uint32_t sample) { return IndirectSums(indirect_).subspan(size_t(sample) * sums(), sums()); }
  void clamp(uint32_t sample);
  // Adds light to its group. Where clamping is requested, indirect light waits for it.
  void add_to_group(uint32_t sample, uint32_t group, const glm::vec3 &light, bool indirect) {
    Extras &to = indirect && settings_.clamp_indirect > 0.0f ? indirect_groups_ : *extras_;
    to.add_light(layout_, sample, group, light);
  }
  void add_indirect_groups(uint32_t sample, const glm::vec3 &factor);
  glm::vec3 clamped_direct(const glm::vec3 &light, float parts, bool in_picture);
  void add_removed(uint32_t sample, Ghost ghost, const glm::vec3 &light);
  void record(const Path &path, const Surface &surface, const MaterialView &material, const glm::vec3 &normal,
              const glm::vec3 &opacity, double t);
  void record(const Path &path, const SurfaceStage &surfaces, uint32_t lane);
  void trace(const Path &path, const Surface &surface, double t);

  // State of a sample for the passes other than Combined. The record stays with the sample while the path moves to other
  // queues.
  struct Record {
    double depth = 0.0;     // t of the camera ray up to its last crossing
    bool seen = false;      // the first surface has been recorded
    float occlusion = 0.0f; // kept for the next ray
  };
  // The diffuse and the glossy share of the first scattering.
  struct Shares {
    glm::vec3 of[2];
  };

  const Scene &scene_;
  const Camera &camera_;
  IntegratorSettings settings_;
  ExtraLayout layout_;
  CatcherFilm catchers_;
  Shader shader_; // of absent surfaces
  PixelCone cone_;
  Vectors vectors_;
  Shaded absent_;
  std::vector<glm::vec4> sky_values_; // of the world's nodes
  std::vector<PathVertex> *trace_ = nullptr;
  Extras *extras_ = nullptr;
  Extras indirect_groups_;    // where clamping is requested
  bool only_combined_ = true; // this batch fills no pass but the picture: records stay unused
  std::span<SampleResult> results_;
  // Members indexed by the number of a sum.
  std::vector<glm::vec3> indirect_;
  std::vector<Shares> shares_;
  // Members indexed by the number of a sample in the batch, like results_.
  std::vector<Record> records_;
  std::vector<DenoisingGuides> guides_; // where passes for denoising are requested
  // Light that filter_glossy and Fast GI take away, where they are on.
  std::vector<float> filtered_, guessed_;
};

// Returns the opacity with which passes count a surface: Cycles' passes count the whole surface of a holdout object.
inline glm::vec3 recorded_opacity(const SurfaceStage &surfaces, uint32_t lane) {
  return surfaces.holes() >> lane & 1 ? glm::vec3(1.0f) : surfaces.opacity(lane);
}

// The light found by the last bounces of a batch, from which the light beyond the limit on bounces is estimated.
class LastBounces {
public:
  explicit LastBounces(uint32_t max_bounces) : max_bounces_(max_bounces) {}

  void begin() {
    samples_.clear();
    stage_ = 0;
    before_[0] = before_[1] = {};
  }
  // Whether note() must be called in this turn of the queues. Each transparent surface delays a path by one turn. The path's
  // light then counts as that of a later bounce, so the estimate is too large rather than too small.
  bool due(uint32_t turn) const { return turn + 1 >= max_bounces_ && stage_ < 2; }
  // Stores the sum of the light gathered so far. Must be called after the light of this turn's hits is added. sample(i):
  // returns the sample of path i, one of count; shared: several paths may have the same sample; light(sample): returns the
  // light that the sample has gathered.
  template <class SampleOf, class Light> void note(uint32_t turn, size_t count, bool shared, SampleOf &&sample, Light &&light) {
    if (stage_ == 0)
      for (size_t i = 0; i < count; ++i)
        samples_.push_back(sample(i));
    if (stage_ == 0 && shared) {
      std::sort(samples_.begin(), samples_.end());
      samples_.erase(std::unique(samples_.begin(), samples_.end()), samples_.end());
    }
    // With max_bounces of 0, only the light before the last bounce is noted at first.
    stage_ = turn + 1 == max_bounces_ ? 1 : 2;
    before_[stage_ - 1] = sum(light);
  }
  template <class Light> void end(Light &&light, Energy &energy) const {
    if (stage_ == 0)
      return;
    const ExactSum all = sum(light);
    energy.before_last += stage_ == 2 ? before_[1] : all;
    energy.before_last -= before_[0];
    if (stage_ == 2) {
      energy.last += all;
      energy.last -= before_[1];
    }
  }

private:
  // Skips samples that are not finite, because the film drops them.
  template <class Light> ExactSum sum(Light &&light) const {
    ExactSum result;
    for (const uint32_t sample : samples_) {
      const float level = luminance(light(sample));
      result += std::isfinite(level) ? level : 0.0f;
    }
    return result;
  }

  uint32_t max_bounces_, stage_ = 0;
  ExactSum before_[2];
  std::vector<uint32_t> samples_; // of the unfinished paths
};

} // namespace lancer
