// The numbers that a session reports of its picture: the error, the light that settings change, and statistics.
#include "render/session.h"

#include "render/picture_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lancer {

namespace {

// Returns the share of the light that a setting takes away, and half of its 95 % interval. light, samples: of the picture, and
// the number of samples that each had a change.
std::pair<double, double> share_of(const Energy::Change &change, double light, double samples) {
  constexpr double kNormal95 = 1.959964;
  const double sum = change.sum.value(), whole = light + sum;
  if (!(whole > 0.0))
    return {0.0, std::numeric_limits<double>::infinity()};
  const double variance = std::max(change.squares.value() - sum * sum / std::max(samples, 1.0), 0.0);
  return {sum / whole, kNormal95 * std::sqrt(variance) * light / (whole * whole)};
}

} // namespace

SessionError Session::error(double confidence) const {
  SessionError result;
  const LuminanceMap map(film_, pool_.size());
  if (map.known)
    result.picture = picture_error(map, RelativeVariance(map, pool_.size()), confidence);
  double light = 0.0, samples = 0.0;
  for (size_t i = 0; i < map.size(); ++i) {
    light += std::abs(double(map.mean[i])) * map.unit * map.count[i];
    samples += double(map.count[i]);
  }
  std::tie(result.least_samples, result.most_samples) = film_.sample_range();
  const Energy energy = totals().energy;
  // Energy includes samples that a stopped range has dropped.
  light *= double(counted_samples_) / std::max(samples, 1.0);
  // Energy is that of the light before the film's exposure.
  light /= double(std::max(settings_.exposure, std::numeric_limits<float>::min()));
  if (light > 0.0) {
    const auto share = [&](const ExactSum &removed) { return removed.value() / (light + removed.value()); };
    result.clipped = share(energy.clipped);
    result.clipped_direct = share(energy.clipped_direct);
    result.cut = share(energy.cut);
    result.no_caustics = share(energy.no_caustics);
    std::tie(result.filtered, result.filtered_error) = share_of(energy.filtered, light, double(counted_samples_));
    std::tie(result.guessed, result.guessed_error) = share_of(energy.guessed, light, double(counted_samples_));
    result.missing = energy.beyond() / light;
  }
  result.planned_samples = planned_samples_;
  return result;
}

SessionStatistics Session::statistics() const {
  SessionStatistics statistics;
  statistics.render_seconds = seconds();
  statistics.samples = samples_;
  const Totals sum = totals();
  statistics.rays = sum.rays;
  statistics.vertices = sum.vertices;
  const Film::Dropped dropped = film_.dropped();
  statistics.invalid_samples = dropped.samples;
  statistics.first_invalid = dropped.first;
  statistics.threads = pool_.size();
  statistics.film_bytes = film_.bytes();
  if (samples_ > 0 || prepared_) {
    const std::lock_guard lock(mutex_);
    statistics.splits = splits_;
  }
  statistics.kernel = workers_.empty() ? "joined" : workers_.front()->name();
  return statistics;
}

} // namespace lancer
