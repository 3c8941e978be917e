// Directions with a density that is constant in each cell of a grid over latitude and longitude.
#pragma once

#include "sampling/direction_table.h"

namespace lancer {

// Row 0 has the directions around +z; column 0 begins at -x, and columns follow the angle about z. Within a cell the density is
// constant per solid angle, so that neither the poles nor the seam are special.
class DirectionMap {
public:
  DirectionMap() = default;
  // weights[row * width + column]: density up to a factor, per solid angle; 0 is never sampled.
  DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights);

  bool empty() const { return height_ == 0; }
  struct Sample {
    glm::dvec3 direction{0.0}; // unit
    double pdf = 0.0;          // per solid angle; 0 = no sample
  };
  Sample sample(const glm::vec2 &u) const;
  // Returns the density of a direction in floats, as in the nodes of a world.
  double pdf(const glm::vec3 &direction) const;

  // Returns the direction at a position of the grid, (0, 0) its first corner, linear in the angles.
  glm::dvec3 direction(double column, double row) const;
  // Returns the solid angle of each cell of a row.
  double solid_angle(uint32_t row) const { return solid_angles_[from_pole(row)]; }
  // Returns a table that is valid as long as the map is neither changed nor moved.
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
