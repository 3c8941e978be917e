#include "sampling/direction_map.h"

#include "sampling/angle.h"
#include "sampling/elementary.h"

#include <glm/gtc/constants.hpp>

namespace lancer {

namespace {

// As WeightedChoice::Choice, but in double.
struct Entry {
  uint32_t index;
  double width; // of its interval
  double u;     // where the number fell inside
};

// The entry whose interval sums[i] <= u < sums[i + 1] holds the number; halves what two entries of the guide leave.
Entry find(const double *sums, const uint32_t *guide, size_t steps, float number) {
  const double u = double(number);
  const size_t step = std::min(size_t(u * double(steps)), steps - 1);
  uint32_t low = guide[step], high = guide[step + 1];
  while (low < high) {
    const uint32_t middle = (low + high) / 2;
    if (sums[middle + 1] > u)
      high = middle;
    else
      low = middle + 1;
  }
  const double width = sums[low + 1] - sums[low];
  return {low, width, std::min((u - sums[low]) / width, kBelowOne)};
}

} // namespace

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

DirectionMap::Sample DirectionMap::sample(const glm::vec2 &u) const {
  // Choose a row, a column in it, and with what is left of both numbers a place in the cell.
  const Entry row = find(row_sums_.data(), row_guide_.data(), WeightedChoice::guide_steps(height_), u.y);
  if (!(row.width > 0.0))
    return {};
  const size_t steps = WeightedChoice::guide_steps(width_);
  const Entry column =
      find(column_sums_.data() + size_t(row.index) * (width_ + 1), column_guide_.data() + row.index * (steps + 1), steps, u.x);
  return {inside_cell(column.index, row.index, {column.u, row.u}), density(column.index, row.index)};
}

double DirectionMap::pdf(const glm::vec3 &direction) const {
  const glm::dvec3 d(direction);
  const MapPlace<double> place = place_on_map(d.x, d.y, d.z, std::sqrt(d.x * d.x + d.y * d.y));
  const auto row = uint32_t(std::min(height_ - 1.0, (0.5 - place.y) * height_));
  const auto column = uint32_t(std::min(width_ - 1.0, (0.5 + place.x) * width_));
  return density(column, row);
}

double DirectionMap::density(uint32_t column, uint32_t row) const {
  const double *columns = column_sums_.data() + size_t(row) * (width_ + 1);
  return (row_sums_[row + 1] - row_sums_[row]) * (columns[column + 1] - columns[column]) / solid_angle(row);
}

glm::dvec3 DirectionMap::direction(double column, double row) const {
  const double theta = glm::pi<double>() * (row / height_), phi = glm::pi<double>() * (2.0 * column / width_ - 1.0);
  return {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}

glm::dvec3 DirectionMap::inside_cell(uint32_t column, uint32_t row, const glm::dvec2 &inside) const {
  // Even steps of the cosine are even steps of the solid angle. Count from the nearer pole.
  const bool upper = 2 * row < height_;
  const double from = versines_[from_pole(row)], to = versines_[from_pole(row) + 1];
  const double y = upper ? inside.y : 1.0 - inside.y, x = from * (1.0 - y) + to * y;
  const double across = std::sqrt(x * (2.0 - x)), up = upper ? 1.0 - x : x - 1.0;
  // Columns begin half a turn away.
  const SinCos turn = sin_cos_turn((column + inside.x) / width_);
  return {-(across * turn.cos), -(across * turn.sin), up};
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
          column_guide_.data()};
}

size_t DirectionMap::bytes() const {
  return (versines_.size() + solid_angles_.size() + row_sums_.size() + column_sums_.size()) * sizeof(double) +
         (row_guide_.size() + column_guide_.size()) * sizeof(uint32_t);
}

} // namespace lancer
