#include "sampling/direction_map.h"

#include <glm/gtc/constants.hpp>

namespace lancer {

DirectionMap::DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights)
    : width_(width), height_(height) {
  const uint32_t half = (height + 1) / 2;
  for (uint32_t row = 0; row <= half; ++row) {
    const double s = std::sin(0.5 * glm::pi<double>() * (double(row) / height));
    versines_.push_back(2.0 * s * s);
  }
  for (uint32_t row = 0; row < half; ++row)
    solid_angles_.push_back(2.0 * glm::pi<double>() / width * (versines_[row + 1] - versines_[row]));
  std::vector<double> columns(width), totals(height);
  rows_.reserve(height);
  for (uint32_t row = 0; row < height; ++row) {
    double sum = 0.0;
    for (uint32_t column = 0; column < width; ++column) {
      columns[column] = double(weights[size_t(row) * width + column]);
      sum += columns[column];
    }
    totals[row] = sum * solid_angle(row);
    rows_.emplace_back(columns);
  }
  choice_ = WeightedChoice(totals);
}

DirectionMap::Sample DirectionMap::sample(const glm::vec2 &u) const {
  // Choose a row, a column in it, and with what is left of both numbers a place in the cell.
  const auto row = choice_.sample(double(u.y));
  if (!(row.pmf > 0.0f))
    return {};
  const auto column = rows_[row.index].sample(double(u.x));
  Sample sample;
  sample.direction = inside_cell(column.index, row.index, {double(column.u), double(row.u)});
  sample.pdf = double(row.pmf) * double(column.pmf) / solid_angle(row.index);
  return sample;
}

double DirectionMap::pdf(const glm::dvec3 &direction) const {
  const double pi = glm::pi<double>();
  const double theta = std::atan2(std::sqrt(direction.x * direction.x + direction.y * direction.y), direction.z);
  const double phi = std::atan2(direction.y, direction.x) + pi;
  const uint32_t row = std::min(uint32_t(theta / pi * height_), height_ - 1);
  const uint32_t column = std::min(uint32_t(phi / (2.0 * pi) * width_), width_ - 1);
  return double(choice_.pmf(row)) * double(rows_[row].pmf(column)) / solid_angle(row);
}

glm::dvec3 DirectionMap::direction(double column, double row) const {
  const double theta = glm::pi<double>() * (row / height_), phi = glm::pi<double>() * (2.0 * column / width_ - 1.0);
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

glm::dvec3 DirectionMap::inside_cell(uint32_t column, uint32_t row, const glm::dvec2 &inside) const {
  // Even steps of the cosine are even steps of the solid angle. Count from the nearer pole.
  const bool upper = 2 * row < height_;
  const double from = versines_[from_pole(row)], to = versines_[from_pole(row) + 1];
  const double x = glm::mix(from, to, upper ? inside.y : 1.0 - inside.y);
  const double sine = std::sqrt(x * (2.0 - x)), cosine = upper ? 1.0 - x : x - 1.0;
  const double phi = 2.0 * glm::pi<double>() * ((column + inside.x) / width_) - glm::pi<double>();
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

size_t DirectionMap::bytes() const {
  size_t bytes = choice_.bytes() + (versines_.size() + solid_angles_.size()) * sizeof(double);
  for (const WeightedChoice &row : rows_)
    bytes += row.bytes();
  return bytes;
}

} // namespace lancer
