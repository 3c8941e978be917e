// Pictures in memory, in their own bit depth, and how a texel becomes a colour.
#pragma once

#include "scene/texels.h"

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace lancer {

enum class TexelKind : uint32_t { U8 = 0, U16 = 1, Float = 2 };
enum class Transfer : uint32_t { Linear = 0, Srgb = 1 };
enum class AlphaMode : uint32_t { Associated = 0, Straight = 1, ChannelPacked = 2, None = 3 };
enum class Extension : uint32_t { Repeat = 0, Extend = 1, Clip = 2, Mirror = 3 };
enum class Interpolation : uint32_t { Linear = 0, Closest = 1, Cubic = 2 };

struct Image {
  std::string name;
  uint32_t width = 0, height = 0, channels = 4;
  TexelKind kind = TexelKind::U8;
  Transfer transfer = Transfer::Linear;
  AlphaMode alpha = AlphaMode::Straight;
  uint32_t tile = 0;         // UDIM; 0 = none
  bool exceeds_unit = false; // some number of it lies outside of 0 ... 1
  bool has_matrix = false;
  glm::mat3 matrix{1.0f}; // decoded RGB to the working space
  Texels texels;          // [height][width][channels]

  size_t bytes() const;
};

// The colour at (u, v), (0, 0) the lower left corner and (1, 1) the upper right, in the working space; w is alpha. straight:
// the colour divided by alpha where the picture's mode keeps it multiplied.
glm::vec4 lookup(const Image &image, glm::vec2 uv, Extension extension, Interpolation interpolation, bool straight);

// The alpha alone.
float lookup_alpha(const Image &image, const glm::vec2 &uv, Extension extension, Interpolation interpolation);

// Asks memory for the texels that a look-up there will want.
void prefetch(const Image &image, const glm::vec2 &uv, Extension extension);

} // namespace lancer
