// Lookups in images: the record of an image as plain numbers, and the lookup of one point.
#pragma once

#include "scene/image.h"
#include "simd/scalar.h"

namespace lancer {

// The sRGB curve in three forms: the end points of kSrgbSteps line segments between 0 and 1; the values at the 256 values of a
// byte; and the value at any number.
inline constexpr uint32_t kSrgbSteps = 4096;
const float *srgb_lines();
const float *srgb_bytes();
float srgb_to_linear(float c);

// A level of an image, as nodes with some flags look it up.
struct ImageLevel {
  const std::byte *texels = nullptr;
  const glm::mat3 *matrix = nullptr; // null: decoded colours are in the working space
  uint32_t width = 0, height = 0, channels = 0;
  uint32_t texel_bytes = 0; // per channel: 1, 2, or 4 for floats
  Extension extension = Extension::Repeat;
  Interpolation interpolation = Interpolation::Linear;
  bool curve = false;         // texels are in sRGB; else linear
  bool large = false;         // offsets exceed 32 bits
  bool straight = false;      // divide the colour by alpha
  bool keeps_alpha = false;   // alpha is the fourth channel; else 1
  bool has_gaps = false;      // some texels are not finite
  uint32_t blocks_across = 0; // 0: texels are rows
};

// Returns a level of the image as nodes with these flags look it up. Valid as long as the image is neither changed nor moved.
LANCER_LANE ImageLevel image_level(const ImageView &image, uint32_t flags, uint32_t level = 0) {
  const bool multiplied = image.alpha == AlphaMode::Associated || image.alpha == AlphaMode::Straight;
  ImageLevel r;
  r.texels = image.texels + image.level_offset(level);
  r.matrix = image.has_matrix ? &image.matrix : nullptr;
  r.width = level_side(image.width, level);
  r.height = level_side(image.height, level);
  r.channels = image.channels;
  r.texel_bytes = image.channel_bytes();
  r.extension = static_cast<Extension>(flags & 0xf);
  r.interpolation = static_cast<Interpolation>(flags >> 4 & 0xf);
  r.curve = image.transfer == Transfer::Srgb;
  r.large = image.level_bytes(level) >= uint64_t(1) << 31;
  r.keeps_alpha = image.channels == 4 && image.alpha != AlphaMode::None;
  r.has_gaps = image.has_gaps;
  r.blocks_across = image.in_blocks ? blocks_along(r.width) : 0;
  r.straight = (flags & 256) && multiplied && image.channels > 1;
  return r;
}

// Returns the colour at (u, v), (0, 0) the lower left corner and (1, 1) the upper right, in the working space; w is alpha.
// straight: divide the colour by alpha if the image's mode keeps it multiplied.
glm::vec4 lookup(const ImageView &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight);

// Returns the alpha only.
float lookup_alpha(const ImageView &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation);

// Prefetches the texels that a lookup at uv reads.
void prefetch(const ImageView &image, const glm::vec2 &uv, Extension extension);

} // namespace lancer
