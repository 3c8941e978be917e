// One point in each cell of a lattice, and its features: the Voronoi Texture in one to four dimensions.
#pragma once

#include "nodes/cell_hash.h"
#include "sampling/elementary.h"
#include "scene/enums.h"
#include "simd/memory.h"
#include "simd/vectors.h"

#include <limits>

namespace lancer {

template <class F> struct VoronoiShape {
  uint32_t metric = VoronoiMetric::Euclidean;
  bool by_integers = false; // the hash of Blender 5 and newer, for two and more dimensions
  bool is_bounded = false;  // distances are at most 8, as before 4.0
  F smoothness, exponent, randomness;
};

template <int N, class F> struct VoronoiFeature {
  F distance, position[N];
  Vector3<F> color;
};

// Returns a measure with the same order as the metric's distance.
template <int N, class F> LANCER_LANE F measure_of(const F (&way)[N], const VoronoiShape<F> &shape) {
  if (N == 1)
    return abs(way[0]);
  F sum(0.0f);
  for (int i = 0; i < N; ++i)
    switch (shape.metric) {
    case VoronoiMetric::Euclidean:
      sum = sum + way[i] * way[i];
      break;
    case VoronoiMetric::Manhattan:
      sum = sum + abs(way[i]);
      break;
    case VoronoiMetric::Chebychev:
      sum = max(sum, abs(way[i]));
      break;
    default:
      sum = sum + pow(abs(way[i]), shape.exponent);
    }
  return sum;
}
template <int N, class F> LANCER_LANE F distance_of(const F &measure, const VoronoiShape<F> &shape) {
  if (N > 1 && shape.metric == VoronoiMetric::Euclidean)
    return sqrt(measure);
  if (N > 1 && shape.metric == VoronoiMetric::Minkowski)
    return pow(measure, F(1.0f) / shape.exponent);
  return measure;
}
template <int N, class F> LANCER_LANE F furthest_measure(const VoronoiShape<F> &shape) {
  const F eight(8.0f);
  if (!shape.is_bounded)
    return F(std::numeric_limits<float>::max());
  if (N > 1 && shape.metric == VoronoiMetric::Euclidean)
    return eight * eight;
  return N > 1 && shape.metric == VoronoiMetric::Minkowski ? pow(eight, shape.exponent) : eight;
}

// Computes the words that hash a cell: its coordinates as floats, or as integers.
template <int N, class F>
LANCER_LANE void key_of(const F (&cell)[N], const F (&offset)[N], bool by_integers, WordOf<F> (&key)[N]) {
  for (int i = 0; i < N; ++i)
    key[i] = by_integers ? cell_of(cell[i]) + truncate(offset[i]) : as_word(cell[i] + offset[i]);
}

template <class F> LANCER_LANE F share_of_bits(const WordOf<F> &bits) { return to_float(bits) * F(0x1p-31f); }

// Computes a cell's point, 0 ... 1 along each axis.
template <int N, class F> LANCER_LANE void point_in_cell(const WordOf<F> (&key)[N], bool by_integers, F (&point)[N]) {
  using U = WordOf<F>;
  const U one = as_word(F(1.0f)), two = as_word(F(2.0f));
  if constexpr (N > 1)
    if (by_integers) {
      U v[N];
      for (int i = 0; i < N; ++i)
        v[i] = key[i];
      cell_permutation(v);
      for (int i = 0; i < N; ++i)
        point[i] = share_of_bits<F>(v[i]);
      return;
    }
  point[0] = unit_of<F>(cell_hash(key));
  if constexpr (N == 2) {
    const U next[] = {key[0], key[1], one};
    point[1] = unit_of<F>(cell_hash(next));
  } else if constexpr (N == 3) {
    const U next[] = {key[0], key[1], key[2], one}, last[] = {key[0], key[1], key[2], two};
    point[1] = unit_of<F>(cell_hash(next));
    point[2] = unit_of<F>(cell_hash(last));
  } else if constexpr (N == 4) {
    for (int i = 1; i < 4; ++i) {
      const U turned[] = {key[(4 - i) & 3], key[(5 - i) & 3], key[(6 - i) & 3], key[(7 - i) & 3]};
      point[i] = unit_of<F>(cell_hash(turned));
    }
  }
}

template <int N, class F> LANCER_LANE Vector3<F> color_of_cell(const WordOf<F> (&key)[N], bool by_integers) {
  using U = WordOf<F>;
  const U one = as_word(F(1.0f)), two = as_word(F(2.0f));
  if constexpr (N == 1) {
    const U next[] = {key[0], one}, last[] = {key[0], two};
    return {unit_of<F>(cell_hash(key)), unit_of<F>(cell_hash(next)), unit_of<F>(cell_hash(last))};
  } else {
    if (N == 3 || by_integers) {
      F color[N < 3 ? 3 : N];
      U padded[N < 3 ? 3 : N];
      for (int i = 0; i < (N < 3 ? 3 : N); ++i)
        padded[i] = i < N ? key[i % N] : U(0u);
      point_in_cell(padded, by_integers, color);
      return {color[0], color[1], color[2]};
    }
    if constexpr (N == 2) {
      const U next[] = {key[0], key[1], one}, last[] = {key[0], key[1], two};
      return {unit_of<F>(cell_hash(key)), unit_of<F>(cell_hash(next)), unit_of<F>(cell_hash(last))};
    } else {
      const U next[] = {key[2], key[0], key[3], key[1]}, last[] = {key[3], key[2], key[1], key[0]};
      return {unit_of<F>(cell_hash(key)), unit_of<F>(cell_hash(next)), unit_of<F>(cell_hash(last))};
    }
  }
}

// Returns the number of cells within reach steps along every axis; steps_to() returns the steps to one of them, the first axis
// fastest.
template <int N> constexpr int cells_within(int reach) {
  int count = 1;
  for (int i = 0; i < N; ++i)
    count *= 2 * reach + 1;
  return count;
}
template <int N, class F> LANCER_LANE void steps_to(int number, int reach, F (&steps)[N]) {
  for (int i = 0; i < N; ++i) {
    steps[i] = F(static_cast<float>(number % (2 * reach + 1) - reach));
    number /= 2 * reach + 1;
  }
}

// A point in the lattice.
template <int N, class F> struct VoronoiPlace {
  F cell[N], local[N]; // its cell, and its position within

  LANCER_LANE explicit VoronoiPlace(const F (&coordinate)[N]) {
    for (int i = 0; i < N; ++i) {
      const F p = select(is_finite(coordinate[i]), coordinate[i], F(0.0f));
      cell[i] = floor(p);
      local[i] = p - cell[i];
    }
  }
  // Computes the point of the cell at an offset, relative to the corner of this cell; color() returns that cell's colour.
  LANCER_LANE void point(const F (&offset)[N], const VoronoiShape<F> &shape, F (&point)[N]) const {
    WordOf<F> key[N];
    key_of(cell, offset, N > 1 && shape.by_integers, key);
    point_in_cell(key, shape.by_integers, point);
    for (int i = 0; i < N; ++i)
      point[i] = offset[i] + point[i] * shape.randomness;
  }
  LANCER_LANE Vector3<F> color(const F (&offset)[N], const VoronoiShape<F> &shape) const {
    WordOf<F> key[N];
    key_of(cell, offset, N > 1 && shape.by_integers, key);
    return color_of_cell<N, F>(key, shape.by_integers);
  }
};

// Assigns a where the condition holds.
template <int N, class F> LANCER_LANE void assign_where(const MaskOf<F> &m, const F (&a)[N], F (&to)[N]) {
  for (int i = 0; i < N; ++i)
    to[i] = select(m, a[i], to[i]);
}
template <int N, class F> LANCER_LANE void way_between(const F (&a)[N], const F (&b)[N], F (&way)[N]) {
  for (int i = 0; i < N; ++i)
    way[i] = b[i] - a[i];
}
template <int N, class F> LANCER_LANE F dot_of(const F (&a)[N], const F (&b)[N]) {
  F sum = a[0] * b[0];
  for (int i = 1; i < N; ++i)
    sum = sum + a[i] * b[i];
  return sum;
}

// Returns the nearest point, or the second nearest.
template <int N, class F>
static VoronoiFeature<N, F> nearest_feature(const F (&coordinate)[N], const VoronoiShape<F> &shape, bool second) {
  const VoronoiPlace<N, F> place(coordinate);
  const F furthest = furthest_measure<N>(shape);
  F best[2] = {furthest, furthest}, offsets[2][N], points[2][N];
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < N; ++i)
      offsets[k][i] = points[k][i] = F(0.0f);
  for (int number = 0; number < cells_within<N>(1); ++number) {
    F offset[N], point[N], way[N];
    steps_to(number, 1, offset);
    place.point(offset, shape, point);
    way_between(place.local, point, way);
    const F measure = measure_of(way, shape);
    const MaskOf<F> nearer = measure < best[0];
    if (second) {
      const MaskOf<F> between = measure < best[1];
      best[1] = select(nearer, best[0], select(between, measure, best[1]));
      assign_where(between, offset, offsets[1]);
      assign_where(between, point, points[1]);
      assign_where(nearer, offsets[0], offsets[1]);
      assign_where(nearer, points[0], points[1]);
    }
    best[0] = select(nearer, measure, best[0]);
    assign_where(nearer, offset, offsets[0]);
    assign_where(nearer, point, points[0]);
  }
  VoronoiFeature<N, F> feature;
  const int asked = second ? 1 : 0;
  feature.distance = distance_of<N>(best[asked], shape);
  feature.color = place.color(offsets[asked], shape);
  for (int i = 0; i < N; ++i)
    feature.position[i] = points[asked][i] + place.cell[i];
  return feature;
}

