// The first hits of a bake, in place of camera rays and their hits: each sample begins at a random place of its texel, seen
// from above, from the camera's place, or not at all, for its view of the sky.
//
// In: addresses of samples; the bake of the settings. Out: rays in the normalised world and their hits; the sampler of each
// sample; results, cleared, with alpha 1, or 0 for an empty texel. Caller: PATH.
#pragma once

#include "compile/scene.h"
#include "integrator/sample.h"
#include "integrator/stages/numbers.h"
#include "scene/bake.h"
#include "scene/camera.h"

#include <span>
#include <vector>

namespace lancer {

class TexelStage {
public:
  // settings.bake must be set; all must outlive the stage.
  TexelStage(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
      : scene_(scene), camera_(camera), bake_(*settings.bake), seed_(settings.seed) {}

  // Begins every sample: clears its result and calls begin(sample, sampler), which returns the ray to fill, unless the texel is
  // empty. hits: of the rays, in their order; a hit that is not valid lets the ray see the sky.
  template <class Begin>
  void start(std::span<const SampleAddress> addresses, bool with_light, std::span<SampleResult> results, std::vector<Hit> &hits,
             Begin &&begin) {
    hits.clear();
    widths_.assign(addresses.size(), 0.0f);
    for (size_t i = 0; i < addresses.size(); ++i) {
      const SampleAddress &address = addresses[i];
      std::construct_at(&results[i], with_light);
      const Texel &texel = bake_.texels[size_t(camera_.y + address.y) * camera_.width + camera_.x + address.x];
      if (texel.primitive == kNone || bake_.instance == kNone)
        continue;
      results[i].alpha = 1.0f;
      const Sampler sampler(seed_, camera_.x + address.x, camera_.y + address.y, address.sample);
      Ray &ray = begin(uint32_t(i), sampler);
      hits.push_back(aim(texel, sampler, ray));
      widths_[i] = width_of(texel);
    }
  }
  // Returns the radius of the texel of a sample of the last start(), normalised units.
  float width(uint32_t sample) const { return widths_[sample]; }

private:
  Hit aim(const Texel &texel, const Sampler &sampler, Ray &ray);
  glm::dvec3 view_direction(const Surface &surface) const;
  float width_of(const Texel &texel) const;

  const Scene &scene_;
  const Camera &camera_;
  const Bake &bake_;
  uint32_t seed_;
  std::vector<float> widths_; // by sample
};

} // namespace lancer
