// Directions with a density that is constant in each cell of a grid over latitude and longitude, and in discs beside it.
#pragma once

#include "sampling/distribution.h"
#include "sampling/elementary.h"
#include "simd/parallel.h"
#include "simd/vectors.h"

namespace lancer {

// A cone of directions with a uniform density, for light that no cell is small enough for.
struct DirectionDisc {
  glm::dvec3 axis, across, up;    // orthonormal
  double versine = 0.0;           // 1 - cos of its half angle
  double from = 0.0, share = 0.0; // of the random numbers
  double density = 0.0;           // per solid angle, times the share
};

// Sums and guides are those of WeightedChoice, each guide followed by the last entry: the entry for a number lies between two
// of the guide. Columns have one row of sums and guide per row of the map, rows have one.
struct DirectionTable {
  uint32_t width = 0, height = 0, column_steps = 0, row_steps = 0;
  // By row: 1 - cos of the angle from the pole to the edge on its side, which keeps its digits near the pole, where cos has
  // none left; and the solid angle of a cell. Rows count from the nearer pole.
  const double *versines = nullptr, *solid_angles = nullptr;
  const double *row_sums = nullptr, *column_sums = nullptr;
  const uint32_t *row_guide = nullptr, *column_guide = nullptr;
  // Discs, which take the first random numbers; cells take the rest from cells_from on.
  const DirectionDisc *discs = nullptr;
  uint32_t disc_count = 0;
  double cells_from = 0.0;
};

// The entry of a table selected by a number, as WeightedChoice::Choice.
template <class F> struct TableEntry {
  WordOf<F> index;
  DoubleOf<F> width, u; // of its interval; position of the number within
};

// Finds the entry whose interval sums[i] <= number < sums[i + 1] contains the number, by bisection between two entries of the
// guide. sums_at, guide_at: starts within the arrays.
template <class F>
LANCER_LANE TableEntry<F> find_entry(const double *sums, WordOf<F> sums_at, const uint32_t *guide, WordOf<F> guide_at,
                                     uint32_t steps, F number) {
  using D = DoubleOf<F>;
  using U = WordOf<F>;
  using M = MaskOf<F>;
  const D u = widen(number);
  const U step = guide_at + truncate(min(D(static_cast<double>(steps - 1u)), u * D(static_cast<double>(steps))));
  U low = gather(guide, step), high = gather(guide, step + U(1u));
  for (M open = !equal(low, high); any(open); open = !equal(low, high)) {
    const U middle = (low + high) >> 1;
    const M left = gather(sums, sums_at + middle + U(1u)) > u, right = open & !left;
    high = select(open & left, middle, high);
    low = select(right, middle + U(1u), low);
  }
  const D from = gather(sums, sums_at + low), width = gather(sums, sums_at + low + U(1u)) - from;
  return {low, width, min((u - from) / width, D(kBelowOne))};
}

// is_upper_row() returns whether a row is nearer to the upper pole, row_from_pole() its number from the nearer pole.
template <class F> LANCER_LANE MaskOf<F> is_upper_row(const DirectionTable &map, WordOf<F> row) {
  return F(2.0f) * to_float(row) < F(static_cast<float>(map.height));
}
template <class F> LANCER_LANE WordOf<F> row_from_pole(const DirectionTable &map, WordOf<F> row) {
  return select(is_upper_row<F>(map, row), row, WordOf<F>(map.height - 1u) - row);
}

// Returns the density of a cell, per solid angle.
template <class F> LANCER_LANE DoubleOf<F> cell_density(const DirectionTable &map, WordOf<F> row, WordOf<F> column) {
  using D = DoubleOf<F>;
  using U = WordOf<F>;
  const U at = row * U(map.width + 1u) + column, next(1u);
  const D of_row = gather(map.row_sums, row + next) - gather(map.row_sums, row);
  const D of_column = gather(map.column_sums, at + next) - gather(map.column_sums, at);
  return of_row * of_column / gather(map.solid_angles, row_from_pole<F>(map, row));
}

template <class F> struct DirectionSample {
  Double3Of<F> direction; // unit
  DoubleOf<F> pdf;        // per solid angle; 0 or less: no sample
};

// Samples the cells.
template <class F> LANCER_LANE DirectionSample<F> sample_cells(const DirectionTable &map, F u, F v) {
  using D = DoubleOf<F>;
  using U = WordOf<F>;
  // Select a row, a column in it, and a position in the cell by the remainders of both numbers.
  const TableEntry<F> row = find_entry(map.row_sums, U(0u), map.row_guide, U(0u), map.row_steps, v);
  const TableEntry<F> column = find_entry(map.column_sums, row.index * U(map.width + 1u), map.column_guide,
                                          row.index * U(map.column_steps + 1u), map.column_steps, u);
  // The solid angle is linear in the cosine. Count from the nearer pole.
  const D one(1.0);
  const MaskOf<F> upper = is_upper_row<F>(map, row.index);
  const U pole = row_from_pole<F>(map, row.index);
  const D from = gather(map.versines, pole), to = gather(map.versines, pole + U(1u));
  const D y = select(upper, row.u, one - row.u), x = from * (one - y) + to * y;
  const D across = sqrt(x * (D(2.0) - x)), up = select(upper, one - x, x - one);
  // Columns begin half a turn away.
  const SinCos turn = sin_cos_turn((widen(to_float(column.index)) + column.u) / D(static_cast<double>(map.width)));
  return {{-(across * turn.cos), -(across * turn.sin), up}, cell_density<F>(map, row.index, column.index)};
}

// Returns the map position of a direction in floats, as in the nodes of a world.
template <class F> LANCER_LANE MapPlace<DoubleOf<F>> place_of(const Vector3<F> &direction) {
  const Double3Of<F> d = widen(direction);
  return place_on_map(d.x, d.y, d.z, sqrt(d.x * d.x + d.y * d.y));
}

// Returns the density of the cells.
template <class F> LANCER_LANE DoubleOf<F> cells_pdf(const DirectionTable &map, const Vector3<F> &direction) {
  using D = DoubleOf<F>;
  const MapPlace<D> place = place_of(direction);
  const double width = static_cast<double>(map.width), height = static_cast<double>(map.height);
  const WordOf<F> row = truncate(min(D(height - 1.0), (D(0.5) - place.y) * D(height)));
  const WordOf<F> column = truncate(min(D(width - 1.0), (D(0.5) + place.x) * D(width)));
  return cell_density<F>(map, row, column);
}

// Returns the density of a direction in floats, as in the nodes of a world.
template <class F> LANCER_LANE DoubleOf<F> direction_pdf(const DirectionTable &map, const Vector3<F> &direction) {
  using D = DoubleOf<F>;
  const D cells = cells_pdf(map, direction);
  if (map.disc_count == 0)
    return cells;
  D sum = D(1.0 - map.cells_from) * cells;
  for (const DirectionDisc *disc = map.discs; disc != map.discs + map.disc_count; ++disc) {
    // The squared chord keeps its digits in small discs.
    const Double3Of<F> apart = widen(direction) - Double3Of<F>(disc->axis);
    sum += select(dot(apart, apart) <= D(2.0 * disc->versine), D(disc->density), D(0.0));
  }
  return sum;
}

template <class F> LANCER_LANE DirectionSample<F> sample_direction(const DirectionTable &map, F u, F v) {
  using D = DoubleOf<F>;
  if (map.disc_count == 0)
    return sample_cells(map, u, v);
  const D number = widen(u);
  const F of_cells = narrow((number - D(map.cells_from)) / D(1.0 - map.cells_from));
  DirectionSample<F> sample = sample_cells(map, F(min(max(of_cells, F(0.0f)), F(0x1.fffffep-1f))), v);
  for (const DirectionDisc *disc = map.discs; disc != map.discs + map.disc_count; ++disc) {
    const D place = (number - D(disc->from)) / D(disc->share);
    const auto here = (place >= D(0.0)) & (place < D(1.0));
    const SinCos turn = sin_cos_turn(D(min(max(place, D(0.0)), D(1.0))));
    const D one(1.0), x = widen(v) * D(disc->versine), across = sqrt(x * (D(2.0) - x));
    const Double3Of<F> found = (one - x) * Double3Of<F>(disc->axis) + (across * turn.cos) * Double3Of<F>(disc->across) +
                               (across * turn.sin) * Double3Of<F>(disc->up);
    sample.direction = select(here, found, sample.direction);
  }
  // The density is that of the direction in floats: the rounded direction may be on the other side of an edge.
  sample.pdf = select(sample.pdf > D(0.0), direction_pdf(map, narrow(sample.direction)), sample.pdf);
  return sample;
}

// Row 0 has the directions around +z; column 0 begins at -x, and columns follow the angle about z. Within a cell the density is
// constant per solid angle, so that neither the poles nor the seam are special.
class DirectionMap {
public:
  DirectionMap() = default;
  // weights[row * width + column]: density up to a factor, per solid angle; 0 is never sampled.
  DirectionMap(uint32_t width, uint32_t height, const std::vector<float> &weights, const BuildContext &context = {});

