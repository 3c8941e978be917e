#include "render/pilot.h"

#include "lancer.h"
#include "simd/vectors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace lancer {

namespace {

constexpr uint32_t kSamples = kPilot.samples;
constexpr uint32_t kBatch = 1024;

// Returns places that fill the unit square evenly for any count: multiples of the powers of the plastic number (Roberts, "The
// unreasonable effectiveness of quasirandom sequences", 2018).
glm::dvec2 place_of(uint32_t number) {
  return glm::fract(glm::dvec2(0.5) + double(number) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
}

// Returns the luminance of a sample; 0 where it is not finite.
float level_of(const SampleResult &result) {
  const float level = luminance(result.radiance);
  return std::isfinite(level) ? level : 0.0f;
}

uint64_t cost_of(const Integrator &integrator) { return kPilot.cost.of(integrator.counts(), integrator.vertices()); }

} // namespace

Pilot::Pilot(const Scene &scene, const Camera &camera, const Background &background, const IntegratorSettings &settings,
             uint32_t threads)
    : scene_(scene), camera_(camera), background_(background), settings_(settings), costs_(threads), barrier_(threads) {
  // Other passes cost time and do not change the noise of the picture.
  settings_.passes = 1u << LANCER_PASS_COMBINED;
  settings_.mattes = settings_.light_groups = settings_.aov_colors = settings_.aov_values = 0;
  settings_.splits = {};
  // Fix the seed: every seed, and every frame of an animation that changes nothing else, gets the same splits.
  settings_.seed = 0;
  for (uint32_t thread = 0; thread < threads; ++thread)
    integrators_.push_back(make_integrator(scene, camera, settings_));
}

void Pilot::work(uint32_t thread) {
  // A thread that leaves, even by an exception, must not block the others.
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

// Doubles the number of lights and the number of paths in turn while variance times cost falls, starting with the number of
// larger gain.
void Pilot::search() {
  const auto doubled = [&](bool lights) {
    Splits splits = best_;
    (lights ? splits.lights : splits.paths) *= 2;
    return splits;
  };
  Look best = find_pixels();
  if (best.noise.empty())
    return;
  Look by_paths = look(doubled(false)), by_lights = scene_.lights.empty() ? best : look(doubled(true));
  bool lights = is_better(by_lights, by_paths, 1.0);
  for (uint32_t failed = 0; failed < 2 && !settings_.cancelled();) {
    const Splits next = doubled(lights);
    bool pays = std::max(next.lights, next.paths) <= kPilot.most_splits && !(lights && scene_.lights.empty());
    if (pays) {
      Look found = best_ == Splits() ? (lights ? by_lights : by_paths) : look(next);
      pays = is_better(found, best, kPilot.gain);
      if (pays) {
        best = std::move(found);
        best_ = next;
      }
    }
    failed = pays ? 0 : failed + 1;
    if (!pays)
      lights = !lights;
  }
}

// Chooses pixels with noise from the whole image. Returns the measurement of the picture without splits.
Pilot::Look Pilot::find_pixels() {
  const double planned = double(camera_.width) * camera_.height * settings_.samples;
  const auto wanted = std::bit_floor(
      uint32_t(std::clamp(planned / kPilot.samples_per_pixel, double(kPilot.fewest_pixels), double(kPilot.most_pixels))));
  Look plain;
  double sum = 0.0;
  uint32_t looked_at = 0;
  uint64_t traced = 0;
  while (looked_at == 0 ||
         (pixels_.size() < kPilot.fewest_noisy && looked_at < kPilot.most_rounds * wanted && !settings_.cancelled())) {
    std::vector<Pixel> some;
    // Keep the order of all pixels, so that the sum is the same whether empty pixels are traced or not.
    std::vector<double> levels(wanted, level_of(background_.sample));
    std::vector<uint32_t> numbers;
    for (uint32_t i = 0; i < wanted; ++i) {
      const glm::dvec2 at = place_of(looked_at++) * glm::dvec2(camera_.width, camera_.height);
      // Addresses start at the region's corner and wrap around for pixels outside it.
      const Pixel pixel{.x = std::min(uint32_t(at.x), camera_.width - 1) - camera_.x,
                        .y = std::min(uint32_t(at.y), camera_.height - 1) - camera_.y};
      if (is_empty(pixel))
        continue;
      some.push_back(pixel);
      numbers.push_back(i);
    }
    plain.cost += run(some, plain.splits);
    traced += some.size();
    for (size_t i = 0; i < some.size(); ++i) {
      levels[numbers[i]] = some[i].level = mean_of(i);
      if (!(noise_of(i) > 0.0))
        continue;
      pixels_.push_back(some[i]);
      plain.noise.push_back(noise_of(i));
    }
    sum = std::accumulate(levels.begin(), levels.end(), sum);
  }
  looks_ = 1;
  darkest_ = std::max(0.01 * sum / looked_at, 1e-30);
  // Pixels without noise mostly show the background and cost one camera ray per sample. The picture does not trace an even
  // background.
  const uint64_t cost_of_rays = kPilot.cost.camera_ray * kSamples * (traced - pixels_.size());
  if (has_even_background(scene_, camera_))
    plain.cost -= cost_of_rays;
  else
    cost_of_others_ = cost_of_rays;
  return plain;
}

// Whether a pixel certainly shows the background.
bool Pilot::is_empty(const Pixel &pixel) const {
  return pixel.x < camera_.region_width && pixel.y < camera_.region_height && !background_.coverage.covers(pixel.x, pixel.y);
}

Pilot::Look Pilot::look(const Splits &splits) {
  Look look{splits, {}, run(pixels_, splits) + cost_of_others_};
  for (size_t i = 0; i < pixels_.size(); ++i) {
    look.noise.push_back(noise_of(i));
    pixels_[i].level += mean_of(i);
  }
  ++looks_;
  return look;
}

// Whether the variance times cost of one measurement is less than `by` times that of another. The variance of a pixel is
// relative to its level: the mean over all measurements plus 1 % of the picture's mean, as in the error of a picture. If each
// measurement used its own level, a pixel that one measurement finds bright by chance would seem less noisy there.
bool Pilot::is_better(const Look &look, const Look &than, double by) const {
  const auto relative = [&](const Look &of, size_t i) {
    const double level = pixels_[i].level / looks_ + darkest_;
    return of.noise[i] / (level * level);
  };
  std::vector<double> both;
  for (size_t i = 0; i < pixels_.size(); ++i)
    for (const Look *of : {&look, &than})
      both.push_back(relative(*of, i));
  const auto limit = both.begin() + ptrdiff_t((1.0 - kPilot.clamped) * double(both.size()));
  std::nth_element(both.begin(), limit, both.end());
  const auto product = [&](const Look &of) {
    double variance = 0.0;
    for (size_t i = 0; i < pixels_.size(); ++i)
      variance += std::min(relative(of, i), *limit);
    return variance * double(of.cost);
  };
  return product(look) < by * product(than);
}

// Renders the pixels with these splits and returns the cost.
uint64_t Pilot::run(const std::vector<Pixel> &pixels, const Splits &splits) {
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
  return std::accumulate(costs_.begin(), costs_.end(), uint64_t(0));
}

double Pilot::mean_of(size_t pixel) const {
  double sum = 0.0;
  for (uint32_t sample = 0; sample < kSamples; ++sample)
    sum += std::abs(double(luminances_[pixel * kSamples + sample]));
  return sum / kSamples;
}

// Sums the squared differences of neighbouring ranges of a pixel's samples: its halves, quarters and eighths. Where the
// variance falls as N^-1.5, which is the usual case, each level contributes about the same. Shorter ranges are left out: few
// samples are distributed unlike the many samples of a picture.
double Pilot::noise_of(size_t pixel) const {
  constexpr uint32_t kStretches = 8;
  double sums[kStretches] = {}, noise = 0.0;
  for (uint32_t sample = 0; sample < kSamples; ++sample)
    sums[kStretches * sample / kSamples] += double(luminances_[pixel * kSamples + sample]);
  for (uint32_t count = kStretches; count > 1; count /= 2)
    for (uint32_t i = 0; i < count; i += 2) {
      noise += (sums[i] - sums[i + 1]) * (sums[i] - sums[i + 1]);
      sums[i / 2] = sums[i] + sums[i + 1];
    }
  return noise;
}

void Pilot::measure(uint32_t thread) {
  Integrator &integrator = *integrators_[thread];
  integrator.set_splits(tried_);
  const uint64_t before = cost_of(integrator);
  std::vector<SampleResult> results(kBatch);
  for (size_t begin; (begin = kBatch * next_batch_.fetch_add(1)) < addresses_.size() && !settings_.cancelled();) {
    const size_t size = std::min<size_t>(kBatch, addresses_.size() - begin);
    integrator.run(std::span(addresses_).subspan(begin, size), std::span(results).first(size), nullptr);
    for (size_t i = 0; i < size; ++i)
      luminances_[begin + i] = level_of(results[i]);
  }
  costs_[thread] = cost_of(integrator) - before;
}

} // namespace lancer
