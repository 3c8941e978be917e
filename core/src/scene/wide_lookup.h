// lookup() for many lanes at once, of the colour alone, with the bits of image.cpp. For kernels only, like sampling/lanes.h.
#pragma once

#include "sampling/lane_vectors.h"
#include "scene/wide_image.h"

namespace lancer {
namespace {

// Two neighbours along one axis, as whole numbers, and the share of the second.
struct WideTaps {
  F first, second, part;
};

LANCER_LANE WideTaps taps(F u, uint32_t size, bool repeats) {
  const F length(static_cast<float>(size)), one(1.0f), zero(0.0f);
  const F near = repeats ? u - floor(u) : min(max(u, F(-8.0f)), F(9.0f));
  const F place = near * length - F(0.5f), whole = floor(place), next = whole + one;
  if (repeats)
    return {select(whole < zero, whole + length, whole), select(next >= length, next - length, next), place - whole};
  const F last = length - one;
  return {min(max(whole, zero), last), min(max(next, zero), last), place - whole};
}

// By the bytes of a channel.
template <uint32_t Bytes> LANCER_LANE V3 texel(const WideImage &image, U number) {
  const U at = number * U(image.channels);
  const bool grey = image.channels == 1;
  if constexpr (Bytes == 4) {
    const float *floats = reinterpret_cast<const float *>(image.texels);
    const F x = gather(floats, at);
    return grey ? V3{x, x, x} : V3{x, gather(floats, at + U(1u)), gather(floats, at + U(2u))};
  } else if constexpr (Bytes == 2) {
    const F unit(1.0f / 65535.0f);
    const U word = gather_bytes(image.texels, at << 1);
    const F x = to_float(word & U(0xffffu)) * unit;
    if (grey)
      return {x, x, x};
    return {x, to_float(word >> 16) * unit, to_float(gather_bytes(image.texels, (at << 1) + U(4u)) & U(0xffffu)) * unit};
  } else {
    const F unit(1.0f / 255.0f);
    const U word = gather_bytes(image.texels, at);
    const F x = to_float(word & U(0xffu)) * unit;
    if (grey)
      return {x, x, x};
    return {x, to_float(word >> 8 & U(0xffu)) * unit, to_float(word >> 16 & U(0xffu)) * unit};
  }
}

template <uint32_t Bytes> LANCER_LANE V3 between(const WideImage &image, const WideTaps &across, const WideTaps &up) {
  const U width(image.width), left = truncate(across.first), right = truncate(across.second);
  const U low = truncate(up.first) * width, high = truncate(up.second) * width;
  const F wx = F(1.0f) - across.part, wy = F(1.0f) - up.part;
  const V3 below = wx * texel<Bytes>(image, low + left) + across.part * texel<Bytes>(image, low + right);
  const V3 above = wx * texel<Bytes>(image, high + left) + across.part * texel<Bytes>(image, high + right);
  return wy * below + up.part * above;
}

// Of what bytes hold: 0 ... 1, and what sums of shares round to.
LANCER_LANE F decode(const float *lines, F value) {
  const F place = value * F(static_cast<float>(kSrgbSteps));
  const U i = truncate(place);
  const F here = gather(lines, i), next = gather(lines, i + U(1u));
  return here + (place - to_float(i)) * (next - here);
}

LANCER_LANE V3 look_up(const WideImage &image, F u, F v) {
  const F zero(0.0f), largest(3.402823466e+38f);
  const M finite = (abs(u) <= largest) & (abs(v) <= largest);
  const WideTaps across = taps(select(finite, u, zero), image.width, image.repeats);
  const WideTaps up = taps(select(finite, v, zero), image.height, image.repeats);
  V3 color = image.texel_bytes == 4   ? between<4>(image, across, up)
             : image.texel_bytes == 2 ? between<2>(image, across, up)
                                      : between<1>(image, across, up);
  if (image.lines)
    color = {decode(image.lines, color.x), decode(image.lines, color.y), decode(image.lines, color.z)};
  if (image.has_matrix) {
    const auto &m = image.matrix;
    color = {F(m[0][0]) * color.x + F(m[1][0]) * color.y + F(m[2][0]) * color.z,
             F(m[0][1]) * color.x + F(m[1][1]) * color.y + F(m[2][1]) * color.z,
             F(m[0][2]) * color.x + F(m[1][2]) * color.y + F(m[2][2]) * color.z};
  }
  return select(finite, color, V3{zero, zero, zero});
}

} // namespace
} // namespace lancer
