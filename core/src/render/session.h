// One render: a scene seen through a camera, samples in ranges, the film they fall on.
#pragma once

#include "lancer.h"
#include "render/film.h"
#include "render/picture_error.h"
#include "render/pilot.h"
#include "render/thread_pool.h"
#include "render/tile_worker.h"

#include <atomic>
#include <chrono>
#include <latch>

namespace lancer {

struct SessionSettings {
  IntegratorSettings integrator;
  uint32_t passes = 1;
  uint32_t threads = 0;
  uint32_t tile_size = 0;
  bool refines = false;      // the film is laid out for refine()
  bool finds_splits = false; // integrator.splits are to be found
};

// Checks and copies settings; an Error names the setting and its value.
SessionSettings read_settings(const lancer_settings &source);
FilterKind read_filter(uint32_t filter, float width);

struct Progress {
  double fraction = 0.0, seconds = 0.0;
  uint64_t samples = 0, rays = 0;
};

struct SessionStatistics {
  double render_seconds = 0.0;
  uint64_t samples = 0;
  RayCounts rays;
  VertexCounts vertices;
  uint64_t invalid_samples = 0;
  SampleAddress first_invalid{0, 0, 0};
  uint32_t threads = 0;
  size_t film_bytes = 0;
  const char *kernel = "";
  Splits splits{0, 0}; // 0 before the first sample
};

// What a picture may still be wrong by, and what its settings have taken from it.
struct SessionError {
  PictureError picture;
  double clipped = 0.0; // share of the picture's light that clamping has taken away
  double missing = 0.0; // share that paths beyond the depth limit would add, as far as the last bounces tell
  uint32_t least_samples = 0, most_samples = 0;
  double planned_samples = 0.0; // pixel samples that the last refine() still wanted in all
};

class Session {
public:
  // camera in world units. Throws Error when camera, settings or memory do not allow the film.
  Session(std::shared_ptr<const Scene> scene, const Camera &camera, const SessionSettings &settings);
  ~Session();

  // Starts samples first ... first + count - 1; Error when first does not follow, or while another range runs.
  void render(uint32_t first, uint32_t count);
  // Starts a round that doubles the samples of some pixels: plan_refinement(). False when nothing can be doubled any more.
  // confidence: of the bound that is to come below target.
  bool refine(double target, double confidence);
  enum class State { Done, Running, Cancelled };
  State wait(uint32_t milliseconds, Progress &progress);
  void cancel() { cancel_ = true; }
  // Ends the range like cancel(), but no pixel keeps more samples than the last power of two, and the session can go on.
  void stop() {
    stop_ = true;
    cancel_ = true;
  }

  void read(Pass pass, std::span<float> out) const;
  const Film &film() const { return film_; }
  SessionStatistics statistics() const;
  SessionError error(double confidence) const;
  const Scene &scene() const { return *scene_; }
  const Camera &camera() const { return camera_; }
  // Computes one sample by itself. Not while rendering.
  SampleResult replay(const SampleAddress &address, std::vector<PathVertex> &vertices);

private:
  void require_ready() const;
  void start();
  void work(uint32_t thread);
  void look_for_background(uint32_t thread);
  void find_splits(uint32_t thread);
  void settle();
  double seconds() const;
  RayCounts rays() const;
  VertexCounts vertices() const;

  std::shared_ptr<const Scene> scene_;
  Camera camera_; // normalised
  SessionSettings settings_;
  Film film_;
  std::vector<std::unique_ptr<TileWorker>> workers_;
  std::atomic<bool> cancel_{false}, stop_{false};
  std::atomic<size_t> next_task_{0};
  std::atomic<uint64_t> samples_{0}, counted_samples_{0}; // that the film has; that it has ever had
  uint64_t range_samples_ = 0, samples_before_ = 0;
  // What runs: tiles in order, and the samples that each of their pixels then has.
  struct Task {
    uint32_t tile, end;
  };
  std::vector<Task> tasks_;
  std::unique_ptr<Pilot> pilot_; // of a range that begins with finding how samples split
  Background background_;
  std::unique_ptr<std::latch> background_found_; // of a range that begins with looking for it
  double planned_samples_ = 0.0;
  bool cancelled_ = false, failed_ = false;
  double seconds_before_ = 0.0;
  std::chrono::steady_clock::time_point start_;
  bool started_ = false;
  mutable std::mutex mutex_; // of what follows
  Splits splits_;
  std::chrono::steady_clock::time_point end_time_;
  std::atomic<uint32_t> active_{0};
  ThreadPool pool_; // last: its threads end before anything else does
};

} // namespace lancer
