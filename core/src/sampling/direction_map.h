// Directions with a density that is constant in each cell of a grid over latitude and longitude.
#pragma once

#include "sampling/distribution.h"

#include <glm/glm.hpp>

namespace lancer {

// Row 0 holds the directions around +z; column 0 begins at -x and columns run with the angle about z. Within a cell the density
// is constant per solid angle, so that neither the poles nor the seam are special.
class DirectionMap {
public:
  DirectionMap() = default;
  // weights[row * width + column]: what to be proportional to, per solid angle; 0 where never.
  DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights);

  bool empty() const { return rows_.empty(); }
  struct Sample {
    glm::dvec3 direction{0.0}; // unit
    double pdf = 0.0;          // per solid angle; 0 = no sample
  };
  Sample sample(const glm::vec2 &u) const;
  double pdf(const glm::dvec3 &direction) const;

  // The direction at a place of the grid, (0, 0) its first corner, even in the angles.
  glm::dvec3 direction(double column, double row) const;
  // Solid angle of each cell of a row.
  double solid_angle(uint32_t row) const { return solid_angles_[from_pole(row)]; }
  size_t bytes() const;

private:
  // The direction at (x, y) in [0, 1)^2 of a cell, even in the solid angle.
  glm::dvec3 inside_cell(uint32_t column, uint32_t row, const glm::dvec2 &inside) const;
  // Rows count from the nearer pole.
  uint32_t from_pole(uint32_t row) const { return 2 * row < height_ ? row : height_ - row - 1; }

  uint32_t width_ = 0, height_ = 0;
  // By row: 1 - cos of the angle to the pole of the edge towards it, which keeps its digits there, where cos has none left; and
  // the solid angle of a cell.
  std::vector<double> versines_, solid_angles_;
  WeightedChoice choice_;            // of a row
  std::vector<WeightedChoice> rows_; // of a column in it
};

} // namespace lancer
