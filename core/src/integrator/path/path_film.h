// Where paths bring what they find: the results of a batch, with the light that is kept back until clamping and what passes say
// of the surfaces that the camera sees.
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

  // Takes the results of the next batch.
  void begin(std::span<const SampleAddress> addresses, std::span<SampleResult> results);
  // Joins the indirect light, clamped if that was asked for.
  void end();
  // Found so far: by a path, and by all paths of a sample.
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
  // Where a path gathers what it finds, counted from its sample's first place.
  uint32_t place_of(const Path &path) const { return path.split ? path.branch : places() - 1; }

  // Light that a path brings to the camera.
  void add(const Path &path, const glm::vec3 &radiance, bool environment);
  // Light that its shadow ray has let pass.
  void add_lit(const WaitingLight &waiting, const glm::vec3 &light);
  // A hole in the picture, of so much of what it shows.
  void cut(const Path &path, float share) { results_[path.slot].alpha -= share; }

  // No other pass than the picture is asked for: records stay as they are.
  bool only_combined() const { return only_combined_; }
  // Fills the passes that describe what the camera sees. t: of the ray, from the last surface that it passed.
  void record(const Path &path, const Surface &surface, const Material &material, const glm::vec3 &normal,
              const glm::vec3 &opacity, double t);
  // Whether the first surface is still to come.
  bool awaits_surface(const Path &path) const {
    return path.in_view && path.leads && !only_combined_ && !records_[path.slot].seen;
  }
  // Adds the colour that a surface shows by a component.
  void add_color(const Path &path, uint32_t component, const glm::vec3 &color) {
    results_[path.slot].light[kLightComponents + 3 * component + 2] += path.beta * color;
  }
  // A path goes straight on behind a surface at t.
  void pass_on(const Path &path, double t) {
    if (!only_combined_ && path.leads)
      records_[path.slot].depth += t;
  }
  // A path meets nothing.
  void miss(const Path &path);

  // Shares of light by component, of the first scattering: given where a path leaves what the camera sees.
  glm::vec3 (&shares(const Path &path))[2] { return shares_[place(path)].of; }

  // Whether a path still looks for the surface that denoisers are told of.
  bool wants_guides(const Path &path) const { return passes.features() && path.leads && guides_[path.slot].open; }
  // distance: from the last surface, normalised units.
  void add_guides(const Path &path, const Mixture<float> &mixture, const glm::vec3 &wo, const glm::vec3 &transmittance,
                  double distance) {
    add_denoising_guides(scene_, camera_, mixture, wo, transmittance, distance, guides_[path.slot], results_[path.slot]);
  }

  // Ambient occlusion: what is open so far, and what the next ray takes from it if it is blocked.
  void add_open(const Path &path, const glm::vec3 &weight) { results_[path.slot].light[kLightOcclusion] += weight; }
  void keep_occlusion(const Path &path, float occlusion) { records_[path.slot].occlusion = occlusion; }
  float take_occlusion(const Path &path) { return std::exchange(records_[path.slot].occlusion, 0.0f); }

  const LightPasses passes;
  Energy energy; // of the batch

private:
  // Places of a sample: of each of its paths, and behind them, where there are several, of what was found before they split.
  uint32_t places() const { return settings_.splits.paths > 1 ? settings_.splits.paths + 1 : 1; }
  uint32_t place(const Path &path) const { return path.slot * places() + place_of(path); }
  glm::vec3 before_splitting(uint32_t slot) const {
    return places() > 1 ? indirect_[(slot + 1) * places() - 1] : glm::vec3(0.0f);
  }
  void clamp(uint32_t slot);

  // What only passes beside the picture ask of a sample: it stays in its place while the path moves on.
  struct Record {
    double depth = 0.0;     // t of the camera ray up to its last layer
    bool seen = false;      // the first surface has been recorded
    float occlusion = 0.0f; // kept for the next ray
  };
  // Of the light that came by the first scattering: what is diffuse, glossy.
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
  // By slot, like results.
  std::vector<Record> records_;
  std::vector<DenoisingGuides> guides_; // where passes for denoising are asked for
};

} // namespace lancer
