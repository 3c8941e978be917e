// The results of a batch of paths, with the indirect light that waits for clamping and the passes of the surfaces that the
// camera sees.
#pragma once

#include "integrator/aov/first_surface.h"
#include "integrator/path/path_state.h"
#include "integrator/sample.h"
#include "integrator/stages/light_passes.h"

namespace lancer {

class PathFilm {
public:
  PathFilm(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : passes(settings), scene_(scene), camera_(camera), settings_(settings) {}
  void set_splits(const Splits &splits) { settings_.splits = splits; }

  // Begins the next batch, whose results are written to the given span.
  void begin(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  // Adds the indirect light to the results, clamped where the settings request it.
  void end();
  // Return the light gathered so far by a path, or by all paths of a sample.
  glm::vec3 gathered(const Path &path) const {
    const glm::vec3 before = path.split ? before_splitting(path.slot) : glm::vec3(0.0f);
    return results_[path.slot].radiance + before + indirect_[place(path)];
  }
  glm::vec3 gathered(uint32_t slot) const {
    glm::vec3 sum = results_[slot].radiance;
    for (uint32_t i = 0; i < places(); ++i)
      sum += indirect_[slot * places() + i];
    return sum;
  }
  // Returns the place where a path gathers its light, counted from its sample's first place.
  uint32_t place_of(const Path &path) const { return path.split ? path.branch : places() - 1; }

  // Adds light that a path transports to the camera.
  void add(const Path &path, const glm::vec3 &radiance, bool environment);
  // Adds the part of a light sample's contribution that its shadow ray transmits.
  void add_lit(const WaitingLight &waiting, const glm::vec3 &light);
  // Subtracts a share from the alpha of a sample.
  void cut(const Path &path, float share) { results_[path.slot].alpha -= share; }

  // Whether no pass but the picture is requested: records stay unused.
  bool only_combined() const { return only_combined_; }
  // Fills the passes that describe the camera's view. t: of the ray, from the last surface that it passed.
  void record(const Path &path, const Surface &surface, const Material &material, const glm::vec3 &normal,
              const glm::vec3 &opacity, double t);
  // Whether the first surface is still to come.
  bool awaits_surface(const Path &path) const {
    return path.in_view && path.leads && !only_combined_ && !records_[path.slot].seen;
  }
  // Adds the colour of a surface for a component.
  void add_color(const Path &path, uint32_t component, const glm::vec3 &color) {
    results_[path.slot].light[kLightComponents + 3 * component + 2] += path.beta * color;
  }
  // Records that a path passes straight through a surface at t.
  void pass_on(const Path &path, double t) {
    if (!only_combined_ && path.leads)
      records_[path.slot].depth += t;
  }
  // Records that a path hits nothing.
  void miss(const Path &path);

  // The shares of the first scattering by component. The caller sets them when a path leaves the camera's view.
  glm::vec3 (&shares(const Path &path))[2] { return shares_[place(path)].of; }

  // Whether a path still looks for the surface of the denoising guides.
  bool wants_guides(const Path &path) const { return passes.features() && path.leads && guides_[path.slot].open; }
  // distance: from the last surface, normalised units.
  void add_guides(const Path &path, const Mixture<float> &mixture, const glm::vec3 &wo, const glm::vec3 &transmittance,
                  double distance) {
    add_denoising_guides(scene_, camera_, mixture, wo, transmittance, distance, guides_[path.slot], results_[path.slot]);
  }

  // Ambient occlusion: the unoccluded share so far, and the part that the next ray subtracts if it is occluded.
  void add_open(const Path &path, const glm::vec3 &weight) { results_[path.slot].light[kLightOcclusion] += weight; }
  void keep_occlusion(const Path &path, float occlusion) { records_[path.slot].occlusion = occlusion; }
  float take_occlusion(const Path &path) { return std::exchange(records_[path.slot].occlusion, 0.0f); }

  const LightPasses passes;
  Energy energy; // of the batch

private:
  // Places of a sample: one for each of its paths and, if there are several, another one for the light found before the split.
  uint32_t places() const { return settings_.splits.paths > 1 ? settings_.splits.paths + 1 : 1; }
  uint32_t place(const Path &path) const { return path.slot * places() + place_of(path); }
  glm::vec3 before_splitting(uint32_t slot) const {
    return places() > 1 ? indirect_[(slot + 1) * places() - 1] : glm::vec3(0.0f);
  }
  void clamp(uint32_t slot);

  // State of a sample for the passes other than Combined. The record stays at the sample's slot while the path moves to other
  // queues.
  struct Record {
    double depth = 0.0;     // t of the camera ray up to its last layer
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
  bool only_combined_ = true;
  std::span<SampleResult> results_;
  // By place.
  std::vector<glm::vec3> indirect_;
  std::vector<Shares> shares_;
  // By slot, like results_.
  std::vector<Record> records_;
  std::vector<DenoisingGuides> guides_; // where passes for denoising are requested
};

} // namespace lancer
