// The environment for many lanes at once: directions by its map, its density and its picture, with the bits of
// direction_map.cpp and image_nodes.h. For kernels only, like simd/lanes.h.
#pragma once

#include "lights/wide_sky.h"
#include "nodes/look_up.h"
#include "sampling/angle.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE D to_double(U whole) { return widen(to_float(whole)); }
LANCER_LANE U from_pole(const DirectionTable &map, U row, M upper) { return select(upper, row, U(map.height - 1u) - row); }

// Of a cell, whose sums stand at column in those of the columns.
LANCER_LANE D density(const DirectionTable &map, U row, U column, M upper) {
  const D of_row = gather(map.row_sums, row + U(1u)) - gather(map.row_sums, row);
  const D of_column = gather(map.column_sums, column + U(1u)) - gather(map.column_sums, column);
  return of_row * of_column / gather(map.solid_angles, from_pole(map, row, upper));
}
LANCER_LANE M is_upper(const DirectionTable &map, U row) { return F(2.0f) * to_float(row) < F(static_cast<float>(map.height)); }

struct WideEntry {
  U index;
  D u; // where the number fell inside
};
// Sums and guides begin at these places of theirs.
LANCER_LANE WideEntry find(const double *sums, U sums_at, const uint32_t *guide, U guide_at, uint32_t steps, F number) {
  const D u = widen(number);
  const U step = guide_at + truncate(min(D(static_cast<double>(steps - 1u)), u * D(static_cast<double>(steps))));
  U low = gather(guide, step), high = gather(guide, step + U(1u));
  for (M open = !equal(low, high); any(open); open = !equal(low, high)) {
    const U middle = (low + high) >> 1;
    const M left = gather(sums, sums_at + middle + U(1u)) > u;
    high = select(open & left, middle, high);
    low = select(open & !left, middle + U(1u), low);
  }
  const D from = gather(sums, sums_at + low), width = gather(sums, sums_at + low + U(1u)) - from;
  return {low, min((u - from) / width, D(kBelowOne))};
}

LANCER_LANE D3 sample_map(const DirectionTable &map, F u, F v, D &pdf) {
  const U none(0u);
  const WideEntry row = find(map.row_sums, none, map.row_guide, none, map.row_steps, v);
  const U columns_at = row.index * U(map.width + 1u);
  const WideEntry column =
      find(map.column_sums, columns_at, map.column_guide, row.index * U(map.column_steps + 1u), map.column_steps, u);
  const M upper = is_upper(map, row.index);
  pdf = density(map, row.index, columns_at + column.index, upper);
  // inside_cell()
  const D one(1.0);
  const U pole = from_pole(map, row.index, upper);
  const D from = gather(map.versines, pole), to = gather(map.versines, pole + U(1u));
  const D y = select(upper, row.u, one - row.u), x = from * (one - y) + to * y;
  const D across = sqrt(x * (D(2.0) - x)), up = select(upper, one - x, x - one);
  const SinCos turn = sin_cos_turn((to_double(column.index) + column.u) / D(static_cast<double>(map.width)));
  return {-(across * turn.cos), -(across * turn.sin), up};
}

LANCER_LANE MapPlace<D> place_of(const V3 &direction) {
  const D3 d = widen(direction);
  return place_on_map(d.x, d.y, d.z, sqrt(d.x * d.x + d.y * d.y));
}

LANCER_LANE D pdf_at(const DirectionTable &map, const MapPlace<D> &place) {
  const double width = static_cast<double>(map.width), height = static_cast<double>(map.height);
  const U row = truncate(min(D(height - 1.0), (D(0.5) - place.y) * D(height)));
  const U column = truncate(min(D(width - 1.0), (D(0.5) + place.x) * D(width)));
  return density(map, row, row * U(map.width + 1u) + column, is_upper(map, row));
}

// As the picture's nodes see unit direction d; place: of d itself.
LANCER_LANE V3 picture_at(const WideSky &sky, const V3 &d, const MapPlace<D> &place) {
  MapPlace<D> seen = place;
  M somewhere = mask_of((1u << kLanes) - 1u);
  if (sky.mapped) {
    // mapping()
    const auto &t = sky.turn;
    const V3 s{d.x * F(sky.scale[0]), d.y * F(sky.scale[1]), d.z * F(sky.scale[2])};
    const V3 v{F(t[0][0]) * s.x + F(t[1][0]) * s.y + F(t[2][0]) * s.z + F(sky.location[0]),
               F(t[0][1]) * s.x + F(t[1][1]) * s.y + F(t[2][1]) * s.z + F(sky.location[1]),
               F(t[0][2]) * s.x + F(t[1][2]) * s.y + F(t[2][2]) * s.z + F(sky.location[2])};
    seen = place_of(v);
    somewhere = !black(v);
  }
  const F zero(0.0f);
  V3 color =
      look_up(sky.image, select(somewhere, narrow(D(0.5) - seen.x), zero), select(somewhere, narrow(D(0.5) + seen.y), zero))
          .color;
  if (sky.multiplied)
    color = color * V3{F(sky.factor[0]), F(sky.factor[1]), F(sky.factor[2])};
  return color;
}

} // namespace
} // namespace lancer
