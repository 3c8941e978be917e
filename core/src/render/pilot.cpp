#include "render/pilot.h"

#include "lancer.h"
#include "render/background.h"
#include "sampling/color.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace lancer {

namespace {

constexpr uint32_t kSamples = 16;
constexpr uint32_t kBatch = 1024;
// Pixels that are looked at: one for so many samples of the picture, which then takes up to 6 % longer (8 public files).
constexpr double kSamplesEach = 4096.0;
constexpr uint32_t kFewest = 128, kMostPixels = 4096;
// The fewest that should have noise, and how many times as many are looked at for their sake.
constexpr size_t kFewestNoisy = 96;
constexpr uint32_t kLooks = 8;
constexpr uint32_t kMost = 8;
// What another way has to bring: the pilot's figures are off by about as much.
constexpr double kWorth = 0.93;
// Share of the pixels, those of most noise without splitting, beyond whose least noise none counts: flashes of light are too
// rare in so few samples to tell anything.
constexpr double kNoisiest = 0.02;
// Costs of a camera ray and a vertex, of a ray that goes on or to a light: 1. Fitted to the times of 26 public files split in
// four ways each, which it foretells within 10 % (one standard deviation).
constexpr double kCameraRay = 0.2, kVertex = 0.75;

// Places that fill a square evenly, however many are taken: multiples of the powers of the plastic number (Roberts, "The
// unreasonable effectiveness of quasirandom sequences", 2018).
glm::dvec2 place_of(uint32_t number) {
  return glm::fract(glm::dvec2(0.5) + double(number) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
}

double cost_of(const Integrator &integrator) {
  const RayCounts &rays = integrator.counts();
  const VertexCounts &vertices = integrator.vertices();
  return kCameraRay * double(rays.camera) + double(rays.bounce + rays.shadow) +
         kVertex * double(vertices.wide + vertices.narrow);
}

} // namespace

Pilot::Pilot(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, uint32_t threads)
    : scene_(scene), camera_(camera), settings_(settings), costs_(threads), barrier_(threads) {
  // Passes cost, and tell nothing of noise.
  settings_.passes = 1u << LANCER_PASS_COMBINED;
  settings_.splits = {};
  // Every seed, and every frame of an animation that changes nothing else, finds the same way.
  settings_.seed = 0;
  for (uint32_t thread = 0; thread < threads; ++thread)
    integrators_.push_back(make_integrator(scene, camera, settings_));
}

void Pilot::work(uint32_t thread) {
  // A thread that leaves, even by failing, keeps no other waiting.
  struct Leave {
    Pilot &pilot;
    uint32_t thread;
    ~Leave() {
      if (thread == 0)
        pilot.done_ = true;
      pilot.barrier_.arrive_and_drop();
    }
  } const leave{*this, thread};
  if (thread == 0)
    return search();
  while (true) {
    barrier_.arrive_and_wait();
    if (done_)
      return;
    measure(thread);
    barrier_.arrive_and_wait();
  }
}

// Doubles each of the two numbers as long as that pays, first the one that pays more.
void Pilot::search() {
  const auto doubled = [](Splits splits, bool lights) {
    (lights ? splits.lights : splits.paths) *= 2;
    return splits;
  };
  double least = find_pixels();
  if (!(least > 0.0))
    return;
  const double by_paths = product_of(doubled(best_, false));
  const double by_lights = scene_.lights.empty() ? least : product_of(doubled(best_, true));
  const bool lights_first = by_lights < by_paths;
  for (const bool lights : {lights_first, !lights_first}) {
    Splits next = doubled(best_, lights);
    while ((lights ? next.lights : next.paths) <= kMost && !settings_.cancelled()) {
      const bool known = best_ == Splits();
      const double product = !known ? product_of(next) : lights ? by_lights : by_paths;
      if (!(product < kWorth * least))
        break;
      least = product;
      best_ = next;
      next = doubled(best_, lights);
    }
  }
}

// Takes pixels that have noise from the whole image. Returns the product of not splitting; 0 where there is no noise.
double Pilot::find_pixels() {
  const double planned = double(camera_.width) * camera_.height * settings_.samples;
  const auto wanted = std::bit_floor(uint32_t(std::clamp(planned / kSamplesEach, double(kFewest), double(kMostPixels))));
  double sum = 0.0, cost = 0.0;
  uint32_t looked_at = 0;
  while (looked_at == 0 || (pixels_.size() < kFewestNoisy && looked_at < kLooks * wanted && !settings_.cancelled())) {
    std::vector<Pixel> some;
    for (uint32_t i = 0; i < wanted; ++i) {
      const glm::dvec2 at = place_of(looked_at++) * glm::dvec2(camera_.width, camera_.height);
      // Addresses begin at the region, which may lie beyond: they come around.
      some.push_back({.x = std::min(uint32_t(at.x), camera_.width - 1) - camera_.x,
                      .y = std::min(uint32_t(at.y), camera_.height - 1) - camera_.y});
    }
    cost += look_at(some, Splits());
    for (size_t i = 0; i < some.size(); ++i) {
      for (uint32_t sample = 0; sample < kSamples; ++sample)
        some[i].level += std::abs(double(luminances_[i * kSamples + sample])) / kSamples;
      sum += some[i].level;
      some[i].noise = noise_of(i);
      if (some[i].noise > 0.0)
        pixels_.push_back(some[i]);
    }
  }
  if (pixels_.empty())
    return 0.0;
  // Others mostly show the background, for a camera ray; where that is even, they mostly are not traced.
  const double cost_of_rays = kCameraRay * kSamples * double(looked_at - pixels_.size());
  if (has_even_background(scene_, camera_))
    cost -= cost_of_rays;
  else
    cost_of_others_ = cost_of_rays;
  // Compare noise with what a pixel shows, that of dark ones with a share of the whole picture, as errors are told.
  std::vector<double> noise;
  for (Pixel &pixel : pixels_) {
    pixel.level += std::max(0.01 * sum / looked_at, 1e-30);
    noise.push_back(pixel.noise / (pixel.level * pixel.level));
  }
  const auto limit = noise.begin() + ptrdiff_t((1.0 - kNoisiest) * double(noise.size()));
  std::nth_element(noise.begin(), limit, noise.end());
  most_noise_ = *limit;
  double variance = 0.0;
  for (const double of_pixel : noise)
    variance += std::min(of_pixel, most_noise_);
  return variance * cost;
}

// Returns what it cost.
double Pilot::look_at(const std::vector<Pixel> &pixels, const Splits &splits) {
  addresses_.clear();
  for (const Pixel &pixel : pixels)
    for (uint32_t sample = 0; sample < kSamples; ++sample)
      addresses_.push_back({pixel.x, pixel.y, sample});
  luminances_.assign(addresses_.size(), 0.0f);
  tried_ = splits;
  next_batch_ = 0;
  barrier_.arrive_and_wait();
  measure(0);
  barrier_.arrive_and_wait();
  return std::accumulate(costs_.begin(), costs_.end(), 0.0);
}

// Squares of what halves of a pixel's samples differ by: those of all, and of each half, which are as many measurements more.
// Where variance falls as N^-1.5, as it mostly does, each counts for about the same.
double Pilot::noise_of(size_t pixel) const {
  double sums[4] = {};
  for (uint32_t sample = 0; sample < kSamples; ++sample)
    sums[4 * sample / kSamples] += double(luminances_[pixel * kSamples + sample]);
  const double all = sums[0] + sums[1] - sums[2] - sums[3], early = sums[0] - sums[1], late = sums[2] - sums[3];
  return all * all + early * early + late * late;
}

// Variance times cost.
double Pilot::product_of(const Splits &splits) {
  const double cost = look_at(pixels_, splits);
  double variance = 0.0;
  for (size_t i = 0; i < pixels_.size(); ++i)
    variance += std::min(noise_of(i) / (pixels_[i].level * pixels_[i].level), most_noise_);
  return variance * (cost + cost_of_others_);
}

void Pilot::measure(uint32_t thread) {
  Integrator &integrator = *integrators_[thread];
  integrator.set_splits(tried_);
  const double before = cost_of(integrator);
  std::vector<SampleResult> results(kBatch);
  for (size_t begin; (begin = kBatch * next_batch_.fetch_add(1)) < addresses_.size() && !settings_.cancelled();) {
    const size_t size = std::min<size_t>(kBatch, addresses_.size() - begin);
    integrator.run(std::span(addresses_).subspan(begin, size), std::span(results).first(size), nullptr);
    for (size_t i = 0; i < size; ++i) {
      const float level = luminance(results[i].radiance);
      luminances_[begin + i] = std::isfinite(level) ? level : 0.0f;
    }
  }
  costs_[thread] = cost_of(integrator) - before;
}

} // namespace lancer
