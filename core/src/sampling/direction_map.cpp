#include "sampling/direction_map.h"

#include "sampling/elementary.h"

#include <glm/gtc/constants.hpp>

namespace lancer {

DirectionMap::DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights)
    : width_(width), height_(height) {
  const uint32_t half = (height + 1) / 2;
  for (uint32_t row = 0; row <= half; ++row) {
    const double s = sin(0.5 * glm::pi<double>() * (double(row) / height));
    versines_.push_back(2.0 * s * s);
  }
  for (uint32_t row = 0; row < half; ++row)
    solid_angles_.push_back(2.0 * glm::pi<double>() / width * (versines_[row + 1] - versines_[row]));
  std::vector<double> columns(width), totals(height);
  column_sums_.reserve(size_t(height) * (width + 1));
  column_guide_.reserve(size_t(height) * (WeightedChoice::guide_steps(width) + 1));
  for (uint32_t row = 0; row < height; ++row) {
    double sum = 0.0;
    for (uint32_t column = 0; column < width; ++column) {
      columns[column] = double(weights[size_t(row) * width + column]);
      sum += columns[column];
    }
    totals[row] = sum * solid_angle(row);
    append(WeightedChoice(columns), column_sums_, column_guide_, width);
  }
  append(WeightedChoice(totals), row_sums_, row_guide_, height);
}

void DirectionMap::append(const WeightedChoice &choice, std::vector<double> &sums, std::vector<uint32_t> &guide,
                          uint32_t size) const {
  sums.insert(sums.end(), choice.sums().begin(), choice.sums().end());
  const size_t end = guide.size() + WeightedChoice::guide_steps(size);
  guide.insert(guide.end(), choice.guide().begin(), choice.guide().end());
  guide.resize(end, 0);
  guide.push_back(size - 1);
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

glm::dvec3 DirectionMap::direction(double column, double row) const {
  const double theta = glm::pi<double>() * (row / height_), phi = glm::pi<double>() * (2.0 * column / width_ - 1.0);
  return {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
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
