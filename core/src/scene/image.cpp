#include "scene/image.h"

#include "sampling/elementary.h"
#include "sampling/plain_vectors.h"
#include "scene/wide_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace lancer {

namespace {

size_t texel_bytes(TexelKind kind) { return kind == TexelKind::U8 ? 1 : kind == TexelKind::U16 ? 2 : 4; }

float unit(uint8_t value) { return float(value) * (1.0f / 255.0f); }
float unit(uint16_t value) { return float(value) * (1.0f / 65535.0f); }
float unit(float value) { return value; }

float srgb_to_linear(float c) {
  if (c < 0.04045f)
    return c < 0.0f ? 0.0f : c * (1.0f / 12.92f);
  return pow((c + 0.055f) * (1.0f / 1.055f), 2.4f);
}

// The curve at the 256 values that a byte can have.
const std::array<float, 256> &srgb_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = srgb_to_linear(unit(uint8_t(i)));
    return values;
  }();
  return table;
}

// A texel with four numbers, whatever is stored.
template <class Texel, int Channels> glm::vec4 fetch(const Image &image, int64_t x, int64_t y) {
  const auto *texels = reinterpret_cast<const Texel *>(image.texels.get());
  const Texel *t = texels + (size_t(y) * image.width + size_t(x)) * Channels;
  if constexpr (Channels == 1) {
    const float value = unit(t[0]);
    return {value, value, value, 1.0f};
  }
  const float alpha = Channels == 4 && image.alpha != AlphaMode::None ? unit(t[Channels - 1]) : 1.0f;
  return {unit(t[0]), unit(t[1]), unit(t[2]), alpha};
}

// Its alpha alone.
template <class Texel, int Channels> float fetch_alpha(const Image &image, int64_t x, int64_t y) {
  if (Channels < 4 || image.alpha == AlphaMode::None)
    return 1.0f;
  const auto *texels = reinterpret_cast<const Texel *>(image.texels.get());
  return unit(texels[size_t(y * int64_t(image.width) + x) * Channels + 3]);
}

// The curve between 0 and 1, and a step beyond, where sums of weighted bytes may round to, by straight lines between points.
// Its second derivative is at most 3.02, so that they leave it by no more than 3.02 / 8 / 4096^2 = 2.3e-8; but for the line
// across 0.04045, where the slope jumps from 0.0774 to 0.0787 and the curve lies up to 7.4e-8 beneath.
const std::array<float, kSrgbSteps + 2> &srgb_lines() {
  static const std::array<float, kSrgbSteps + 2> table = [] {
    std::array<float, kSrgbSteps + 2> values{};
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = srgb_to_linear(float(i) * (1.0f / float(kSrgbSteps)));
    return values;
  }();
  return table;
}

// i modulo size, of an i that is at most two texels outside, which a picture of one texel is twice. No loop, of which a
// compiler may make a division.
int64_t folded(int64_t i, int64_t size) {
  i += i < 0 ? size : 0;
  i += i < 0 ? size : 0;
  i -= i >= size ? size : 0;
  i -= i >= size ? size : 0;
  return i;
}

// The texel that stands at index i of an endless row, near the picture; -1: none.
int64_t wrap(int64_t i, int64_t size, Extension extension) {
  switch (extension) {
  case Extension::Repeat:
    return folded(i, size);
  case Extension::Extend:
    return std::clamp<int64_t>(i, 0, size - 1);
  case Extension::Clip:
    return i < 0 || i >= size ? -1 : i;
  case Extension::Mirror:
    i = folded(i, 2 * size);
    return i < size ? i : 2 * size - 1 - i;
  }
  return -1;
}

// A coordinate brought to where texel indices are small, without a change of what is found there.
float near_picture(float u, Extension extension) {
  switch (extension) {
  case Extension::Repeat:
    return u - std::floor(u);
  case Extension::Mirror:
    return u - 2.0f * std::floor(0.5f * u);
  case Extension::Extend:
  case Extension::Clip:
    break;
  }
  return std::clamp(u, -8.0f, 9.0f);
}

// Weights of four neighbours by the cubic B-spline, for a place t beyond the second.
std::array<float, 4> spline_weights(float t) {
  const float s = 1.0f - t, t2 = t * t, s2 = s * s;
  return {s2 * s / 6.0f, 2.0f / 3.0f - t2 + 0.5f * t2 * t, 2.0f / 3.0f - s2 + 0.5f * s2 * s, t2 * t / 6.0f};
}

