#include "render/tile_worker.h"

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
    : settings_(settings), integrator_(make_integrator(scene, camera, settings)) {}

void TileWorker::render(Film &film, Film::Tile &tile, uint32_t end, const Background &background,
                        const std::function<void(uint64_t samples)> &count) {
  const uint32_t pixels = tile.pixels();
  if (pixels == 0)
    return;
  // Find the covered pixels.
  covered_.clear();
  for (uint32_t pixel = 0; pixel < pixels; ++pixel)
    if (const glm::uvec2 place = tile.place(pixel); background.coverage.covers(place.x, place.y))
      covered_.push_back(pixel);
  const auto covered = uint32_t(covered_.size());
  if (covered == 0) {
    const uint32_t samples = end - tile.next();
    film.add_even(tile, samples, background.sample);
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
    film.add(tile, samples, all_pixels(tile, samples, background.sample));
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
  // Large tiles pass through the integrator in several batches.
  for (size_t begin = 0; begin < addresses_.size(); begin += kBatch) {
    const size_t size = std::min<size_t>(kBatch, addresses_.size() - begin);
    integrator_->run(std::span(addresses_).subspan(begin, size), std::span(results_).subspan(begin, size), nullptr);
    batch_energy_ += integrator_->energy();
  }
}

void TileWorker::drop_invalid(Film &film, Film::Tile &tile) {
  for (size_t i = 0; i < results_.size(); ++i) {
    if (film.finite(results_[i]))
      continue;
    results_[i] = place_of(results_[i]);
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
