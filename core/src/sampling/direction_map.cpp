#include "sampling/direction_map.h"

#include "sampling/elementary.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <numeric>

namespace lancer {

namespace {

// Stores a choice among size entries, whose guide gets the last entry too.
void store(const WeightedChoice &choice, uint32_t size, double *sums, uint32_t *guide) {
  std::ranges::copy(choice.sums(), sums);
  uint32_t *const end = guide + WeightedChoice::guide_steps(size);
  std::fill(std::ranges::copy(choice.guide(), guide).out, end, 0u);
  *end = size - 1;
}

} // namespace

DirectionMap::DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights, const BuildContext &context)
    : width_(width), height_(height) {
  const uint32_t half = (height + 1) / 2;
  for (uint32_t row = 0; row <= half; ++row) {
    const double s = sin(0.5 * glm::pi<double>() * (double(row) / height));
    versines_.push_back(2.0 * s * s);
  }
  for (uint32_t row = 0; row < half; ++row)
    solid_angles_.push_back(2.0 * glm::pi<double>() / width * (versines_[row + 1] - versines_[row]));
  const size_t steps = WeightedChoice::guide_steps(width) + 1;
  column_sums_.resize(size_t(height) * (width + 1));
  column_guide_.resize(size_t(height) * steps);
  row_sums_.resize(height + 1);
  row_guide_.resize(WeightedChoice::guide_steps(height) + 1);
  std::vector<double> totals(height);
  parallel_for(context, height, [&](size_t row) {
    const float *const first = weights.data() + row * width;
    const std::vector<double> columns(first, first + width);
    totals[row] = std::accumulate(columns.begin(), columns.end(), 0.0) * solid_angle(uint32_t(row));
    store(WeightedChoice(columns), width, column_sums_.data() + row * (width + 1), column_guide_.data() + row * steps);
  });
  store(WeightedChoice(totals), height, row_sums_.data(), row_guide_.data());
}

void DirectionMap::add_disc(const glm::dvec3 &axis, double half_angle, double share) {
  DirectionDisc disc;
  disc.axis = glm::normalize(axis);
  const glm::dvec3 beside = std::abs(disc.axis.z) < 0.7 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  disc.across = glm::normalize(glm::cross(beside, disc.axis));
  disc.up = glm::cross(disc.axis, disc.across);
  const double s = sin(0.5 * half_angle);
  disc.versine = 2.0 * s * s;
  disc.from = discs_.empty() ? 0.0 : discs_.back().from + discs_.back().share;
  disc.share = share;
  disc.density = share / (2.0 * glm::pi<double>() * disc.versine);
  discs_.push_back(disc);
}

DirectionMap::Sample DirectionMap::sample(const glm::vec2 &u) const {
  const DirectionSample<float> found = sample_direction(table(), u.x, u.y);
  return found.pdf > 0.0 ? Sample{found.direction, found.pdf} : Sample{};
}

double DirectionMap::pdf(const glm::vec3 &direction) const { return direction_pdf(table(), Vector3<float>(direction)); }

SinCos<double> DirectionMap::polar(double row) const {
  const double theta = glm::pi<double>() * (row / height_);
  return {sin(theta), cos(theta)};
}

SinCos<double> DirectionMap::azimuth(double column) const {
  const double phi = glm::pi<double>() * (2.0 * column / width_ - 1.0);
  return {sin(phi), cos(phi)};
}

DirectionTable DirectionMap::table() const {
  return {width_,
          height_,
          uint32_t(WeightedChoice::guide_steps(width_)),
          uint32_t(WeightedChoice::guide_steps(height_)),
          versines_.data(),
          solid_angles_.data(),
          row_sums_.data(),
          column_sums_.data(),
          row_guide_.data(),
          column_guide_.data(),
          discs_.data(),
          uint32_t(discs_.size()),
          discs_.empty() ? 0.0 : discs_.back().from + discs_.back().share};
}

size_t DirectionMap::bytes() const {
  return (versines_.size() + solid_angles_.size() + row_sums_.size() + column_sums_.size()) * sizeof(double) +
         (row_guide_.size() + column_guide_.size()) * sizeof(uint32_t) + discs_.size() * sizeof(DirectionDisc);
}

} // namespace lancer
