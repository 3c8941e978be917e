// Image lookups in lanes of F: texels, their weights, and the conversion of stored values to colours. Internal linkage, as in
// lanes.h.
#pragma once

#include "nodes/image.h"
#include "sampling/elementary.h"
#include "simd/memory.h"
#include "simd/vectors.h"

namespace lancer {
namespace {

// Neighbouring texels along one axis: their indices as whole numbers, their weights, and whether they exist. The weight of a
// single texel is not set. Entries beyond count are unset.
template <class F> struct Taps {
  F at[4], weight[4];
  MaskOf<F> there[4];
  int count;
};

// Returns i modulo size, for i at most two texels outside, which is two periods of a one-texel image.
template <class F> LANCER_LANE F folded(F i, const F &size) {
  const F zero(0.0f);
  i = select(i < zero, i + size, i);
  i = select(i < zero, i + size, i);
  i = select(i >= size, i - size, i);
  return select(i >= size, i - size, i);
}

// Returns the texel at index i of an infinite row, near the image.
template <class F> LANCER_LANE F wrapped(const F &i, const F &size, Extension extension, MaskOf<F> &there) {
  const F zero(0.0f), last = size - F(1.0f);
  there = uniform<F>(true);
  switch (extension) {
  case Extension::Repeat:
    return folded(i, size);
  case Extension::Mirror: {
    const F both = folded(i, F(size + size));
    return select(both < size, both, size + size - F(1.0f) - both);
  }
  case Extension::Clip:
    there = (i >= zero) & (i < size);
    break;
  case Extension::Extend:
    break;
  }
  return min(max(i, zero), last);
}

// Maps a coordinate to a range of small texel indices with the same lookup result.
template <class F> LANCER_LANE F near_picture(const F &u, Extension extension) {
  if (extension == Extension::Repeat)
    return u - floor(u);
  if (extension == Extension::Mirror)
    return u - F(2.0f) * floor(F(0.5f) * u);
  return min(max(u, F(-8.0f)), F(9.0f));
}

// For finite coordinates. Sides are at most 2^20, so that floats represent all these indices.
template <class F> LANCER_LANE Taps<F> taps(const F &u, uint32_t side, Extension extension, Interpolation interpolation) {
  Taps<F> r;
  const F one(1.0f), size(static_cast<float>(side)), x = near_picture(u, extension) * size;
  // Texels are centred at halves: subtract half a texel.
  const F place = interpolation == Interpolation::Closest ? x : x - F(0.5f), whole = floor(place), part = place - whole;
  const auto neighbour = [&](int i, float step) __attribute__((always_inline)) {
    r.at[i] = wrapped(F(whole + F(step)), size, extension, r.there[i]);
  };
  switch (interpolation) {
  case Interpolation::Closest:
    r.count = 1;
    neighbour(0, 0.0f);
    return r;
  case Interpolation::Linear:
    r.count = 2;
    neighbour(0, 0.0f);
    neighbour(1, 1.0f);
    r.weight[0] = one - part;
    r.weight[1] = part;
    return r;
  case Interpolation::Cubic:
    break;
  }
  // The cubic B-spline.
  r.count = 4;
  const F s = one - part, t2 = part * part, s2 = s * s, six(6.0f), third(2.0f / 3.0f), half(0.5f);
  r.weight[0] = s2 * s / six;
  r.weight[1] = third - t2 + half * t2 * part;
  r.weight[2] = third - s2 + half * s2 * s;
  r.weight[3] = t2 * part / six;
  for (int i = 0; i < 4; ++i)
    neighbour(i, static_cast<float>(i - 1));
  return r;
}

// Results of a lookup: a colour with alpha, or the alpha only.
template <class F> struct Texel {
  Vector3<F> color;
  F alpha;
  LANCER_LANE static Texel zero() { return {Vector3<F>(F(0.0f)), F(0.0f)}; }
};
template <class F> LANCER_LANE Texel<F> operator+(const Texel<F> &a, const Texel<F> &b) {
  return {a.color + b.color, a.alpha + b.alpha};
}
template <class F> LANCER_LANE Texel<F> operator*(const F &s, const Texel<F> &a) { return {s * a.color, s * a.alpha}; }
template <class F> LANCER_LANE Texel<F> select(const MaskOf<F> &m, const Texel<F> &a, const Texel<F> &b) {
  return {select(m, a.color, b.color), select(m, a.alpha, b.alpha)};
}
template <class F> struct Alpha {
  F alpha;
  LANCER_LANE static Alpha zero() { return {F(0.0f)}; }
};
template <class F> LANCER_LANE Alpha<F> operator+(const Alpha<F> &a, const Alpha<F> &b) { return {a.alpha + b.alpha}; }
template <class F> LANCER_LANE Alpha<F> operator*(const F &s, const Alpha<F> &a) { return {s * a.alpha}; }
template <class F> LANCER_LANE Alpha<F> select(const MaskOf<F> &m, const Alpha<F> &a, const Alpha<F> &b) {
  return {select(m, a.alpha, b.alpha)};
}

// Returns the number of a texel in memory, in rows or in blocks.
template <class N> LANCER_LANE N texel_number(const ImageLevel &image, const N &column, const N &row) {
  if (!image.blocks_across)
    return row * N(image.width) + column;
  const N last((1u << kBlockShift) - 1u);
  const N block = (row >> kBlockShift) * N(image.blocks_across) + (column >> kBlockShift);
  return block << 2 * kBlockShift | (row & last) << kBlockShift | (column & last);
}

// Returns the words at this byte offset into a texel.
template <uint32_t Bytes, class F>
LANCER_LANE WordOf<F> words_at(const ImageLevel &image, const F &x, const F &y, uint32_t into) {
  using U = WordOf<F>;
  const U column = truncate(x), row = truncate(y);
  const uint32_t texel = image.channels * Bytes;
  if constexpr (LanesOf<F>::kWidth > 1)
    if (!image.large)
      return gather_bytes(image.texels, texel_number(image, column, row) * U(texel) + U(into));
  return by_lane<U>([&](int i) __attribute__((always_inline)) {
    const uint64_t number = texel_number<uint64_t>(image, lane(column, i), lane(row, i));
    return gather_bytes(image.texels + number * texel, into);
  });
}

// Bytes: of a channel.
template <uint32_t Bytes, class F> LANCER_LANE F channel(const WordOf<F> &word, uint32_t byte) {
  using U = WordOf<F>;
  if constexpr (Bytes == 4)
    return as_float(word);
  else if constexpr (Bytes == 2)
    return to_float((word >> static_cast<int>(8 * byte)) & U(0xffffu)) * F(1.0f / 65535.0f);
  else
    return to_float((word >> static_cast<int>(8 * byte)) & U(0xffu)) * F(1.0f / 255.0f);
}
template <uint32_t Bytes, class F> LANCER_LANE void read(const ImageLevel &image, const F &x, const F &y, Texel<F> &result) {
  // A word holds one float, two or four channels.
  const WordOf<F> word = words_at<Bytes>(image, x, y, 0);
  const F first = channel<Bytes, F>(word, 0);
  result.alpha = F(1.0f);
  if (image.channels == 1) {
    result.color = {first, first, first};
    return;
  }
  const WordOf<F> second = Bytes == 4 ? words_at<Bytes>(image, x, y, 4) : word;
  const WordOf<F> third = Bytes == 4 ? words_at<Bytes>(image, x, y, 8) : Bytes == 2 ? words_at<Bytes>(image, x, y, 4) : word;
  result.color = {first, channel<Bytes, F>(second, Bytes == 4 ? 0 : Bytes), channel<Bytes, F>(third, Bytes == 1 ? 2 : 0)};
  if (image.keeps_alpha)
    result.alpha = channel<Bytes, F>(Bytes == 4 ? words_at<Bytes>(image, x, y, 12) : third, Bytes == 4   ? 0
                                                                                            : Bytes == 2 ? 2
                                                                                                         : 3);
}
template <uint32_t Bytes, class F> LANCER_LANE void read(const ImageLevel &image, const F &x, const F &y, Alpha<F> &result) {
  result.alpha = F(1.0f);
  if (image.keeps_alpha)
    result.alpha = channel<Bytes, F>(words_at<Bytes>(image, x, y,
                                                     Bytes == 1   ? 0
                                                     : Bytes == 2 ? 4
                                                                  : 12),
                                     Bytes == 4   ? 0
                                     : Bytes == 2 ? 2
                                                  : 3);
}

template <uint32_t Bytes, class Found, class F>
LANCER_LANE Found between(const ImageLevel &image, const Taps<F> &across, const Taps<F> &up) {
  const auto at = [&](int x, int y) __attribute__((always_inline)) {
    Found texel;
    read<Bytes>(image, across.at[x], up.at[y], texel);
    return texel;
  };
  const bool clipped = image.extension == Extension::Clip;
  if (across.count == 1)
    return clipped ? select(across.there[0] & up.there[0], at(0, 0), Found::zero()) : at(0, 0);
  MaskOf<F> whole = uniform<F>(across.count == 2);
  if (across.count == 2 && clipped)
    whole = across.there[0] & across.there[1] & up.there[0] & up.there[1];
  Found found = Found::zero();
  if (any(whole)) {
    const auto row = [&](int y) __attribute__((always_inline)) {
      return across.weight[0] * at(0, y) + across.weight[1] * at(1, y);
    };
    found = up.weight[0] * row(0) + up.weight[1] * row(1);
  }
  if (all(whole))
    return found;
  // More neighbours, or some beyond the edge of a clipped image.
  Found sum = Found::zero();
  for (int y = 0; y < up.count; ++y) {
    Found row = Found::zero();
    for (int x = 0; x < across.count; ++x)
      row = row + select(across.there[x] & up.there[y], across.weight[x] * at(x, y), Found::zero());
    sum = sum + select(up.there[y], up.weight[y] * row, Found::zero());
  }
  return select(whole, found, sum);
}

template <class Found, class F> LANCER_LANE Found found_at(const ImageLevel &image, const F &u, const F &v) {
  const Taps<F> across = taps(u, image.width, image.extension, image.interpolation);
  const Taps<F> up = taps(v, image.height, image.extension, image.interpolation);
  return image.texel_bytes == 4   ? between<4, Found>(image, across, up)
         : image.texel_bytes == 2 ? between<2, Found>(image, across, up)
                                  : between<1, Found>(image, across, up);
}

// Interpolates the curve linearly between 0 and 1, and one step beyond 1, which sums of weighted bytes may reach by rounding.
template <class F> LANCER_LANE F decode(const float *lines, const F &value) {
  const F zero(0.0f), steps(static_cast<float>(kSrgbSteps));
  const auto on_lines = (value >= zero) & (value < F(1.0f + 1.0f / static_cast<float>(kSrgbSteps)));
  const F place = select(on_lines, value, zero) * steps;
  const WordOf<F> i = truncate(place);
  const F here = gather(lines, i), next = gather(lines, i + WordOf<F>(1u));
  const F line = here + (place - to_float(i)) * (next - here);
  return all(on_lines) ? line : select(on_lines, line, each(value, [](float x) { return srgb_to_linear(x); }));
}
template <class F> LANCER_LANE F decode_byte(const F &value) {
  const F place = value * F(255.0f) + F(0.5f);
  const auto on_table = (place >= F(0.0f)) & (place < F(256.0f));
  return gather(srgb_bytes(), truncate(select(on_table, place, F(0.0f))));
}

// Returns the colour at (u, v), (0, 0) the lower left corner and (1, 1) the upper right, in the working space; 0 if a
// coordinate is not finite.
template <class F> LANCER_LANE Texel<F> look_up(const ImageLevel &image, const F &u, const F &v) {
  const F zero(0.0f), one(1.0f);
  const auto place = is_finite(u) & is_finite(v);
  Texel<F> texel = found_at<Texel<F>>(image, select(place, u, zero), select(place, v, zero));
  // Outside a clipped image, alpha is 1 with one channel and 0 with three, as in Blender.
  if (image.channels == 1)
    texel.alpha = F(1.0f);
  Vector3<F> &c = texel.color;
  const auto divided = uniform<F>(image.straight) & (texel.alpha != one) & (texel.alpha != zero);
  if (any(divided))
    c = select(divided, c / texel.alpha, c);
  // Interpolate stored values first, then decode.
  if (image.curve) {
    const bool bytes = image.texel_bytes == 1 && image.interpolation == Interpolation::Closest;
    const Vector3<F> stored = c;
    if (!bytes || any(divided)) {
      const float *lines = srgb_lines();
      c = {decode(lines, c.x), decode(lines, c.y), decode(lines, c.z)};
    }
    if (bytes)
      c = select(divided, c, {decode_byte(stored.x), decode_byte(stored.y), decode_byte(stored.z)});
  }
  if (image.matrix) {
    const glm::mat3 &m = *image.matrix;
    c = {F(m[0].x) * c.x + F(m[1].x) * c.y + F(m[2].x) * c.z, F(m[0].y) * c.x + F(m[1].y) * c.y + F(m[2].y) * c.z,
         F(m[0].z) * c.x + F(m[1].z) * c.y + F(m[2].z) * c.z};
  }
  if (image.has_gaps) {
    const auto whole = is_finite(c.x) & is_finite(c.y) & is_finite(c.z);
    c = select(whole, c, Vector3<F>(zero));
    texel.alpha = select(is_finite(texel.alpha), texel.alpha, zero);
  }
  return select(place, texel, Texel<F>::zero());
}

// Returns the level of an image for a place whose coordinates change over a pixel by distances of these squares, in texels: the
// smaller change decides, but at most four levels below the larger one. u in [0, 1) chooses between two levels near their
// border, as Cycles does; without it, the finer one is taken.
template <class F> LANCER_LANE WordOf<F> level_of(const ImageView &image, const F &across2, const F &up2, const F *u) {
  using U = WordOf<F>;
  const F zero(0.0f), most(3.0e38f), smaller = min(across2, up2), larger = max(across2, up2);
  const F change2 = min(max(smaller, larger * F(1.0f / 256.0f)), most);
  // The level is half the logarithm to base 2, plus 1/4 ... 3/4; that of a power of two is the number's exponent.
  const F raised = u ? min(change2 * exp(F(0.34657359f) + F(0.69314718f) * *u), most) : change2;
  const auto counts = raised >= F(1.0f);
  const U exponent = (as_word(select(counts, raised, F(1.0f))) >> 23) - U(127u);
  const F level = min(to_float(exponent >> 1), F(static_cast<float>(image.levels - 1)));
  return truncate(select(counts, level, zero));
}

// Looks up each lane in its own level. Beyond the edge of a clipped image all is 0, also within half a texel.
template <class F>
LANCER_LANE Texel<F> look_up_level(const ImageView &image, uint32_t flags, const F &u, const F &v, const WordOf<F> &level) {
  Texel<F> texel = Texel<F>::zero();
  for (uint32_t i = 0; i < image.levels; ++i) {
    const auto here = equal(level, WordOf<F>(i));
    if (!any(here))
      continue;
    // Other lanes look where one of these looks: their own texels of this level may be on no page in memory.
    const int one = __builtin_ctz(bits(here));
    const F x = select(here, u, F(lane(u, one))), y = select(here, v, F(lane(v, one)));
    texel = select(here, look_up(image_level(image, flags, i), x, y), texel);
  }
  const F zero(0.0f), whole(1.0f);
  if (static_cast<Extension>(flags & 0xf) != Extension::Clip)
    return texel;
  return select((u >= zero) & (u <= whole) & (v >= zero) & (v <= whole), texel, Texel<F>::zero());
}

// Returns the alpha only.
template <class F> LANCER_LANE F look_up_alpha(const ImageLevel &image, const F &u, const F &v) {
  const F zero(0.0f);
  const auto place = is_finite(u) & is_finite(v);
  if (image.channels == 1)
    return select(place, F(1.0f), zero);
  const F alpha = found_at<Alpha<F>>(image, select(place, u, zero), select(place, v, zero)).alpha;
  return select(image.has_gaps ? place & is_finite(alpha) : place, alpha, zero);
}

} // namespace
} // namespace lancer
