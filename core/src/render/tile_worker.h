// How one thread renders tiles: batches of samples through its integrator, onto the film.
#pragma once

#include "render/background.h"

#include <functional>
#include <memory>
#include <mutex>

namespace lancer {

class TileWorker {
public:
  // What is given must outlive it.
  TileWorker(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

  void set_splits(const Splits &splits) { integrator_->set_splits(splits); }
  const char *kernel() const { return integrator_->kernel(); }
  // Adds the next samples of a tile, up to end. count() is told of each batch that the film has got. A batch that is broken
  // off, as settings.cancel says, is worth nothing.
  void render(Film &film, Film::Tile &tile, uint32_t end, const Background &background,
              const std::function<void(uint64_t samples)> &count);

  // Of all batches that the film has got; while others run.
  RayCounts rays() const;
  VertexCounts vertices() const;
  Energy energy() const;

private:
  void render_batch(const Film::Tile &tile, uint32_t samples);
  void drop_invalid(Film &film, Film::Tile &tile);
  std::span<const SampleResult> all_pixels(const Film::Tile &tile, uint32_t samples, const SampleResult &background);
  void publish();

  const IntegratorSettings &settings_;
  std::unique_ptr<Integrator> integrator_;
  std::vector<uint32_t> covered_; // pixels of the tile
  std::vector<SampleAddress> addresses_;
  std::vector<SampleResult> results_, spread_; // of addresses; of all pixels
  Energy batch_energy_;
  // What other threads read.
  mutable std::mutex mutex_;
  RayCounts rays_;
  VertexCounts vertices_;
  Energy energy_;
};

} // namespace lancer