// Blends all points nearby. The weight of each point grows with the difference between the distance so far and the point's
// distance.
template <int N, class F> static VoronoiFeature<N, F> smooth_feature(const F (&coordinate)[N], const VoronoiShape<F> &shape) {
  const VoronoiPlace<N, F> place(coordinate);
  const F zero(0.0f), one(1.0f), half(0.5f), s = shape.smoothness;
  VoronoiFeature<N, F> feature;
  feature.distance = shape.is_bounded ? F(8.0f) : zero;
  feature.color = Vector3<F>(zero);
  for (int i = 0; i < N; ++i)
    feature.position[i] = zero;
  for (int number = 0; number < cells_within<N>(2); ++number) {
    F offset[N], point[N], way[N];
    steps_to(number, 2, offset);
    place.point(offset, shape, point);
    way_between(place.local, point, way);
    const F distance = distance_of<N>(measure_of(way, shape), shape);
    const F t = min(one, max(zero, half + half * (feature.distance - distance) / s));
    const F h = number == 0 && !shape.is_bounded ? one : t * t * (F(3.0f) - F(2.0f) * t);
    const F sag = s * h * (one - h), part = sag / (one + F(3.0f) * s), rest = one - h;
    feature.distance = rest * feature.distance + h * distance - sag;
    feature.color = rest * feature.color + h * place.color(offset, shape) - Vector3<F>(part);
    for (int i = 0; i < N; ++i)
      feature.position[i] = rest * feature.position[i] + h * point[i] - part;
  }
  for (int i = 0; i < N; ++i)
    feature.position[i] = feature.position[i] + place.cell[i];
  return feature;
}