// Neighbours along one axis, with their weights; what is beyond count is not set.
struct Taps {
  std::array<int64_t, 4> at;
  std::array<float, 4> weight;
  int count;
};

[[gnu::always_inline]] inline Taps taps(float u, uint32_t size, Extension extension, Interpolation interpolation) {
  Taps result;
  const float x = near_picture(u, extension) * float(size);
  // Texels are centred at halves: the place between two centres is half a texel lower.
  const float place = interpolation == Interpolation::Closest ? x : x - 0.5f;
  const float whole = std::floor(place), part = place - whole;
  const auto first = int64_t(whole);
  switch (interpolation) {
  case Interpolation::Closest:
    result.count = 1;
    result.at[0] = wrap(first, size, extension);
    return result;
  case Interpolation::Linear:
    result.count = 2;
    result.at[0] = wrap(first, size, extension);
    result.at[1] = wrap(first + 1, size, extension);
    result.weight[0] = 1.0f - part;
    result.weight[1] = part;
    return result;
  case Interpolation::Cubic:
    break;
  }
  result.count = 4;
  result.weight = spline_weights(part);
  for (int i = 0; i < 4; ++i)
    result.at[size_t(i)] = wrap(first + i - 1, size, extension);
  return result;
}

// Value: glm::vec4, or float for the alpha alone.
template <class Value, class Texel, int Channels>
[[gnu::always_inline]] inline Value gather(const Image &image, const Taps &across, const Taps &up) {
  const auto at = [&](int64_t x, int64_t y) {
    if constexpr (std::is_same_v<Value, float>)
      return fetch_alpha<Texel, Channels>(image, x, y);
    else
      return fetch<Texel, Channels>(image, x, y);
  };
  if (across.count == 1)
    return across.at[0] < 0 || up.at[0] < 0 ? Value(0.0f) : at(across.at[0], up.at[0]);
  if (across.count == 2 && across.at[0] >= 0 && across.at[1] >= 0 && up.at[0] >= 0 && up.at[1] >= 0) {
    const auto row = [&](int64_t y) { return across.weight[0] * at(across.at[0], y) + across.weight[1] * at(across.at[1], y); };
    return up.weight[0] * row(up.at[0]) + up.weight[1] * row(up.at[1]);
  }
  // More of them, or some beyond the edge of a clipped picture.
  Value sum(0.0f);
  for (size_t y = 0; y < size_t(up.count); ++y) {
    Value row(0.0f);
    for (size_t x = 0; x < size_t(across.count); ++x)
      if (across.at[x] >= 0 && up.at[y] >= 0)
        row += across.weight[x] * at(across.at[x], up.at[y]);
    sum += up.weight[y] * row;
  }
  return sum;
}

template <class Value, class Texel> Value gather_kind(const Image &image, const Taps &across, const Taps &up) {
  switch (image.channels) {
  case 1:
    return gather<Value, Texel, 1>(image, across, up);
  case 3:
    return gather<Value, Texel, 3>(image, across, up);
  default:
    return gather<Value, Texel, 4>(image, across, up);
  }
}

template <class Value> Value gather_any(const Image &image, const Taps &across, const Taps &up) {
  switch (image.kind) {
  case TexelKind::U8:
    return gather_kind<Value, uint8_t>(image, across, up);
  case TexelKind::U16:
    return gather_kind<Value, uint16_t>(image, across, up);
  case TexelKind::Float:
    break;
  }
  return gather_kind<Value, float>(image, across, up);
}

glm::vec3 decode(const glm::vec3 &c) {
  const auto &lines = srgb_lines();
  const auto at = [&](float value) {
    if (!(value >= 0.0f && value < 1.0f + 1.0f / float(kSrgbSteps)))
      return srgb_to_linear(value);
    const float place = value * float(kSrgbSteps);
    const size_t i = size_t(place);
    return lines[i] + (place - float(i)) * (lines[i + 1] - lines[i]);
  };
  return {at(c.x), at(c.y), at(c.z)};
}

