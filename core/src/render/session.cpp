#include "render/session.h"

#include "integrator/stages/light_passes.h"
#include "render/picture_error.h"
#include "scene/fill.h"
#include "scene/messages.h"
#include "simd/vectors.h"

namespace lancer {

namespace {

constexpr uint32_t kTileSize = 32, kSmallestTile = 8, kLargestTile = 256;
// Threads wait for the last tile of a range. With this many tiles per thread, the wait is about a hundredth of the time.
constexpr uint64_t kTilesEach = 64;
// Side of the squares whose samples are refined together. Fixed, so that refinement depends on neither tile size nor threads.
constexpr uint32_t kRefinedSize = 16;

// scene: null if no ray is sent through the camera.
Camera normalised(Camera camera, const Scene *scene) {
  if (!scene)
    return camera;
  const Normalisation &normalisation = scene->normalisation;
  camera.to_world.translation = normalisation.to_normalised(camera.to_world.translation);
  camera.scale_lengths(normalisation.scale);
  check_reach(camera);
  return camera;
}

CameraMoments normalised(CameraMoments moments, const Scene *scene) {
  for (Camera &camera : moments.cameras)
    camera = normalised(camera, scene);
  return moments;
}

// Returns the number of sums that wait at most in each pixel, beside the few tiles in work. A film that is refined doubles the
// samples of its tiles: each has one sum, or two. A film whose samples are multiples of an eighth of their largest power of two
// has at most four, until the last range.
int waiting_sums(const IntegratorSettings &settings, uint32_t samples) {
  const int all = std::bit_width(uint64_t(samples) + 1) - 1;
  return settings.refines ? std::min(all, 2) : std::max(std::min(all, 4), std::popcount(samples));
}

// Throws Error for a film that exceeds the machine's memory.
const Camera &checked_memory(const Camera &camera, const IntegratorSettings &settings) {
  constexpr uint32_t kForDenoising = bit(Pass::Halves) | bit(Pass::AlbedoHalves) | bit(Pass::NormalHalves);
  const uint32_t samples = std::max(settings.samples, 1u);
  const auto bytes = [&](uint32_t passes) {
    return Film::bytes_needed(camera.region_width, camera.region_height, passes, uint32_t(waiting_sums(settings, samples)),
                              settings.extras());
  };
  std::string what = "film: " + std::to_string(camera.region_width) + " x " + std::to_string(camera.region_height) +
                     " pixels, " + std::to_string(samples) + " samples";
  if (settings.passes & kForDenoising)
    what += " and passes for denoising (without these " +
            std::to_string(uint64_t(bytes(settings.passes & ~kForDenoising) / 1e6)) + " MB)";
  if (settings.light_groups > 0)
    what += ", " + std::to_string(settings.light_groups) + " light groups";
  check_memory(what, bytes(settings.passes));
  return camera;
}

uint32_t tile_size(const Camera &camera, const IntegratorSettings &settings, uint32_t threads) {
  if (settings.refines)
    return kRefinedSize;
  if (settings.tile_size)
    return std::min(settings.tile_size, kLargestTile);
  uint32_t size = kTileSize;
  const auto tiles = [&](uint64_t length) { return (length + size - 1) / size; };
  while (size > kSmallestTile && tiles(camera.region_width) * tiles(camera.region_height) < kTilesEach * threads)
    size /= 2;
  return size;
}

} // namespace

Session::Session(std::shared_ptr<const Scene> scene, const Camera &camera, const IntegratorSettings &settings,
                 const Identity &identity, std::unique_ptr<const Bake> bake)
    : scene_(std::move(scene)), camera_(normalised(checked_memory(camera, settings), scene_.get())), identity_(identity),
      bake_(std::move(bake)), moments_(normalised(read_camera_moments(identity.camera), scene_.get())), settings_(settings),
      film_(camera.region_width, camera.region_height, tile_size(camera, settings, ThreadPool::resolved(settings.threads)),
            settings.passes, settings.refines, settings.extras()),
      pool_(scene_ ? settings.threads : 1) {
  settings_.cancel = &cancel_;
  settings_.bake = bake_.get();
  settings_.moments = &moments_;
  splits_ = settings_.splits;
  for (uint32_t i = 0; scene_ && i < pool_.size(); ++i)
    workers_.push_back(std::make_unique<TileWorker>(*scene_, camera_, settings_));
}

Session::~Session() { cancel_ = true; }

void Session::require_ready() const {
  if (pool_.running())
    throw Error(Fault::State, "session: a range is still being rendered");
  if (failed_)
    throw Error(Fault::State, "session: a range failed; its film can only be read");
  if (cancelled_)
    throw Error(Fault::State, "session: it was cancelled; its film can only be read");
}

void Session::require_scene() const {
  if (!scene_)
    throw Error(Fault::State, "session: it has no scene; it only joins parts");
}

const Scene &Session::scene() const {
  require_scene();
  return *scene_;
}

void Session::render(uint32_t first, uint32_t count) {
  require_scene();
  require_ready();
  for (size_t i = 0; i < film_.tile_count(); ++i)
    if (!film_.tile(i).whole())
      throw Error(Fault::State, "session: it has ranges of tiles that do not start at sample 0");
  const auto [least, most] = film_.sample_range();
  if (least != most)
    throw Error(Fault::State, "session: its pixels have different numbers of samples; it can only be refined");
  if (first != most)
    throw Error(Fault::State, "session: first sample " + std::to_string(first) + " does not follow the " +
                                  std::to_string(most) + " samples rendered so far");
  if (uint64_t(first) + count > (uint64_t(1) << 31))
    bad_argument("session: " + std::to_string(uint64_t(first) + count) + " samples > 2147483648");
  tasks_.clear();
  for (uint32_t tile = 0; tile < film_.tile_count(); ++tile) {
    // A range of it may have failed to start.
    if (film_.tile(tile).count == 0)
      Film::clear(film_.tile(tile), 0);
    tasks_.push_back({tile, first + count});
  }
  range_samples_ = uint64_t(count) * film_.width() * film_.height();
  in_ranges_ = false;
  start();
}

bool Session::refine(double target, double confidence) {
  require_scene();
  const std::vector<lancer_range> ranges = plan(target, confidence);
  if (ranges.empty())
    return false;
  tasks_.clear();
  range_samples_ = 0;
  for (const lancer_range &range : ranges) {
    tasks_.push_back({range.tile, range.first + range.count});
    range_samples_ += uint64_t(range.count) * film_.tile(range.tile).pixels();
  }
  in_ranges_ = false;
  start();
  return true;
}

std::vector<lancer_range> Session::plan(double target, double confidence) {
  require_ready();
  if (!film_.halves())
    throw Error(Fault::State, "session: it was not created to be refined; set refines in its settings");
  const LuminanceMap map(film_, pool_.size());
  if (!map.known)
    throw Error(Fault::State,
                "session: every pixel needs " + std::to_string(Film::kLeastSamples) + " samples before it is refined");
  for (size_t i = 0; i < film_.tile_count(); ++i)
    if (film_.tile(i).pixels() > 0 && !std::has_single_bit(film_.tile(i).count))
      throw Error(Fault::State, "session: " + std::to_string(film_.tile(i).count) +
                                    " samples are not a power of two; only powers of two can be doubled");
  const RelativeVariance relative(map, pool_.size());
  const PictureError error = picture_error(map, relative, confidence);
  // The error at which its upper bound, together with the light that may be missing, meets the target.
  const double bound = error.high + error.cannot_exclude;
  const double goal = bound > 0.0 ? target * error.error / bound : target;
  const Refinement refinement = plan_refinement(film_, map, relative, goal, settings_.samples);
  planned_samples_ = refinement.samples;
  std::vector<lancer_range> ranges;
  for (const uint32_t tile : refinement.tiles)
    ranges.push_back({tile, film_.tile(tile).count, film_.tile(tile).count});
  return ranges;
}

void Session::start() {
  // Before the first sample, find the background and the splits, also after a range that ended early.
  pilot_.reset();
  background_found_.reset();
  if (!prepared_) {
    background_found_ = std::make_unique<std::latch>(1);
    if (finds_splits())
      pilot_ = std::make_unique<Pilot>(*scene_, camera_, background_, settings_, pool_.size());
  }
  deciding_ = false;
  samples_before_ = samples_;
  seconds_before_ = seconds();
  cancel_ = stop_ = false;
  next_task_ = 0;
  started_ = true;
  active_ = pool_.size();
  start_ = std::chrono::steady_clock::now();
  pool_.start([this](uint32_t thread) { work(thread); });
}

void Session::work(uint32_t thread) {
  // The clock stops with the last thread, even if a thread leaves by an exception.
  struct Leave {
    Session &session;
    ~Leave() {
      {
        const std::lock_guard lock(session.mutex_);
        session.end_time_ = std::chrono::steady_clock::now();
      }
      --session.active_;
    }
  } const leave{*this};
  if (background_found_)
    look_for_background(thread);
  if (pilot_)
    find_splits(thread);
  if (thread == 0 && !cancel_)
    prepared_ = true;
  while (!cancel_) {
    const size_t task = next_task_.fetch_add(1);
    if (task >= tasks_.size())
      break;
    workers_[thread]->render(film_, film_.tile(tasks_[task].tile), tasks_[task].end, background_, [this](uint64_t samples) {
      samples_ += samples;
      counted_samples_ += samples;
    });
  }
}

// The first thread searches; the others wait until it leaves, even by an exception.
void Session::look_for_background(uint32_t thread) {
  if (thread != 0)
    return background_found_->wait();
  struct Leave {
    std::latch &found;
    ~Leave() { found.count_down(); }
  } const leave{*background_found_};
  background_ = find_background(*scene_, camera_, settings_, film_);
}

void Session::find_splits(uint32_t thread) {
  pilot_->work(thread);
  workers_[thread]->set_splits(pilot_->splits());
  if (thread != 0)
    return;
  const std::lock_guard lock(mutex_);
  splits_ = pilot_->splits();
}

// Drops the samples of a stopped range beyond powers of two.
void Session::settle() {
  stop_ = false;
  samples_ = 0;
  for (size_t i = 0; i < film_.tile_count(); ++i) {
    Film::Tile &tile = film_.tile(i);
    if (tile.pixels() == 0)
      continue;
    film_.round_down(tile);
    samples_ += uint64_t(tile.count) * tile.pixels();
  }
  // No part of the range is left to cancel.
  range_samples_ = 0;
}

Totals Session::of_workers() const {
  Totals sum;
  for (const auto &worker : workers_)
    sum += {worker->rays(), worker->vertices(), worker->energy()};
  return sum;
}

// Returns the totals of the film's samples, and of samples that a stopped range has dropped.
Totals Session::totals() const {
  Totals sum = of_workers();
  sum -= forgotten_;
  sum += added_;
  return sum;
}

bool Session::finds_splits() const {
  return settings_.kind() == IntegratorKind::Path && settings_.samples >= Pilot::kLeastPlanned && settings_.split_lights == 0 &&
         settings_.split_paths == 0;
}

double Session::seconds() const {
  if (!started_)
    return 0.0;
  const std::lock_guard lock(mutex_);
  const auto now = active_ > 0 ? std::chrono::steady_clock::now() : end_time_;
  return seconds_before_ + std::chrono::duration<double>(now - start_).count();
}

Session::State Session::wait(uint32_t milliseconds, Progress &progress) {
  if (failed_)
    throw Error(Fault::State, "session: a range failed; its film can only be read");
  bool done = false;
  try {
    done = pool_.wait(milliseconds);
  } catch (...) {
    failed_ = true;
    throw;
  }
  progress.samples = samples_;
  progress.seconds = seconds();
  const RayCounts counts = totals().rays;
  progress.rays = counts.camera + counts.bounce + counts.shadow;
  const double done_samples = double(progress.samples - samples_before_);
  progress.fraction = range_samples_ ? std::min(1.0, done_samples / double(range_samples_)) : 1.0;
  if (!done)
    return State::Running;
  // Without a range there is none to end.
  if (!started_)
    return State::Done;
  if (stop_ && !cancelled_ && !in_ranges_) {
    settle();
    progress.samples = samples_;
  }
  // A search for the splits that is cancelled leaves nothing to continue.
  cancelled_ = cancelled_ || (cancel_ && (progress.samples - samples_before_ < range_samples_ || (deciding_ && !prepared_)));
  return cancelled_ ? State::Cancelled : State::Done;
}

SampleResult Session::replay(const SampleAddress &address, std::vector<PathVertex> &vertices) {
  require_scene();
  IntegratorSettings settings = settings_;
  settings.cancel = nullptr;
  settings.splits = splits_;
  const auto integrator = make_integrator(*scene_, camera_, settings);
  SampleResult result;
  integrator->run(std::span(&address, 1), std::span(&result, 1), &vertices);
  if (settings.exposure != 1.0f)
    expose(result, settings.exposure, LightPasses(settings).wanted());
  return result;
}

} // namespace lancer