  bool empty() const { return height_ == 0; }
  // Adds a disc of directions around an axis that takes a share of the samples. The shares of all must be below 1.
  void add_disc(const glm::dvec3 &axis, double half_angle, double share);
  struct Sample {
    glm::dvec3 direction{0.0}; // unit
    double pdf = 0.0;          // per solid angle; 0 = no sample
  };
  Sample sample(const glm::vec2 &u) const;
  // Returns the density of a direction in floats, as in the nodes of a world.
  double pdf(const glm::vec3 &direction) const;

  // Angles of a position of the grid, (0, 0) its first corner, and the direction at both.
  SinCos<double> polar(double row) const;
  SinCos<double> azimuth(double column) const;
  static glm::dvec3 direction(const SinCos<double> &polar, const SinCos<double> &azimuth) {
    return {polar.sin * azimuth.cos, polar.sin * azimuth.sin, polar.cos};
  }
  // Returns the solid angle of each cell of a row.
  double solid_angle(uint32_t row) const { return solid_angles_[from_pole(row)]; }
  // Returns a table that is valid as long as the map is neither changed nor moved.
  DirectionTable table() const;
  size_t bytes() const;

private:
  uint32_t from_pole(uint32_t row) const { return 2 * row < height_ ? row : height_ - row - 1; }

  uint32_t width_ = 0, height_ = 0;
  std::vector<double> versines_, solid_angles_, row_sums_, column_sums_;
  std::vector<uint32_t> row_guide_, column_guide_;
  std::vector<DirectionDisc> discs_;
};

} // namespace lancer
