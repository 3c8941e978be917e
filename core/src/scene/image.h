// An image as described: its texels and their interpretation.
#pragma once

#include "simd/huge_pages.h"

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <new>
#include <string>

namespace lancer {

// The memory of images. Large images request large pages. With small pages, a lookup in 256 MB would wait for a page table walk
// before it reads the texel.
struct FreeTexels {
  void operator()(std::byte *texels) const { free_aligned(texels); }
};
using Texels = std::unique_ptr<std::byte[], FreeTexels>;

inline Texels allocate_texels(size_t bytes) {
  const size_t alignment = bytes >= 2 * kLargePage ? kLargePage : alignof(std::max_align_t);
  // Kernels read whole words, which may extend beyond the last texel.
  const size_t rounded = (bytes + 3 + alignment - 1) / alignment * alignment;
  Texels texels(static_cast<std::byte *>(allocate_aligned(alignment, rounded)));
  if (!texels)
    throw std::bad_alloc();
  return texels;
}

// Images in memory, in their own bit depth.
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
  uint32_t tile = 0; // UDIM; 0 = none
  bool has_matrix = false;
  bool has_gaps = false;  // texels that are not finite
  glm::mat3 matrix{1.0f}; // decoded RGB to the working space
  Texels texels;          // [height][width][channels]

  size_t bytes() const {
    const size_t texel_bytes = kind == TexelKind::U8 ? 1 : kind == TexelKind::U16 ? 2 : 4;
    return size_t(width) * height * channels * texel_bytes;
  }
};

} // namespace lancer
