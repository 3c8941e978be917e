// Textures of repeated cells and crossing waves, as Blender defines them: checkers, bricks, waves, interference, white noise.
#pragma once

#include "nodes/noise.h"
#include "nodes/voronoi_cells.h"
#include "sampling/elementary.h"
#include "scene/enums.h"
#include "simd/vectors.h"

namespace lancer {

// Moves a place so little that whole coordinates do not lie between two cells.
template <class F> LANCER_LANE Vector3<F> within_cells(const Vector3<F> &p) {
  const F step(0.000001f), share(0.999999f);
  return {(p.x + step) * share, (p.y + step) * share, (p.z + step) * share};
}

// The node CHECKER: returns 1 in cells of the first colour, 0 in others.
template <class F> LANCER_LANE F checker_texture(const Vector3<F> &vector, const F &scale) {
  using U = WordOf<F>;
  const Vector3<F> p = within_cells(Vector3<F>(vector * scale));
  return to_float((cell_of(floor(p.x)) ^ cell_of(floor(p.y)) ^ cell_of(floor(p.z))) & U(1u));
}

// Returns a random number from 0 to 1 that numbers a brick.
template <class F> LANCER_LANE F brick_number(const WordOf<F> &brick) {
  using U = WordOf<F>;
  const U mask(0x7fffffffu), moved = (brick + U(1013u)) & mask, n = (moved >> 13) ^ moved;
  return to_float((n * (n * n * U(60493u) + U(19990303u)) + U(1376312589u)) & mask) * F(0x1p-31f);
}

// Whether a whole number is a multiple of a period; any number is one of 0.
template <class F> LANCER_LANE MaskOf<F> is_multiple(const F &whole, const F &period) {
  return whole == floor(whole / period) * period;
}

// The shares that mix the colours of the Brick Texture.
template <class F> struct BrickShares { F second, mortar; };

// The node BRICK: mortar is scale, size of the mortar and its smoothness; brick is bias, width and height; odd is the offset
// and the squash of rows whose number is a multiple of rows.x, or rows.y; a multiple of 0 changes none.
template <class F>
LANCER_LANE BrickShares<F> brick_texture(const Vector3<F> &vector, const Vector3<F> &mortar, const Vector3<F> &brick,
                                         const Vector3<F> &odd, const Vector3<F> &rows) {
  using U = WordOf<F>;
  const F zero(0.0f), one(1.0f), smallest(-0x1p31f);
  const auto whole = [&](const F &x) __attribute__((always_inline)) {
    const F cell = floor(x);
    return select(abs(cell) < F(0x1p31f), cell, smallest);
  };
  const F x = vector.x * mortar.x, y = vector.y * mortar.x, &height = brick.z;
  // Find the row, and the brick within it.
  const F row = whole(y / height);
  const MaskOf<F> is_odd = (rows.x != zero) & (rows.y != zero);
  const F width = select(is_odd & is_multiple(row, rows.y), brick.y * odd.y, brick.y);
  const F along = x + select(is_odd & is_multiple(row, rows.x), width * odd.x, zero);
  const F number = whole(along / width);
  const U key = (cell_of(row) << 16) + (cell_of(number) & U(0xffffu));
  // Measure the distance to the nearest side.
  const F left = along - width * number, below = y - height * row;
  const F distance = min(min(left, below), min(width - left, height - below));
  const F depth = min(one, max(zero, (one - distance / mortar.y) / mortar.z));
  const F blend = select(mortar.z == zero, one, depth * depth * (F(3.0f) - F(2.0f) * depth));
  return {min(one, max(zero, brick_number<F>(key) + brick.x)), select(distance >= mortar.y, zero, blend)};
}

// The node WAVE: shape is scale, distortion and phase; noise is detail, scale and roughness of the distortion. profile:
// Profile; flags: as the node's.
template <class F>
static F wave_texture(uint32_t profile, uint32_t flags, const Vector3<F> &vector, const Vector3<F> &shape,
                      const Vector3<F> &noise) {
  const F half(0.5f), turn(6.28318530717958647692f);
  const Vector3<F> p = within_cells(Vector3<F>(vector * shape.x));
  const uint32_t wave = flags & 7;
  F n = p.x;
  if (wave >= Wave::RingsX) {
    const F x = wave == Wave::RingsX ? F(0.0f) : p.x, y = wave == Wave::RingsY ? F(0.0f) : p.y;
    const F z = wave == Wave::RingsZ ? F(0.0f) : p.z;
    n = sqrt(x * x + y * y + z * z) * F(20.0f);
  } else if (wave == Wave::BandsDiagonal) {
    n = (p.x + p.y + p.z) * F(10.0f);
  } else {
    n = (wave == Wave::BandsX ? p.x : wave == Wave::BandsY ? p.y : p.z) * F(20.0f);
  }
  n = n + shape.z;
  if (any(shape.y != F(0.0f))) {
    const F at[] = {p.x * noise.y, p.y * noise.y, p.z * noise.y};
    const NoiseOctaves<F> octaves{noise.x, noise.z, F(2.0f), F(0.0f), F(0.0f)};
    const F value = octaves_of_noise(NoiseKind::Fbm, (flags & NoiseFlag::Repeats) | NoiseFlag::Normalized, at, octaves);
    n = select(shape.y != F(0.0f), n + shape.y * (value * F(2.0f) - F(1.0f)), n);
  }
  if (profile == Profile::Sin)
    return half + half * sin(n - F(1.57079632679489661923f));
  const F turns = n / turn;
  return profile == Profile::Saw ? turns - floor(turns) : abs(turns - floor(turns + half)) * F(2.0f);
}

// One step of the Magic Texture: replaces one coordinate by the sine or cosine of a sum of all, with these signs.
struct MagicStep {
  int replaced;
  float signs[3];
  bool is_sine, is_negative;
};
constexpr MagicStep kMagicSteps[] = {
    {1, {1, -1, 1}, false, true},  {0, {1, -1, -1}, false, false}, {2, {-1, -1, -1}, true, false},
    {0, {-1, 1, -1}, false, true}, {1, {-1, 1, 1}, true, true},    {1, {-1, 1, 1}, false, true},
    {0, {1, 1, 1}, false, false},  {2, {1, 1, -1}, true, false},   {0, {-1, -1, 1}, false, true},
    {1, {1, -1, 1}, true, true},
};

// The node MAGIC: shape is scale and distortion; scales_before: apply the scale before the period of the waves.
template <class F>
static Vector3<F> magic_texture(uint32_t depth, bool scales_before, const Vector3<F> &vector, const Vector3<F> &shape) {
  const F scale = shape.x, distortion = shape.y;
  const auto folded = [&](const F &x) __attribute__((always_inline)) {
    return each(x, x, [](float a, float) { return __builtin_fmodf(a, 6.28318530717958647692f); });
  };
  const Vector3<F> p = scales_before ? Vector3<F>(vector * scale) : vector;
  const F x = folded(p.x), y = folded(p.y), z = folded(p.z), five(5.0f), after = scales_before ? F(1.0f) : scale;
  // Deep waves enlarge the rounding of the first: add in Cycles' order.
  F v[3] = {sin((x + y + z) * five * after), cos((y - x - z) * five * after), -cos((-x - y + z) * five * after)};
  for (int i = 0; i < 3 && depth > 0; ++i)
    v[i] = v[i] * distortion;
  for (uint32_t number = 0; number < depth; ++number) {
    const MagicStep &step = kMagicSteps[number];
    const F sum = F(step.signs[0]) * v[0] + F(step.signs[1]) * v[1] + F(step.signs[2]) * v[2];
    const F wave = step.is_sine ? sin(sum) : cos(sum);
    v[step.replaced] = (step.is_negative ? -wave : wave) * distortion;
  }
  const F half(0.5f), size = select(distortion == F(0.0f), F(1.0f), F(2.0f) * distortion);
  return {half - v[0] / size, half - v[1] / size, half - v[2] / size};
}

// The node WHITE_NOISE: a random number for every float.
template <class F> static Vector3<F> white_noise_texture(uint32_t flags, const Vector3<F> &vector, const F &w) {
  const auto random = [&]<int N>(const F(&p)[N]) {
    WordOf<F> key[N];
    for (int i = 0; i < N; ++i)
      key[i] = as_word(p[i]);
    return flags & NoiseFlag::Color ? color_of_cell<N, F>(key, false) : Vector3<F>(unit_of<F>(cell_hash(key)));
  };
  switch (flags & 3) {
  case 0:
    return random({w});
  case 1:
    return random({vector.x, vector.y});
  case 2:
    return random({vector.x, vector.y, vector.z});
  default:
    return random({vector.x, vector.y, vector.z, w});
  }
}

} // namespace lancer
