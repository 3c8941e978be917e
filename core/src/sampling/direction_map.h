// Directions with a density that is constant in each cell of a grid over latitude and longitude.
#pragma once

#include "sampling/direction_table.h"

namespace lancer {

// Row 0 holds the directions around +z; column 0 begins at -x and columns run with the angle about z. Within a cell the density
// is constant per solid angle, so that neither the poles nor the seam are special.
class DirectionMap {
public:
  DirectionMap() = default;
  // weights[row * width + column]: what to be proportional to, per solid angle; 0 where never.
  DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights);

  bool empty() const { return height_ == 0; }
  struct Sample {
    glm::dvec3 direction{0.0}; // unit
    double pdf = 0.0;          // per solid angle; 0 = no sample
  };
  Sample sample(const glm::vec2 &u) const;
  // Of a direction in floats, as the nodes of a world see it.
  double pdf(const glm::vec3 &direction) const;

  // The direction at a place of the grid, (0, 0) its first corner, even in the angles.
  glm::dvec3 direction(double column, double row) const;
  // Solid angle of each cell of a row.
  double solid_angle(uint32_t row) const { return solid_angles_[from_pole(row)]; }
  // As long as the map is neither changed nor moved.
  DirectionTable table() const;
  size_t bytes() const;

private:
  void append(const WeightedChoice &choice, std::vector<double> &sums, std::vector<uint32_t> &guide, uint32_t size) const;
  uint32_t from_pole(uint32_t row) const { return 2 * row < height_ ? row : height_ - row - 1; }

  uint32_t width_ = 0, height_ = 0;
  std::vector<double> versines_, solid_angles_, row_sums_, column_sums_;
  std::vector<uint32_t> row_guide_, column_guide_;
};

} // namespace lancer
