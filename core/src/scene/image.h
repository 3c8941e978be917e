// Pictures in memory, in their own bit depth.
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
  bool has_matrix = false;
  glm::mat3 matrix{1.0f}; // decoded RGB to the working space
  Texels texels;          // [height][width][channels]

  size_t bytes() const {
    const size_t texel_bytes = kind == TexelKind::U8 ? 1 : kind == TexelKind::U16 ? 2 : 4;
    return size_t(width) * height * channels * texel_bytes;
  }
};

} // namespace lancer
