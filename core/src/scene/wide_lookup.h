// lookup() for many lanes at once with the bits of image.cpp. For kernels only, like simd/lanes.h.
#pragma once

#include "scene/wide_image.h"
#include "simd/kernel_lanes.h"

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

// Alpha is 0 where nobody asks for it.
struct WideTexel {
  V3 color;
  F alpha;
};
LANCER_LANE WideTexel operator+(const WideTexel &a, const WideTexel &b) { return {a.color + b.color, a.alpha + b.alpha}; }
LANCER_LANE WideTexel operator*(F s, const WideTexel &a) { return {s * a.color, s * a.alpha}; }

// By the bytes of a channel.
template <uint32_t Bytes> LANCER_LANE WideTexel texel(const WideImage &image, U number) {
  const U at = number * U(image.channels);
  const bool grey = image.channels == 1, stored = image.alpha == 2;
  WideTexel result;
  result.alpha = F(image.alpha == 0 ? 0.0f : 1.0f);
  if constexpr (Bytes == 4) {
    const float *floats = reinterpret_cast<const float *>(image.texels);
    const F x = gather(floats, at);
    result.color = grey ? V3{x, x, x} : V3{x, gather(floats, at + U(1u)), gather(floats, at + U(2u))};
    if (stored)
      result.alpha = gather(floats, at + U(3u));
  } else if constexpr (Bytes == 2) {
    const F unit(1.0f / 65535.0f);
    const U word = gather_bytes(image.texels, at << 1);
    const F x = to_float(word & U(0xffffu)) * unit;
    result.color = V3{x, x, x};
    if (!grey) {
      const U next = gather_bytes(image.texels, (at << 1) + U(4u));
      result.color = V3{x, to_float(word >> 16) * unit, to_float(next & U(0xffffu)) * unit};
      if (stored)
        result.alpha = to_float(next >> 16) * unit;
    }
  } else {
    const F unit(1.0f / 255.0f);
    const U word = gather_bytes(image.texels, at);
    const F x = to_float(word & U(0xffu)) * unit;
    result.color = grey ? V3{x, x, x} : V3{x, to_float(word >> 8 & U(0xffu)) * unit, to_float(word >> 16 & U(0xffu)) * unit};
    if (stored)
      result.alpha = to_float(word >> 24) * unit;
  }
  return result;
}

template <uint32_t Bytes> LANCER_LANE WideTexel between(const WideImage &image, const WideTaps &across, const WideTaps &up) {
  const U width(image.width), left = truncate(across.first), right = truncate(across.second);
  const U low = truncate(up.first) * width, high = truncate(up.second) * width;
  const F wx = F(1.0f) - across.part, wy = F(1.0f) - up.part;
  const WideTexel below = wx * texel<Bytes>(image, low + left) + across.part * texel<Bytes>(image, low + right);
  const WideTexel above = wx * texel<Bytes>(image, high + left) + across.part * texel<Bytes>(image, high + right);
  return wy * below + up.part * above;
}

// Of what lies in 0 ... 1, and what sums of shares and quotients round to.
LANCER_LANE F decode(const float *lines, F value) {
  const F place = value * F(static_cast<float>(kSrgbSteps));
  const U i = truncate(place);
  const F here = gather(lines, i), next = gather(lines, i + U(1u));
  return here + (place - to_float(i)) * (next - here);
}

LANCER_LANE WideTexel look_up(const WideImage &image, F u, F v) {
  const F zero(0.0f), largest(3.402823466e+38f);
  const M finite = (abs(u) <= largest) & (abs(v) <= largest);
  const WideTaps across = taps(select(finite, u, zero), image.width, image.repeats);
  const WideTaps up = taps(select(finite, v, zero), image.height, image.repeats);
  const WideTexel found = image.texel_bytes == 4   ? between<4>(image, across, up)
                          : image.texel_bytes == 2 ? between<2>(image, across, up)
                                                   : between<1>(image, across, up);
  V3 color = found.color;
  // One of a single channel is solid.
  const F one(1.0f), alpha = image.channels == 1 ? one : found.alpha;
  if (image.straight)
    color = select((alpha != one) & (alpha != zero), color / alpha, color);
  if (image.lines)
    color = {decode(image.lines, color.x), decode(image.lines, color.y), decode(image.lines, color.z)};
  if (image.has_matrix) {
    const auto &m = image.matrix;
    color = {F(m[0][0]) * color.x + F(m[1][0]) * color.y + F(m[2][0]) * color.z,
             F(m[0][1]) * color.x + F(m[1][1]) * color.y + F(m[2][1]) * color.z,
             F(m[0][2]) * color.x + F(m[1][2]) * color.y + F(m[2][2]) * color.z};
  }
  return {select(finite, color, V3{zero, zero, zero}), select(finite, alpha, zero)};
}

} // namespace
} // namespace lancer
