#include "integrator/path/path_film.h"

#include "sampling/color.h"

namespace lancer {

void PathFilm::begin(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  // Only the first samples of pixels tell of places.
  only_combined_ = passes.only_places() && (!passes.places() || addresses.front().sample > 0);
  results_ = results;
  energy = {};
  indirect_.assign(results.size(), glm::vec3(0.0f));
  shares_.resize(results.size());
  if (!only_combined_ || records_.size() != results.size())
    records_.assign(results.size(), Record());
  if (passes.features())
    guides_.assign(results.size(), begin_guides(settings_, true));
}

void PathFilm::end() {
  for (size_t slot = 0; slot < results_.size(); ++slot) {
    glm::vec3 indirect = indirect_[slot];
    const float top = largest(indirect);
    if (settings_.clamp_indirect > 0.0f && top > settings_.clamp_indirect) {
      energy.clip(double(luminance(indirect)) * (1.0 - double(settings_.clamp_indirect / top)));
      indirect *= settings_.clamp_indirect / top;
      passes.scale_indirect(results_[slot], settings_.clamp_indirect / top);
    }
    results_[slot].radiance += indirect;
  }
}

void PathFilm::add(const Path &path, const glm::vec3 &radiance, bool environment) {
  SampleResult &result = results_[path.slot];
  // Light that was scattered at most once is direct; clamping never touches it.
  const bool indirect = path.scatterings > 1;
  if (wants_guides(path))
    result.albedo += guides_[path.slot].beta * radiance;
  // What the camera sees through clear glass is in no pass of indirect light: clamp it by itself.
  if (path.in_view) {
    const float top = largest(radiance), limit = settings_.clamp_indirect;
    const glm::vec3 seen = indirect && limit > 0.0f && top > limit ? radiance * (limit / top) : radiance;
    energy.clip(double(luminance(radiance - seen)));
    result.radiance += seen;
    passes.add_seen(result, seen, environment);
    return;
  }
  if (indirect)
    indirect_[path.slot] += radiance;
  else
    result.radiance += radiance;
  passes.add(result, radiance, shares_[path.slot].of, indirect);
}

void PathFilm::add_lit(const WaitingLight &waiting, const glm::vec3 &light) {
  SampleResult &result = results_[waiting.slot];
  if (waiting.occlusion) {
    result.light[kLightOcclusion] += light;
    return;
  }
  if (waiting.indirect)
    indirect_[waiting.slot] += light;
  else
    result.radiance += light;
  passes.add(result, light, waiting.share, waiting.indirect);
}

void PathFilm::record(const Path &path, const Surface &surface, const Material &material, const glm::vec3 &normal,
                      const glm::vec3 &opacity, double t) {
  SampleResult &result = results_[path.slot];
  // A surface that is hardly there gives way to the next one, unless the path ends on it.
  Record &record = records_[path.slot];
  const bool here = !record.seen && mean(opacity) >= settings_.alpha_threshold;
  // The first sample of a pixel tells the place.
  if (!record.seen && path.sampler.sample() == 0)
    record_place(scene_, surface, &material, record.depth + t, result);
  if (here)
    record_first_surface(scene_, settings_, surface, normal, result);
  record.seen |= here;
  if (passes.mist())
    result.mist += (1.0f - mist_at(scene_, camera_, settings_, surface)) * mean(path.beta * opacity);
}

void PathFilm::miss(const Path &path) {
  SampleResult &result = results_[path.slot];
  if (awaits_surface(path))
    forget_place(result);
  if (path.scatterings == 0 && passes.features())
    add_sky_guides(guides_[path.slot], result);
}

} // namespace lancer
