#include "integrator/path/path_film.h"

#include "sampling/color.h"

#include <algorithm>

namespace lancer {

void PathFilm::begin(std::span<const SampleAddress> addresses, std::span<SampleResult> results) {
  // Passes of places are recorded from the first sample of each pixel alone.
  only_combined_ = passes.only_places() && (!passes.places() || addresses.front().sample > 0);
  results_ = results;
  energy = {};
  indirect_.assign(results.size() * places(), glm::vec3(0.0f));
  shares_.resize(indirect_.size());
  if (!only_combined_ || records_.size() != results.size())
    records_.assign(results.size(), Record());
  if (passes.features())
    guides_.assign(results.size(), begin_guides(settings_, true));
}

void PathFilm::end() {
  for (uint32_t slot = 0; slot < results_.size(); ++slot) {
    if (settings_.clamp_indirect > 0.0f)
      clamp(slot);
    for (uint32_t i = 0; i < places(); ++i)
      results_[slot].radiance += indirect_[slot * places() + i];
  }
}

// Clamps the light of each path of a sample as if the path were the only one: its own light times the number of paths, plus the
// shared light.
void PathFilm::clamp(uint32_t slot) {
  const auto paths = float(settings_.splits.paths);
  const glm::vec3 shared = before_splitting(slot);
  glm::vec3 all(0.0f), kept(0.0f);
  float factor = 1.0f;
  for (uint32_t branch = 0; branch < settings_.splits.paths; ++branch) {
    const glm::vec3 found = shared + paths * indirect_[slot * places() + branch];
    float share = 1.0f;
    if (const float top = largest(glm::abs(found)); top > settings_.clamp_indirect) {
      factor = share = settings_.clamp_indirect / top;
      energy.clip(double(luminance(found)) * (1.0 - double(share)) / double(paths));
    }
    all += found;
    kept += found * share;
  }
  if (factor == 1.0f)
    return;
  std::fill_n(indirect_.begin() + ptrdiff_t(slot * places()), places(), glm::vec3(0.0f));
  indirect_[slot * places()] = kept / paths;
  // Passes store the sum over the paths: scale them by the mean factor.
  glm::vec3 of_passes(factor);
  for (int channel = 0; channel < 3 && places() > 1; ++channel)
    of_passes[channel] = all[channel] != 0.0f ? kept[channel] / all[channel] : 1.0f;
  passes.scale_indirect(results_[slot], of_passes);
}

void PathFilm::add(const Path &path, const glm::vec3 &radiance, bool environment) {
  SampleResult &result = results_[path.slot];
  // Light that was scattered at most once is direct; clamping never changes it.
  const bool indirect = path.scatterings > 1;
  // A transparent film leaves the environment behind it to the environment's pass: picture and guides have none of it.
  const bool hidden = environment && settings_.film_transparent && path.in_view;
  if (wants_guides(path) && !hidden)
    // The leader stands for all paths that share its weight.
    result.albedo += float(path.sharers) * guides_[path.slot].beta * radiance;
  // Light seen through clear glass is in no pass of indirect light: clamp it separately.
  if (path.in_view) {
    const float top = largest(glm::abs(radiance)), limit = settings_.clamp_indirect / float(path.sharers);
    const glm::vec3 seen = indirect && limit > 0.0f && top > limit ? radiance * (limit / top) : radiance;
    if (!hidden) {
      energy.clip(double(luminance(radiance - seen)));
      result.radiance += seen;
    }
    passes.add_seen(result, seen, environment);
    return;
  }
  if (indirect)
    indirect_[place(path)] += radiance;
  else
    result.radiance += radiance;
  passes.add(result, radiance, shares_[place(path)].of, indirect);
}

void PathFilm::add_lit(const WaitingLight &waiting, const glm::vec3 &light) {
  SampleResult &result = results_[waiting.slot];
  if (waiting.occlusion) {
    result.light[kLightOcclusion] += light;
    return;
  }
  if (waiting.indirect)
    indirect_[waiting.slot * places() + waiting.place] += light;
  else
    result.radiance += light;
  passes.add(result, light, waiting.share, waiting.indirect);
}

void PathFilm::record(const Path &path, const Surface &surface, const Material &material, const glm::vec3 &normal,
                      const glm::vec3 &opacity, double t) {
  SampleResult &result = results_[path.slot];
  // The first surface with enough opacity is recorded.
  Record &record = records_[path.slot];
  const bool here = path.leads && !record.seen && mean(opacity) >= settings_.alpha_threshold;
  // Place passes use the first sample of a pixel.
  if (path.leads && !record.seen && path.is_first(settings_.splits.paths))
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
