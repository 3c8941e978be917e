#include "render/tile_worker.h"

#include "integrator/stages/light_passes.h"

#include <algorithm>
#include <chrono>

namespace lancer {

namespace {

// Samples of one call of the integrator: enough to fill the queues without leaving the second-level cache.
constexpr uint32_t kBatch = 1024;
// A batch for the film takes more samples of the covered pixels where some pixels of a tile are not covered. Its results,
// including those of uncovered pixels, are at most this many times kBatch, unless one sample of each pixel is more.
constexpr uint32_t kMostBatches = 2;

// Returns a sample that contains only the hit of the camera ray.
SampleResult place_of(const SampleResult &result) {
  SampleResult place(true);
  place.depth = result.depth;
  place.position = result.position;
  place.object_index = result.object_index;
  place.material_index = result.material_index;
  return place;
}

} // namespace

TileWorker::TileWorker(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
    : settings_(settings), with_light_(LightPasses(settings).wanted()), integrator_(make_integrator(scene, camera, settings)),
      layout_(settings.extras()) {}

void TileWorker::render(Film &film, Film::Tile &tile, uint32_t end, const Background &background,
                        const std::function<void(uint64_t samples)> &count) {
  const uint32_t pixels = tile.pixels();
  if (pixels == 0)
    return;
  struct Clock {
    Film::Tile &of;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Clock() {
      const std::lock_guard lock(of.mutex);
      of.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
  } const clock{tile};
  // Find the covered pixels.
  covered_.clear();
  for (uint32_t pixel = 0; pixel < pixels; ++pixel)
    if (const glm::uvec2 place = tile.place(pixel); background.coverage.covers(place.x, place.y))
      covered_.push_back(pixel);
  const auto covered = uint32_t(covered_.size());
  if (covered == 0) {
    const uint32_t samples = end - tile.next();
    film.add_even(tile, samples, background.sample, background.extras);
    return count(uint64_t(samples) * pixels);
  }
  const uint32_t per_batch = std::max(1u, std::min(kBatch / covered, kMostBatches * kBatch / pixels));
  while (tile.next() < end && !settings_.cancelled()) {
    // Render the next samples of all covered pixels.
    const uint32_t samples = std::min(per_batch, end - tile.next());
    render_batch(tile, samples);
    if (settings_.cancelled())
      return;
    drop_invalid(film, tile);
    film.add(tile, samples, all_pixels(tile, samples, background.sample), extras_of_pixels(tile, samples, background.extras));
    count(uint64_t(samples) * pixels);
    publish();
  }
}

void TileWorker::render_batch(const Film::Tile &tile, uint32_t samples) {
  addresses_.clear();
  for (uint32_t s = 0; s < samples; ++s)
    for (const uint32_t pixel : covered_) {
      const glm::uvec2 place = tile.place(pixel);
      addresses_.push_back({place.x, place.y, tile.next() + s});
    }
  results_.resize(addresses_.size());
  rays_before_ = integrator_->counts();
  vertices_before_ = integrator_->vertices();
  batch_energy_ = {};
  extras_.channels.clear();
  extras_.mattes.clear();
  // Large tiles pass through the integrator in several batches.
  for (size_t begin = 0; begin < addresses_.size(); begin += kBatch) {
    const size_t size = std::min<size_t>(kBatch, addresses_.size() - begin);
    integrator_->run(std::span(addresses_).subspan(begin, size), std::span(results_).subspan(begin, size), nullptr);
    batch_energy_ += integrator_->energy();
    const Extras &found = integrator_->extras();
    extras_.channels.insert(extras_.channels.end(), found.channels.begin(), found.channels.end());
    for (MatteShare matte : found.mattes) {
      matte.sample += uint32_t(begin);
      extras_.mattes.push_back(matte);
    }
  }
  if (settings_.exposure != 1.0f) {
    for (SampleResult &result : results_)
      expose(result, settings_.exposure, with_light_);
    extras_.expose(layout_, settings_.exposure);
  }
}

void TileWorker::drop_invalid(Film &film, Film::Tile &tile) {
  for (size_t i = 0; i < results_.size(); ++i) {
    float *const extras = layout_.channels() > 0 ? extras_.channels.data() + i * layout_.channels() : nullptr;
    if (film.finite(results_[i], extras))
      continue;
    results_[i] = place_of(results_[i]);
    std::fill_n(extras, layout_.channels(), 0.0f);
    std::erase_if(extras_.mattes, [&](const MatteShare &matte) { return matte.sample == i; });
    film.drop(tile, addresses_[i]);
  }
}

// Returns the results of all pixels: those of covered pixels, and the background in the others.
std::span<const SampleResult> TileWorker::all_pixels(const Film::Tile &tile, uint32_t samples, const SampleResult &background) {
  const uint32_t pixels = tile.pixels();
  if (covered_.size() == pixels)
    return results_;
  spread_.assign(size_t(samples) * pixels, background);
  auto result = results_.begin();
  for (uint32_t s = 0; s < samples; ++s)
    for (const uint32_t pixel : covered_)
      spread_[size_t(s) * pixels + pixel] = *result++;
  return spread_;
}

// Returns the extras of all pixels, in the order of all_pixels().
const Extras &TileWorker::extras_of_pixels(const Film::Tile &tile, uint32_t samples, const Extras &background) {
  const uint32_t pixels = tile.pixels(), covered = uint32_t(covered_.size()), channels = layout_.channels();
  if (covered == pixels)
    return extras_;
  spread_extras_.channels.clear();
  for (size_t i = 0; i < size_t(samples) * pixels && channels > 0; ++i)
    spread_extras_.channels.insert(spread_extras_.channels.end(), background.channels.begin(), background.channels.end());
  const auto place_of_sample = [&](size_t i) { return i / covered * pixels + covered_[i % covered]; };
  for (size_t i = 0; i < results_.size() && channels > 0; ++i)
    std::copy_n(extras_.channels.begin() + ptrdiff_t(i * channels), channels,
                spread_extras_.channels.begin() + ptrdiff_t(place_of_sample(i) * channels));
  spread_extras_.mattes = extras_.mattes;
  for (MatteShare &matte : spread_extras_.mattes)
    matte.sample = uint32_t(place_of_sample(matte.sample));
  return spread_extras_;
}

void TileWorker::publish() {
  const std::lock_guard lock(mutex_);
  rays_ += integrator_->counts();
  rays_ -= rays_before_;
  vertices_ += integrator_->vertices() - vertices_before_;
  energy_ += batch_energy_;
}

RayCounts TileWorker::rays() const {
  const std::lock_guard lock(mutex_);
  return rays_;
}

uint64_t TileWorker::vertices() const {
  const std::lock_guard lock(mutex_);
  return vertices_;
}

Energy TileWorker::energy() const {
  const std::lock_guard lock(mutex_);
  return energy_;
}

} // namespace lancer
