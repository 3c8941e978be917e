// One render: a scene seen by a camera, ranges of samples, and the film that stores them.
#pragma once

#include "lancer.h"
#include "render/film.h"
#include "render/parts.h"
#include "render/picture_error.h"
#include "render/pilot.h"
#include "render/thread_pool.h"
#include "render/tile_worker.h"
#include "scene/bake.h"
#include "scene/vectors.h"

#include <atomic>
#include <chrono>
#include <latch>

namespace lancer {

// Checks and copies settings; throws Error with the name of the setting and its value.
IntegratorSettings read_settings(const lancer_settings &source);
FilterKind read_filter(uint32_t filter, float width);

struct Progress {
  double fraction = 0.0, seconds = 0.0;
  uint64_t samples = 0, rays = 0;
};

struct SessionStatistics {
  double render_seconds = 0.0;
  uint64_t samples = 0;
  RayCounts rays;
  uint64_t vertices = 0;
  uint64_t invalid_samples = 0;
  SampleAddress first_invalid{0, 0, 0};
  uint32_t threads = 0;
  size_t film_bytes = 0;
  const char *kernel = "";
  Splits splits{0, 0}; // 0 before the first sample
};

// The error of the picture and the light that its settings remove.
struct SessionError {
  PictureError picture;
  // Shares of the picture's light, as lancer_error.
  double clipped = 0.0, clipped_direct = 0.0, cut = 0.0, no_caustics = 0.0;
  double filtered = 0.0, filtered_error = 0.0, guessed = 0.0, guessed_error = 0.0;
  double missing = 0.0; // share that paths beyond the depth limit would add, estimated from the last bounces
  uint32_t least_samples = 0, most_samples = 0;
  double planned_samples = 0.0; // further pixel samples that the last refine() predicted
};

class Session {
public:
  // camera in the user's units. scene: null for a session that joins parts and cannot render. Throws Error when camera,
  // settings or memory do not allow the film. bake: with as many texels as the camera has pixels.
  Session(std::shared_ptr<const Scene> scene, const Camera &camera, const IntegratorSettings &settings,
          const Identity &identity, std::unique_ptr<const Bake> bake = nullptr);
  ~Session();

  // Starts samples first ... first + count - 1; throws Error when first does not follow the last sample, or while another range
  // runs.
  void render(uint32_t first, uint32_t count);
  // Starts a round that doubles the samples of some pixels: plan_refinement(). Returns false when nothing can be doubled.
  // confidence: of the upper bound that has to fall below target.
  bool refine(double target, double confidence);
  // Returns the ranges of the round that refine() would start.
  std::vector<lancer_range> plan(double target, double confidence);

  // Parts of a picture, for sessions that refine.

  // Starts the search for the splits without any samples.
  void decide();
  // Starts ranges of different tiles, each anywhere if its tile is empty, otherwise at its next sample.
  void render(std::span<const lancer_range> ranges);
  // Forgets all samples, but not the splits.
  void clear();
  size_t part_size() const;
  void write_part(std::span<std::byte> out) const;
  // Throws Error, and changes nothing, if the part does not fit.
  void add(const Part &part);

  enum class State { Done, Running, Cancelled };
  State wait(uint32_t milliseconds, Progress &progress);
  void cancel() { cancel_ = true; }
  // Ends the range like cancel(), but each pixel keeps only a power of two of samples, and the session can continue.
  void stop() {
    stop_ = true;
    cancel_ = true;
  }

  // Returns the channels of a pass of the interface, whose number lancer_pass_kind explains; throws Error if there is none.
  static uint32_t channels_of(uint32_t pass);
  void read(uint32_t pass, std::span<float> out) const;
  const Film &film() const { return film_; }
  SessionStatistics statistics() const;
  SessionError error(double confidence) const;
  bool only_joins() const { return !scene_; }
  // Throws Error for a session that only joins parts.
  const Scene &scene() const;
  const Camera &camera() const { return camera_; }
  // Computes one sample alone. Must not be called while a range runs.
  SampleResult replay(const SampleAddress &address, std::vector<PathVertex> &vertices);

private:
  void require_ready() const;
  void require_scene() const;
  void require_parts() const;
  void start();
  void work(uint32_t thread);
  void look_for_background(uint32_t thread);
  void find_splits(uint32_t thread);
  void settle();
  double seconds() const;
  Totals of_workers() const;
  Totals totals() const;

  // Whether the session has to find how samples split.
  bool finds_splits() const;
  // Whether the splits are known.
  bool has_splits() const { return !finds_splits() || prepared_; }

  std::shared_ptr<const Scene> scene_; // null: the session only joins parts
  Camera camera_;                      // normalised
  Identity identity_;

  std::unique_ptr<const Bake> bake_; // of a bake
  CameraMoments moments_;            // normalised
  IntegratorSettings settings_;
  Film film_;
  std::vector<std::unique_ptr<TileWorker>> workers_;
  std::atomic<bool> cancel_{false}, stop_{false};
  std::atomic<size_t> next_task_{0};
  std::atomic<uint64_t> samples_{0}, counted_samples_{0}; // samples in the film; samples ever added
  uint64_t range_samples_ = 0, samples_before_ = 0;
  // The running range: tiles in order, with the samples that each of their pixels has afterwards.
  struct Task {
    uint32_t tile, end;
  };
  std::vector<Task> tasks_;
  std::unique_ptr<Pilot> pilot_; // set while a range starts by finding the splits
  Background background_;
  std::unique_ptr<std::latch> background_found_; // set while a range starts by searching the background
  std::atomic<bool> prepared_{false};            // background and splits have been found
  bool in_ranges_ = false;                       // the last range was one of render(ranges)
  bool deciding_ = false;                        // the last start was decide()
  Totals added_, forgotten_;                     // of parts; of the workers' samples before clear()
  double planned_samples_ = 0.0;
  bool cancelled_ = false, failed_ = false;
  double seconds_before_ = 0.0;
  std::chrono::steady_clock::time_point start_;
  bool started_ = false;
  mutable std::mutex mutex_; // guards splits_ and end_time_
  Splits splits_;
  std::chrono::steady_clock::time_point end_time_;
  std::atomic<uint32_t> active_{0};
  ThreadPool pool_; // last: its threads end before other members are destroyed
};

} // namespace lancer
