// The Noise Texture: octaves of gradient noise, combined in the five ways of "Texturing and Modeling" (Ebert et al.) as Blender
// defines them; and the Musgrave Texture of before 4.1, which counts octaves differently.
#pragma once

#include "nodes/cell_hash.h"
#include "scene/enums.h"
#include "simd/vectors.h"

namespace lancer {

// Gradient noise of Perlin's kind in one to four dimensions: a slope at each point of the integer lattice, smoothly
// interpolated. The slopes are those of Open Shading Language, which Cycles shares.

constexpr float kNoisePeriod = 100000.0f;

// Returns the remainder of a division by the period, with the sign of x. Every product and difference is exact: the quotients
// have at most 30 digits and the divisor 12.
template <class F> LANCER_LANE F within_period(const F &x) {
  using D = DoubleOf<F>;
  if (!any(abs(x) >= F(kNoisePeriod)))
    return x;
  const D whole(0x1.8p52);
  D rest = widen(abs(x));
  for (const double step : {kNoisePeriod * 0x1p90, kNoisePeriod * 0x1p60, kNoisePeriod * 0x1p30, double(kNoisePeriod)}) {
    rest = rest - ((rest / D(step) + whole) - whole) * D(step);
    rest = select(rest < D(0.0), rest + D(step), rest);
  }
  return copysign(narrow(rest), x);
}

// Negates v if the bit is set.
template <class F> LANCER_LANE F negated(const F &v, const WordOf<F> &bits, int bit) {
  return as_float(as_word(v) ^ ((bits >> bit) << 31));
}

// Returns the dot product of a hash's slope and the vector d from its lattice point.
template <int N, class F> LANCER_LANE F slope_along(const WordOf<F> &hash, const F (&d)[N]) {
  using U = WordOf<F>;
  const U zero(0u);
  if constexpr (N == 1) {
    return negated(F(1.0f) + to_float(hash & U(7u)), hash, 3) * d[0];
  } else if constexpr (N == 2) {
    const MaskOf<F> first = equal(hash & U(4u), zero);
    return negated(select(first, d[0], d[1]), hash, 0) + negated(F(2.0f) * select(first, d[1], d[0]), hash, 1);
  } else if constexpr (N == 3) {
    const F u = select(equal(hash & U(8u), zero), d[0], d[1]);
    const F rest = select(equal(hash & U(13u), U(12u)), d[0], d[2]);
    const F v = select(equal(hash & U(12u), zero), d[1], rest);
    return negated(u, hash, 0) + negated(v, hash, 1);
  } else {
    const U group = hash & U(24u);
    const F u = select(equal(group, U(24u)), d[1], d[0]);
    const F v = select(equal(group & U(16u), zero), d[1], d[2]);
    const F s = select(equal(group, zero), d[2], d[3]);
    return negated(u, hash, 0) + negated(v, hash, 1) + negated(s, hash, 2);
  }
}

// Returns about -1 ... 1; 0 at lattice points, and if a coordinate is not finite. repeats: with period kNoisePeriod along each
// axis, and shifted by half a cell beyond ten periods, where floats are whole numbers.
template <int N, class F> LANCER_LANE F signed_noise(const F (&given)[N], bool repeats) {
  using U = WordOf<F>;
  constexpr float kRange[] = {0.25f, 0.6616f, 0.982f, 0.8344f}; // by N: scales extremes to about 1
  U cell[N];
  F at[N], fade[N];
  MaskOf<F> finite = is_finite(given[0]);
  for (int i = 0; i < N; ++i) {
    finite = finite & is_finite(given[i]);
    F p = select(is_finite(given[i]), given[i], F(0.0f));
    if (repeats)
      p = within_period(p) + select(abs(p) >= F(10.0f * kNoisePeriod), F(0.5f), F(0.0f));
    const F whole = floor(p);
    cell[i] = cell_of(whole);
    at[i] = p - whole;
    fade[i] = at[i] * at[i] * at[i] * (at[i] * (at[i] * F(6.0f) - F(15.0f)) + F(10.0f));
  }
  F values[1 << N];
  for (int corner = 0; corner < 1 << N; ++corner) {
    U key[N];
    F d[N];
    for (int i = 0; i < N; ++i) {
      const int step = corner >> i & 1;
      key[i] = cell[i] + U(static_cast<uint32_t>(step));
      d[i] = at[i] - F(static_cast<float>(step));
    }
    values[corner] = slope_along(cell_hash(key), d);
  }
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 1 << (N - 1 - i); ++k)
      values[k] = (F(1.0f) - fade[i]) * values[2 * k] + fade[i] * values[2 * k + 1];
  return select(finite, F(kRange[N - 1]) * values[0], F(0.0f));
}

template <class F> struct NoiseOctaves { F detail, roughness, lacunarity, offset, gain; };

// Returns the offset that decorrelates a texture's second and later noises: 100 ... 200 along each axis.
constexpr float seed_offset(int dimensions, int seed, int axis) {
  const uint32_t first = std::bit_cast<uint32_t>(static_cast<float>(seed));
  const uint32_t one[] = {first}, two[] = {first, std::bit_cast<uint32_t>(static_cast<float>(axis))};
  const uint32_t hash = dimensions == 1 ? cell_hash(one) : cell_hash(two);
  return 100.0f + static_cast<float>(hash) * 0x1p-32f * 100.0f;
}
template <int N, class F> LANCER_LANE void move_by_seed(F (&p)[N], int seed) {
  for (int i = 0; i < N; ++i)
    p[i] = p[i] + F(seed_offset(N, seed, i));
}

