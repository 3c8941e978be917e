#include "nodes/image.h"

#include "nodes/look_up.h"
#include "sampling/elementary.h"

#include <array>
#include <cmath>

namespace lancer {

float srgb_to_linear(float c) {
  if (c < 0.04045f)
    return c < 0.0f ? 0.0f : c * (1.0f / 12.92f);
  return pow((c + 0.055f) * (1.0f / 1.055f), 2.4f);
}

const float *srgb_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = srgb_to_linear(float(i) * (1.0f / 255.0f));
    return values;
  }();
  return table.data();
}

// The curve's second derivative is at most 3.02, so lines deviate by at most 3.02 / 8 / 4096^2 = 2.3e-8. The exception is the
// line across 0.04045, where the slope jumps from 0.0774 to 0.0787 and the curve is up to 7.4e-8 below the line.
const float *srgb_lines() {
  static const std::array<float, kSrgbSteps + 2> table = [] {
    std::array<float, kSrgbSteps + 2> values{};
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = srgb_to_linear(float(i) * (1.0f / float(kSrgbSteps)));
    return values;
  }();
  return table.data();
}

namespace {

uint32_t flags_of(Extension extension, Interpolation interpolation, bool straight = false) {
  return uint32_t(extension) | uint32_t(interpolation) << 4 | (straight ? 256u : 0u);
}

} // namespace

glm::vec4 lookup(const ImageView &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight) {
  const Texel<float> found = look_up(image_level(image, flags_of(extension, interpolation, straight)), uv.x, uv.y);
  return {found.color.x, found.color.y, found.color.z, found.alpha};
}

float lookup_alpha(const ImageView &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation) {
  return look_up_alpha(image_level(image, flags_of(extension, interpolation)), uv.x, uv.y);
}

void prefetch(const ImageView &image, const glm::vec2 &uv, Extension extension) {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
    return;
  const Taps<float> across = taps(uv.x, image.width, extension, Interpolation::Linear);
  const Taps<float> up = taps(uv.y, image.height, extension, Interpolation::Linear);
  const size_t texel = image.bytes() / (size_t(image.width) * image.height);
  // Neighbours in a row mostly share a cache line.
  for (int i = 0; i < 2; ++i)
    if (up.there[i] && across.there[0])
      __builtin_prefetch(image.texels + (size_t(up.at[i]) * image.width + size_t(across.at[0])) * texel);
}

} // namespace lancer
