#include "scene/image.h"

#include "sampling/elementary.h"
#include "scene/wide_image.h"

#include <array>

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

// The curve's second derivative is at most 3.02, so that lines leave it by no more than 3.02 / 8 / 4096^2 = 2.3e-8; but for the
// line across 0.04045, where the slope jumps from 0.0774 to 0.0787 and the curve lies up to 7.4e-8 beneath.
const float *srgb_lines() {
  static const std::array<float, kSrgbSteps + 2> table = [] {
    std::array<float, kSrgbSteps + 2> values{};
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = srgb_to_linear(float(i) * (1.0f / float(kSrgbSteps)));
    return values;
  }();
  return table.data();
}

size_t Image::bytes() const {
  const size_t texel_bytes = kind == TexelKind::U8 ? 1 : kind == TexelKind::U16 ? 2 : 4;
  return size_t(width) * height * channels * texel_bytes;
}

} // namespace lancer
