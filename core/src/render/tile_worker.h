// The work of one thread: renders tiles in batches of samples and adds them to the film.
#pragma once

#include "render/coverage.h"

#include <functional>
#include <memory>
#include <mutex>

namespace lancer {

class TileWorker {
public:
  // All references must outlive the worker.
  TileWorker(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

  void set_splits(const Splits &splits) { integrator_->set_splits(splits); }
  const char *name() const { return integrator_->name(); }
  // Adds the next samples of a tile, up to end, and calls count() after each batch that the film has received. A batch that
  // settings.cancel interrupts is discarded.
  void render(Film &film, Film::Tile &tile, uint32_t end, const Background &background,
              const std::function<void(uint64_t samples)> &count);

  // Totals of all batches that the film has received; may be called while rendering.
  RayCounts rays() const;
  uint64_t vertices() const;
  Energy energy() const;

private:
  void render_batch(const Film::Tile &tile, uint32_t samples);
  void drop_invalid(Film &film, Film::Tile &tile);
  std::span<const SampleResult> all_pixels(const Film::Tile &tile, uint32_t samples, const SampleResult &background);
  const Extras &extras_of_pixels(const Film::Tile &tile, uint32_t samples, const Extras &background);
  void publish();

  const IntegratorSettings &settings_;
  bool with_light_; // samples have parts of the light
  std::unique_ptr<Integrator> integrator_;
  std::vector<uint32_t> covered_; // pixels of the tile
  std::vector<SampleAddress> addresses_;
  std::vector<SampleResult> results_, spread_; // of addresses_; of all pixels
  ExtraLayout layout_;
  Extras extras_, spread_extras_; // of addresses_; of all pixels
  RayCounts rays_before_;         // of the integrator, before the batch
  uint64_t vertices_before_ = 0;
  Energy batch_energy_;
  // Members that other threads read.
  mutable std::mutex mutex_;
  RayCounts rays_;
  uint64_t vertices_ = 0;
  Energy energy_;
};

} // namespace lancer