// kind: NoiseKind; flags: as the node's.
template <int N, class F>
static F octaves_of_noise(uint32_t kind, uint32_t flags, const F (&given)[N], const NoiseOctaves<F> &of) {
  using M = MaskOf<F>;
  const F zero(0.0f), one(1.0f);
  const bool is_terrain = kind == NoiseKind::HeteroTerrain, is_ridged = kind == NoiseKind::RidgedMultifractal;
  const F detail = min(F(15.0f), max(zero, of.detail)), roughness = max(zero, of.roughness);
  // The number of full octaves, and the fraction of the next.
  const F whole = floor(detail), rest = detail - whole;
  F full_octaves = flags & NoiseFlag::Counted ? whole : whole + one;
  if (is_terrain || is_ridged)
    full_octaves = max(one, full_octaves);

  F p[N], scale = one, amplitude = is_terrain || is_ridged ? roughness : one;
  F total = zero, most = zero, more = zero, value = one, signal = zero, weight = one;
  if (kind == NoiseKind::HybridMultifractal)
    value = zero;
  M goes_on = one == one;
  for (int i = 0; i < N; ++i)
    p[i] = given[i];
  for (int octave = 0; octave < 17; ++octave) {
    const F number(static_cast<float>(octave));
    const M full = number < full_octaves, partial = (number == full_octaves) & (rest != zero);
    if (!any(full | partial))
      break;
    F q[N];
    for (int i = 0; i < N; ++i)
      q[i] = kind == NoiseKind::Fbm ? p[i] * scale : p[i];
    const F noise = signed_noise(q, (flags & NoiseFlag::Repeats) != 0);
    const F share = select(full, one, select(partial, rest, zero));
    if (kind == NoiseKind::Fbm) {
      more = select(partial, noise * amplitude, more);
      total = select(full, total + noise * amplitude, total);
      most = select(full, most + amplitude, most);
    } else if (kind == NoiseKind::Multifractal) {
      value = select(full | partial, value * (share * amplitude * noise + one), value);
    } else if (kind == NoiseKind::HybridMultifractal) {
      goes_on = goes_on & (weight > F(0.001f)) & (full | partial);
      weight = min(weight, one);
      signal = (noise + of.offset) * amplitude;
      value = select(goes_on, value + share * weight * signal, value);
      weight = select(goes_on, weight * (of.gain * signal), weight);
    } else if (is_terrain) {
      const F height = noise + of.offset;
      value = octave == 0 ? height : select(full | partial, value + share * (height * amplitude * value), value);
    } else {
      const F ridge = of.offset - abs(noise);
      signal = ridge * ridge * (octave == 0 ? one : min(one, max(zero, signal * of.gain)));
      value = octave == 0 ? signal : select(full, value + signal * amplitude, value);
    }
    // The first octave of these two has full amplitude.
    if (octave > 0 || !(is_terrain || is_ridged))
      amplitude = select(full, amplitude * roughness, amplitude);
    scale = scale * of.lacunarity;
    for (int i = 0; i < N; ++i)
      p[i] = kind == NoiseKind::Fbm ? p[i] : p[i] * of.lacunarity;
  }
  if (kind != NoiseKind::Fbm)
    return value;
  if (!(flags & NoiseFlag::Normalized))
    return total + rest * more;
  const F half(0.5f), lower = half * total / most + half;
  const F upper = half * (total + more) / (most + amplitude) + half;
  return (one - rest) * lower + rest * upper;
}

template <int N, class F>
static Vector3<F> noise_at(uint32_t kind, uint32_t flags, const F (&given)[N], const F &distortion, const NoiseOctaves<F> &of) {
  F p[N];
  for (int i = 0; i < N; ++i)
    p[i] = given[i];
  if (any(distortion != F(0.0f)))
    for (int i = 0; i < N; ++i) {
      F q[N];
      for (int k = 0; k < N; ++k)
        q[k] = given[k];
      move_by_seed(q, i);
      p[i] = p[i] + signed_noise(q, (flags & NoiseFlag::Repeats) != 0) * distortion;
    }
  // Red is the texture's scalar value; the other channels are the same noise at an offset.
  F channels[3];
  for (int channel = 0; channel < (flags & NoiseFlag::Color ? 3 : 1); ++channel) {
    F q[N];
    for (int i = 0; i < N; ++i)
      q[i] = p[i];
    if (channel > 0)
      move_by_seed(q, N - 1 + channel);
    channels[channel] = octaves_of_noise(kind, flags, q, of);
  }
  if (!(flags & NoiseFlag::Color))
    return Vector3<F>(channels[0]);
  return {channels[0], channels[1], channels[2]};
}

// The node NOISE: place is w, scale and distortion; octaves detail, roughness and lacunarity; shape offset and gain.
template <class F>
LANCER_LANE Vector3<F> noise_texture(uint32_t kind, uint32_t flags, const Vector3<F> &vector, const Vector3<F> &place,
                                     const Vector3<F> &octaves, const Vector3<F> &shape) {
  const NoiseOctaves<F> of{octaves.x, octaves.y, octaves.z, shape.x, shape.y};
  const F x = vector.x * place.y, y = vector.y * place.y, z = vector.z * place.y, w = place.x * place.y;
  switch (flags & 3) {
  case 0:
    return noise_at<1, F>(kind, flags, {w}, place.z, of);
  case 1:
    return noise_at<2, F>(kind, flags, {x, y}, place.z, of);
  case 2:
    return noise_at<3, F>(kind, flags, {x, y, z}, place.z, of);
  default:
    return noise_at<4, F>(kind, flags, {x, y, z, w}, place.z, of);
  }
}

} // namespace lancer
