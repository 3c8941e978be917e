// The memory of pictures. Large ones ask the system for large pages: somewhere in 256 MB a look-up would otherwise wait for the
// page table before it waits for the texel.
#pragma once

#include "scene/large_memory.h"

#include <cstddef>
#include <memory>
#include <new>

namespace lancer {

struct FreeTexels {
  void operator()(std::byte *texels) const { free_aligned(texels); }
};
using Texels = std::unique_ptr<std::byte[], FreeTexels>;

inline Texels allocate_texels(size_t bytes) {
  const size_t alignment = bytes >= 2 * kLargePage ? kLargePage : alignof(std::max_align_t);
  // Kernels read whole words: the last texel's may reach beyond it.
  const size_t rounded = (bytes + 3 + alignment - 1) / alignment * alignment;
  Texels texels(static_cast<std::byte *>(allocate_aligned(alignment, rounded)));
  if (!texels)
    throw std::bad_alloc();
  return texels;
}

} // namespace lancer