// One byte texel exactly: the curve by its table.
glm::vec3 decode_bytes(const glm::vec3 &c) {
  const auto &table = srgb_table();
  const auto at = [&](float value) { return table[size_t(value * 255.0f + 0.5f)]; };
  return {at(c.x), at(c.y), at(c.z)};
}

} // namespace

size_t Image::bytes() const { return size_t(width) * height * channels * texel_bytes(kind); }

void prefetch(const Image &image, const glm::vec2 &uv, Extension extension) {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
    return;
  const Taps across = taps(uv.x, image.width, extension, Interpolation::Linear);
  const Taps up = taps(uv.y, image.height, extension, Interpolation::Linear);
  const size_t texel = image.channels * texel_bytes(image.kind);
  // A row's neighbours mostly share a line of the cache.
  for (const int64_t y : {up.at[0], up.at[1]})
    if (y >= 0 && across.at[0] >= 0)
      __builtin_prefetch(image.texels.get() + (size_t(y) * image.width + size_t(across.at[0])) * texel);
}

float lookup_alpha(const Image &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation) {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
    return 0.0f;
  if (image.channels == 1)
    return 1.0f;
  // What most leaves are: nothing is left to decide but where the texels are.
  if (interpolation == Interpolation::Linear && image.kind == TexelKind::U8 && image.channels == 4)
    return gather<float, uint8_t, 4>(image, taps(uv.x, image.width, extension, Interpolation::Linear),
                                     taps(uv.y, image.height, extension, Interpolation::Linear));
  return gather_any<float>(image, taps(uv.x, image.width, extension, interpolation),
                           taps(uv.y, image.height, extension, interpolation));
}

std::optional<WideImage> wide_image(const Image &image, uint32_t flags, bool alpha) {
  const auto extension = static_cast<Extension>(flags & 0xf);
  const bool multiplied = image.alpha == AlphaMode::Associated || image.alpha == AlphaMode::Straight;
  const bool divided = (flags & 256) && multiplied && image.channels > 1;
  const bool curve = image.transfer == Transfer::Srgb, beyond = divided && image.alpha == AlphaMode::Associated;
  // Kernels have the curve between 0 and 1: of colours that stay there, also divided by an alpha that multiplied them here.
  if (static_cast<Interpolation>(flags >> 4 & 0xf) != Interpolation::Linear || image.tile != 0 ||
      (extension != Extension::Repeat && extension != Extension::Extend) || (curve && (image.exceeds_unit || beyond)) ||
      image.bytes() >= size_t(1) << 31)
    return {};
  WideImage wide;
  wide.texels = image.texels.get();
  wide.lines = curve ? srgb_lines().data() : nullptr;
  wide.width = image.width;
  wide.height = image.height;
  wide.channels = image.channels;
  wide.texel_bytes = uint32_t(texel_bytes(image.kind));
  wide.repeats = extension == Extension::Repeat;
  wide.straight = divided;
  wide.alpha = !alpha && !divided ? 0 : image.channels == 4 && image.alpha != AlphaMode::None ? 2 : 1;
  wide.has_matrix = image.has_matrix;
  for (int column = 0; column < 3; ++column)
    copy(image.matrix[column], wide.matrix[column]);
  return wide;
}

glm::vec4 lookup(const Image &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight) {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
    return glm::vec4(0.0f);
  const Taps across = taps(uv.x, image.width, extension, interpolation);
  const Taps up = taps(uv.y, image.height, extension, interpolation);
  glm::vec4 texel = gather_any<glm::vec4>(image, across, up);
  // A picture of one number is solid even where it is clipped; one of three is clear there, as in Blender.
  if (image.channels == 1)
    texel.w = 1.0f;
  const bool multiplied = image.alpha == AlphaMode::Associated || image.alpha == AlphaMode::Straight;
  const bool divide = straight && multiplied && texel.w != 1.0f && texel.w != 0.0f;
  glm::vec3 color(texel);
  if (divide)
    color /= texel.w;
  // Decode what was interpolated as it is stored.
  if (image.transfer == Transfer::Srgb) {
    const bool byte = image.kind == TexelKind::U8 && interpolation == Interpolation::Closest && !divide;
    color = byte ? decode_bytes(color) : decode(color);
  }
  if (image.has_matrix)
    color = image.matrix * color;
  return {color, texel.w};
}

} // namespace lancer