// Returns the distance to the nearest boundary between cells.
template <int N, class F> static F edge_distance(const F (&coordinate)[N], const VoronoiShape<F> &shape) {
  const VoronoiPlace<N, F> place(coordinate);
  const F furthest = shape.is_bounded ? F(8.0f) : F(std::numeric_limits<float>::max());
  F best = furthest, nearest[N];
  for (int i = 0; i < N; ++i)
    nearest[i] = F(0.0f);
  if constexpr (N == 1) {
    // Use the neighbours of the point's own cell, wherever the nearest point is.
    F middle[1];
    place.point({F(0.0f)}, shape, middle);
    for (const float side : {-1.0f, 1.0f}) {
      F point[1];
      place.point({F(side)}, shape, point);
      best = min(best, abs((middle[0] + point[0]) / F(2.0f) - place.local[0]));
    }
    return best;
  }
  for (int number = 0; number < cells_within<N>(1); ++number) {
    F offset[N], point[N], way[N];
    steps_to(number, 1, offset);
    place.point(offset, shape, point);
    way_between(place.local, point, way);
    const F square = dot_of(way, way);
    assign_where(square < best, way, nearest);
    best = min(best, square);
  }
  best = furthest;
  for (int number = 0; number < cells_within<N>(1); ++number) {
    F offset[N], point[N], way[N], across[N], middle[N];
    steps_to(number, 1, offset);
    place.point(offset, shape, point);
    way_between(place.local, point, way);
    way_between(nearest, way, across);
    for (int i = 0; i < N; ++i)
      middle[i] = (nearest[i] + way[i]) / F(2.0f);
    const F square = dot_of(across, across);
    best = select(square > F(0.0001f), min(best, dot_of(middle, across) / sqrt(square)), best);
  }
  return best;
}

// Returns half the distance from the nearest point to that point's nearest neighbour.
template <int N, class F> static F sphere_radius(const F (&coordinate)[N], const VoronoiShape<F> &shape) {
  const VoronoiPlace<N, F> place(coordinate);
  const F furthest(std::numeric_limits<float>::max());
  F best = furthest, home[N], nearest[N];
  for (int i = 0; i < N; ++i)
    home[i] = nearest[i] = F(0.0f);
  for (int pass = 0; pass < 2; ++pass) {
    F found[N];
    F offset_found[N];
    for (int i = 0; i < N; ++i)
      found[i] = offset_found[i] = F(0.0f);
    best = furthest;
    for (int number = 0; number < cells_within<N>(1); ++number) {
      // The second pass searches the neighbours of the nearest point's cell.
      if (pass == 1 && number == cells_within<N>(1) / 2)
        continue;
      F offset[N], point[N], way[N];
      steps_to(number, 1, offset);
      for (int i = 0; i < N; ++i)
        offset[i] = offset[i] + home[i];
      place.point(offset, shape, point);
      if (pass == 0)
        way_between(place.local, point, way);
      else
        way_between(nearest, point, way);
      const F square = dot_of(way, way);
      const MaskOf<F> nearer = square < best;
      best = select(nearer, square, best);
      assign_where(nearer, point, found);
      assign_where(nearer, offset, offset_found);
    }
    for (int i = 0; i < N && pass == 0; ++i) {
      nearest[i] = found[i];
      home[i] = offset_found[i];
    }
  }
  return sqrt(best) / F(2.0f);
}

} // namespace lancer
