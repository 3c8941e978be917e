// The memory of pictures. Large ones ask the system for large pages: somewhere in 256 MB a look-up would otherwise wait for the
// page table before it waits for the texel.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace lancer {

struct FreeTexels {
  void operator()(std::byte *texels) const { std::free(texels); }
};
using Texels = std::unique_ptr<std::byte[], FreeTexels>;

inline Texels allocate_texels(size_t bytes) {
  constexpr size_t large_page = size_t(2) << 20;
  const bool large = bytes >= 2 * large_page;
  const size_t alignment = large ? large_page : alignof(std::max_align_t);
  // Kernels read whole words: the last texel's may reach beyond it.
  const size_t rounded = (bytes + 3 + alignment - 1) / alignment * alignment;
  Texels texels(static_cast<std::byte *>(std::aligned_alloc(alignment, rounded)));
  if (!texels)
    throw std::bad_alloc();
#if defined(__linux__)
  // Only advice: without large pages everything works as well, slower.
  if (large)
    (void)madvise(texels.get(), rounded, MADV_HUGEPAGE);
#endif
  return texels;
}

} // namespace lancer
