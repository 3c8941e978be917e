// The Gabor Texture: sparse Gabor noise ("Procedural Noise using Sparse Gabor Convolution", Lagae et al. 2009) as a phasor
// ("Procedural Phasor Noise", Tricard et al. 2019), with eight impulses in each cell of the plane or of space.
#pragma once

#include "nodes/cell_hash.h"
#include "sampling/elementary.h"
#include "simd/vectors.h"

namespace lancer {

// The sum of waves: amplitude times cosine and sine of the phase.
template <class F> struct WaveSum { F cosine, sine; };

// Adds one impulse: a plane wave under a Gaussian, windowed to 0 at distance 1. way: from the impulse's centre; cycles: of the
// wave between centre and place.
template <int N, class F>
LANCER_LANE void add_impulse(const F (&way)[N], const F &cycles, const MaskOf<F> &is_near, const F &sign, WaveSum<F> &sum) {
  constexpr float pi = 3.14159265358979323846f;
  const F half(0.5f);
  F square = way[0] * way[0];
  for (int i = 1; i < N; ++i)
    square = square + way[i] * way[i];
  square = select(is_near, square, F(1.0f));
  const F window = half + half * sin_cos_turn(F(half * square)).cos;
  const F fraction = cycles - floor(cycles);
  // Waves too fast for their phase to be a number cancel each other.
  const MaskOf<F> counts = is_near & (fraction <= F(1.0f));
  const F amplitude = select(counts, sign * exp(F(-pi) * square) * window, F(0.0f));
  const SinCos<F> wave = sin_cos_turn(select(counts, fraction, F(0.0f)));
  sum.cosine = sum.cosine + amplitude * wave.cos;
  sum.sine = sum.sine + amplitude * wave.sin;
}

template <int N, class F> LANCER_LANE F gabor_random(const F (&cell)[N], int number) {
  WordOf<F> key[N + 1];
  for (int i = 0; i < N; ++i)
    key[i] = as_word(cell[i]);
  key[N] = as_word(F(static_cast<float>(number)));
  return unit_of<F>(cell_hash(key));
}

// Directions of the waves: in the plane an angle, in space inclination and azimuth. spread: 0 leaves them as they are, 1 turns
// each impulse's by up to half a turn.
template <class F> struct GaborWaves { F frequency, spread, first_angle, second_angle; };

// Returns the wave's cycles per unit along each axis at an impulse.
template <class F> LANCER_LANE void wave_vector(const F (&cell)[2], int number, const GaborWaves<F> &of, F (&wave)[2]) {
  const F angle = of.first_angle + F(3.14159265358979323846f) * ((gabor_random(cell, number) - F(0.5f)) * of.spread);
  wave[0] = of.frequency * cos(angle);
  wave[1] = of.frequency * sin(angle);
}
template <class F> LANCER_LANE void wave_vector(const F (&cell)[3], int number, const GaborWaves<F> &of, F (&wave)[3]) {
  const F pi(3.14159265358979323846f);
  const F turned[] = {cell[0], cell[1], cell[2]};
  // The second number hashes the same words in another order.
  const WordOf<F> key[] = {as_word(cell[2]), as_word(cell[0]), as_word(F(static_cast<float>(number))), as_word(cell[1])};
  const F inclination = of.first_angle + pi * gabor_random(turned, number) * of.spread;
  const F azimuth = of.second_angle + pi * unit_of<F>(cell_hash(key)) * of.spread;
  const F across = of.frequency * sin(inclination);
  wave[0] = across * cos(azimuth);
  wave[1] = across * sin(azimuth);
  wave[2] = of.frequency * cos(inclination);
}

// Returns an impulse's centre in its cell, 0 ... 1 along each axis.
template <class F> LANCER_LANE void impulse_centre(const F (&cell)[2], int number, F (&centre)[2]) {
  const WordOf<F> x = as_word(cell[0]), y = as_word(cell[1]), n = as_word(F(static_cast<float>(number)));
  const WordOf<F> first[] = {x, y, n}, second[] = {n, x, y};
  centre[0] = unit_of<F>(cell_hash(first));
  centre[1] = unit_of<F>(cell_hash(second));
}
template <class F> LANCER_LANE void impulse_centre(const F (&cell)[3], int number, F (&centre)[3]) {
  const WordOf<F> x = as_word(cell[0]), y = as_word(cell[1]), z = as_word(cell[2]);
  const WordOf<F> n = as_word(F(static_cast<float>(number)));
  const WordOf<F> first[] = {x, y, z, n}, second[] = {z, x, n, y}, third[] = {n, z, y, x};
  centre[0] = unit_of<F>(cell_hash(first));
  centre[1] = unit_of<F>(cell_hash(second));
  centre[2] = unit_of<F>(cell_hash(third));
}

// Returns the sum of the impulses in a cell and its neighbours.
template <int N, class F> static WaveSum<F> gabor_noise(const F (&place)[N], const GaborWaves<F> &of) {
  constexpr int kImpulses = 8, kCells = N == 2 ? 9 : 27;
  WaveSum<F> sum{F(0.0f), F(0.0f)};
  F whole[N], local[N];
  for (int i = 0; i < N; ++i) {
    whole[i] = floor(place[i]);
    local[i] = place[i] - whole[i];
  }
  for (int number = 0; number < kCells; ++number) {
    F cell[N], here[N];
    for (int i = 0, rest = number; i < N; ++i, rest /= 3) {
      const F step(static_cast<float>(rest % 3 - 1));
      cell[i] = whole[i] + step;
      here[i] = local[i] - step;
    }
    for (int impulse = 0; impulse < kImpulses; ++impulse) {
      F way[N], wave[N], square(0.0f);
      impulse_centre(cell, 3 * impulse + 1, way);
      for (int i = 0; i < N; ++i) {
        way[i] = here[i] - way[i];
        square = square + way[i] * way[i];
      }
      const MaskOf<F> is_near = square < F(1.0f);
      if (!any(is_near))
        continue;
      wave_vector(cell, 3 * impulse, of, wave);
      F cycles(0.0f);
      for (int i = 0; i < N; ++i)
        cycles = cycles + way[i] * wave[i];
      const F sign = select(gabor_random(cell, 3 * impulse + 2) < F(0.5f), F(-1.0f), F(1.0f));
      add_impulse(way, cycles, is_near, sign, sum);
    }
  }
  return sum;
}

// The node GABOR: shape is scale, frequency and anisotropy. Returns value, phase and intensity, 0 ... 1.
template <class F>
static Vector3<F> gabor_texture(bool in_space, const Vector3<F> &vector, const Vector3<F> &shape,
                                const Vector3<F> &orientation) {
  const F zero(0.0f), one(1.0f), half(0.5f);
  const Vector3<F> p = vector * shape.x;
  GaborWaves<F> of{max(F(0.001f), shape.y), one - min(one, max(zero, shape.z)), orientation.x, zero};
  WaveSum<F> sum;
  if (in_space) {
    const F across = sqrt(orientation.x * orientation.x + orientation.y * orientation.y);
    of.first_angle = atan2(across, orientation.z);
    of.second_angle = select(across > zero, atan2(orientation.y, orientation.x), zero);
    sum = gabor_noise<3, F>({p.x, p.y, p.z}, of);
  } else {
    sum = gabor_noise<2, F>({p.x, p.y}, of);
  }
  // The value's range is six times its standard deviation: of eight impulses with signs, whose squares integrate to 1/4 in the
  // plane and to 1/4 over the square root of 2 in space.
  const F range(in_space ? 5.0453784915222872f : 6.0f);
  const F turns = narrow(angle(widen(sum.sine), widen(sum.cosine)) * DoubleOf<F>(0.15915494309189535));
  return {half + half * (sum.sine / range), half + turns, sqrt(sum.cosine * sum.cosine + sum.sine * sum.sine) / range};
}

} // namespace lancer
