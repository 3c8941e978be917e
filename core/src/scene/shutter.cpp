#include "scene/shutter.h"

#include <algorithm>
#include <cmath>

namespace lancer {

// Parts of the numbers by which a search begins: all but a few parts of an even shutter hold less than a step.
static constexpr uint32_t kStarts = 4096;

Shutter::Shutter(std::span<const float> open) : open_(open.begin(), open.end()) {
  if (std::ranges::all_of(open_, [](float value) { return value == 0.0f; }))
    std::ranges::fill(open_, 1.0f);
  double sum = 0.0;
  for (size_t i = 0; i + 1 < open_.size(); ++i) {
    sum += 0.5 * (double(open_[i]) + double(open_[i + 1]));
    sums_.push_back(sum);
  }
  for (double &value : sums_)
    value /= sum;
  for (uint32_t part = 0, step = 0; part < kStarts; ++part) {
    while (step + 1 < sums_.size() && sums_[step] <= double(part) / kStarts)
      ++step;
    starts_.push_back(step);
  }
}

float Shutter::time(float u) const {
  // Find the step, then the place in it: the root of the integral of a linear function.
  size_t step = starts_[std::min(uint32_t(u * float(kStarts)), kStarts - 1)];
  while (step + 1 < sums_.size() && sums_[step] <= double(u))
    ++step;
  const double before = step == 0 ? 0.0 : sums_[step - 1], share = (double(u) - before) / (sums_[step] - before);
  const double from = double(open_[step]), to = double(open_[step + 1]), area = 0.5 * (from + to) * share;
  // x from + x^2 (to - from) / 2 = area, in the form without cancellation.
  const double root = std::sqrt(std::max(from * from + 2.0 * (to - from) * area, 0.0));
  const double place = area > 0.0 ? 2.0 * area / (from + root) : 0.0;
  return std::min(float((double(step) + std::clamp(place, 0.0, 1.0)) / double(sums_.size())), 1.0f);
}

float Motion::time(float u, double row) const {
  if (!shutter.opens())
    return kMiddleTime;
  const float time = shutter.time(u);
  if (!rolling)
    return time;
  // As in Cycles: each row is exposed for a share of the time, the rows one after the other during the rest of it.
  const double place = (double(time) - 0.5) * rolling_duration + (row - 0.5) * (1.0 - rolling_duration) + 0.5;
  return std::clamp(float(place), 0.0f, 1.0f);
}

void Motion::move(Camera &camera, float time) const {
  const KeyPlace at = key_at(uint32_t(cameras.size()), time);
  const Camera &from = cameras[at.key], &to = cameras[at.key + 1];
  const auto between = [share = double(at.share)](double a, double b) { return a * (1.0 - share) + b * share; };
  camera.to_world = placement_at(places, time);
  camera.left = between(from.left, to.left);
  camera.right = between(from.right, to.right);
  camera.bottom = between(from.bottom, to.bottom);
  camera.top = between(from.top, to.top);
  camera.lens_radius = between(from.lens_radius, to.lens_radius);
  camera.focal_distance = between(from.focal_distance, to.focal_distance);
  for (size_t i = 0; i < camera.panorama.size() && camera.is_panorama(); ++i)
    camera.panorama[i] = between(from.panorama[i], to.panorama[i]);
}

} // namespace lancer
