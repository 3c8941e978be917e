#include "nodes/image.h"

#include "nodes/look_up.h"

#include <cmath>

namespace lancer {

namespace {

uint32_t flags_of(Extension extension, Interpolation interpolation, bool straight = false) {
  return uint32_t(extension) | uint32_t(interpolation) << 4 | (straight ? 256u : 0u);
}

} // namespace

glm::vec4 lookup(const Image &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight) {
  const Texel<float> found = look_up(wide_image(image, flags_of(extension, interpolation, straight)), uv.x, uv.y);
  return {found.color.x, found.color.y, found.color.z, found.alpha};
}

float lookup_alpha(const Image &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation) {
  return look_up_alpha(wide_image(image, flags_of(extension, interpolation)), uv.x, uv.y);
}

void prefetch(const Image &image, const glm::vec2 &uv, Extension extension) {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
    return;
  const Taps<float> across = taps(uv.x, image.width, extension, Interpolation::Linear);
  const Taps<float> up = taps(uv.y, image.height, extension, Interpolation::Linear);
  const size_t texel = image.bytes() / (size_t(image.width) * image.height);
  // A row's neighbours mostly share a line of the cache.
  for (int i = 0; i < 2; ++i)
    if (up.there[i] && across.there[0])
      __builtin_prefetch(image.texels.get() + (size_t(up.at[i]) * image.width + size_t(across.at[0])) * texel);
}

} // namespace lancer
