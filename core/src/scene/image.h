// An image as described: its texels and their interpretation.
#pragma once

#include "simd/huge_pages.h"
#include "simd/scalar.h"

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

// The side of a block of texels is two to this power. A block fills whole pages of memory, and neighbours in both directions
// are mostly on one page.
inline constexpr int kBlockShift = 6;
LANCER_LANE uint32_t blocks_along(uint32_t side) { return ((side - 1) >> kBlockShift) + 1; }

// Returns a side of a level. Each level has half the sides of the one before; those of the last fit one block.
LANCER_LANE uint32_t level_side(uint32_t side, uint32_t level) { return side >> level > 1 ? side >> level : 1; }

struct ImageView {
  uint32_t width = 0, height = 0, channels = 4;
  TexelKind kind = TexelKind::U8;
  Transfer transfer = Transfer::Linear;
  AlphaMode alpha = AlphaMode::Straight;
  uint32_t tile = 0;   // UDIM; 0 = none
  uint32_t levels = 1; // more: a level for a ray, each with half the sides of the one before
  bool has_matrix = false;
  bool has_gaps = false;  // texels that are not finite
  bool in_blocks = false; // the order of LANCER_LAYOUT_BLOCKS; else [height][width][channels]
  glm::mat3 matrix{1.0f}; // decoded RGB to the working space
  const std::byte *texels = nullptr;

  LANCER_LANE uint32_t channel_bytes() const { return kind == TexelKind::U8 ? 1 : kind == TexelKind::U16 ? 2 : 4; }

  LANCER_LANE size_t level_bytes(uint32_t level) const {
    const size_t texel = size_t(channels) * channel_bytes();
    const uint32_t across = level_side(width, level), up = level_side(height, level);
    return in_blocks ? (size_t(blocks_along(across)) * blocks_along(up) << 2 * kBlockShift) * texel
                     : size_t(across) * up * texel;
  }
  // Returns where the texels of a level begin; those of level `levels` would follow the last.
  LANCER_LANE size_t level_offset(uint32_t level) const {
    size_t offset = 0;
    for (uint32_t i = 0; i < level; ++i)
      offset += level_bytes(i);
    return offset;
  }
  LANCER_LANE size_t bytes() const { return level_offset(levels); }
};

// The memory of an image. Texels in blocks are the caller's.
struct Image : ImageView {
  std::string name;
  Texels memory; // null: the texels are the caller's

  void keep(Texels given) {
    memory = std::move(given);
    texels = memory.get();
  }
};

} // namespace lancer
