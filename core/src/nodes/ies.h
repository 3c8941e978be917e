// The IES Texture: the measured light of a luminaire in a direction, interpolated between the angles of its file.
#pragma once

#include "sampling/elementary.h"
#include "simd/memory.h"
#include "simd/vectors.h"

namespace lancer {

// Rows of texels with one number each. The first row has the angles v from the axis, from its third texel on; the first column
// has the angles h around it, from its third row on. The rest is the intensity, with one more row and column on each side.
struct IesTable {
  const float *texels = nullptr;
  uint32_t width = 0, height = 0;

  uint32_t v_count() const { return width - 3; }
  uint32_t h_count() const { return height - 3; }
};

// An interval between two angles: its number, and the place within. found: whether the angle is within all of them.
template <class F> struct IesInterval {
  WordOf<F> number;
  F place;
  MaskOf<F> found;
};

// angles: count ascending numbers, stride apart.
template <class F> LANCER_LANE IesInterval<F> ies_interval(const float *angles, uint32_t count, uint32_t stride, const F &x) {
  using U = WordOf<F>;
  // Count the angles below x.
  U below(0u);
  uint32_t step = 1;
  while (2 * step <= count)
    step *= 2;
  for (; step > 0; step /= 2) {
    const U next = below + U(step), last(count - 1);
    const MaskOf<F> fits = to_float(next) <= F(static_cast<float>(count));
    const F angle = gather(angles, select(fits, next - U(1u), last) * U(stride));
    below = select(fits & (angle < x), next, below);
  }
  IesInterval<F> found;
  found.number = select(equal(below, U(0u)), U(0u), below - U(1u));
  found.found = (x >= F(angles[0])) & (x < F(angles[size_t(count - 1) * stride]));
  found.number = select(found.found, found.number, U(0u));
  const F low = gather(angles, found.number * U(stride)), high = gather(angles, (found.number + U(1u)) * U(stride));
  found.place = select(found.found, (x - low) / (high - low), F(0.0f));
  return found;
}

// The cubic through b and c with the slopes of Catmull and Rom.
template <class F> LANCER_LANE F between_four(const F (&at)[4], const F &x) {
  const F half(0.5f), &a = at[0], &b = at[1], &c = at[2], &d = at[3];
  const F cubic = d + F(3.0f) * (b - c) - a, square = F(2.0f) * a - F(5.0f) * b + F(4.0f) * c - d;
  return half * ((cubic * x + square) * x + (c - a)) * x + b;
}

// Returns the intensity in a direction of the luminaire's space, in which the axis is -z; 0 outside the angles of the file, and
// where the vector has no direction: Cycles divides 0 by 0 there, and shows no light.
template <class F> static F ies_texture(const IesTable &table, const Vector3<F> &vector) {
  using D = DoubleOf<F>;
  using U = WordOf<F>;
  const auto x = widen(vector.x), y = widen(vector.y), z = widen(vector.z);
  const F v = narrow(angle(D(sqrt(x * x + y * y)), -z)), h = narrow(angle(x, y)) + F(3.14159265358979323846f);
  const IesInterval<F> at_v = ies_interval(table.texels + 2, table.v_count(), 1, v);
  const IesInterval<F> at_h = ies_interval(table.texels + 2 * size_t(table.width), table.h_count(), table.width, h);
  F rows[4];
  for (uint32_t row = 0; row < 4; ++row) {
    const U first = (at_h.number + U(row + 1)) * U(table.width) + at_v.number + U(1u);
    F of[4];
    for (uint32_t column = 0; column < 4; ++column)
      of[column] = gather(table.texels, first + U(column));
    rows[row] = between_four(of, at_v.place);
  }
  const MaskOf<F> found = at_v.found & at_h.found & !black(vector);
  return select(found, max(between_four(rows, at_h.place), F(0.0f)), F(0.0f));
}

} // namespace lancer
